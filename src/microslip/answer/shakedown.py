"""Displacement of a vibrated contact under a constant force until it comes to rest (shakedown).

A vibrated contact under a constant force below the static limit comes to rest.  Period by period,
the slip zones relax and transfer their load to the stick zone, until no point slips forward any
more.  The displacement depends on the history.  Here, the force is applied first, to a contact
without tangential load.  Then the vibration starts at its mean position.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from microslip.answer import limits
from microslip.answer import request as requests
from microslip.answer.answer import ERRORS, Answer, Estimate, about
from microslip.answer.force import STATIC_TOLERANCE
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.scene.drive import Force
from microslip.scene.motion import Motion
from microslip.scene.problem import Problem

TOLERANCE = 1e-2
"""Default tolerance of the displacement, in u_lim."""
REST_SHARE = 0.2
"""Tolerance of a shakedown run divided by the tolerance of a periodic state.  The step residuals
accumulate over all periods.  Near the static limit, a run takes several hundred periods
(tests/answer/test_shakedown.py)."""
PLANNED_VELOCITY = 0.1
"""Velocity for which the time steps are chosen; for velocity 0, the ladder has no time steps."""
SHARED = ("model", "tolerance", "cells", "angles", "steps_per_period", "periods", "solve_time_s")
"""Values that a Shakedown has in common with a Result."""


class Shakedown(Answer):
    """Dimensionless displacement of a contact until it comes to rest.

    Attributes
    ----------
    motion, pressure, model : str
        Names of the motion, the pressure distribution and the contact model.
    amplitude, poisson, force, tolerance : float
        Arguments of the request.
    threshold, threshold_error : float
        Static limit divided by mu times the mean normal load, and its estimated error.  Under this
        or a larger force, the contact does not come to rest.
    displacement, displacement_error : float
        Forward displacement from the position without a force to the position at rest, in u_lim,
        and its estimated error.  Infinite if the contact does not come to rest.
    pushed : float
        Part of the displacement caused by the force before the oscillation starts.
    most_after : float
        Number of periods in which the contact covers nine tenths of the displacement caused by the
        oscillation.
    converged : bool
        Whether the contact certainly comes to rest and the error is within the tolerance.
    reason : str
        Reason why the result is not converged, otherwise empty.
    error_resolution, error_periodicity, error_solver, error_model : float
        Parts of the error by source.  The part `error_periodicity` bounds the displacement after
        the last period.  The part `error_model` is due to the resolution of a file.
    cells, angles, steps_per_period : int
        Numbers of cells, of angles and of steps per period in the finest run.
    periods : float
        Number of periods in the longest run.
    work : int
        Work of all runs together, as step solves times unknowns.
    solve_time_s : float
        Wall-clock time in seconds.
    """


def shakedown(
    motion: str | Motion | Problem,
    amplitude: float | None = None,
    force: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    model: str = "auto",
    tolerance: float = TOLERANCE,
    most_work: float | None = None,
    time_limit: float | None = None,
    progress: Callable | None = None,
) -> Shakedown:
    """Compute the displacement of a vibrated contact under a force below the static limit.

    Parameters
    ----------
    motion : str
        A motion that exerts no forward force by itself, such as "transverse" or "bore".
    amplitude, pressure, poisson, model, most_work, time_limit, progress
        See `microslip.solve`.
    force : float
        Force divided by mu times the mean normal load, from 0 to below the static limit.  The
        contact has no mass.
    tolerance : float
        Absolute tolerance of the displacement, in u_lim.

    Returns
    -------
    Shakedown
        The displacement.  It is infinite if the contact does not come to rest; `reason` says why.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion exerts a forward force by itself.  The message
        names the argument.
    """
    if isinstance(motion, Problem) and isinstance(motion.drive, Force):
        if force is not None:
            raise InputError("force", force, "allowed is none beside a Problem that has one")
        force, motion = motion.drive.force, replace(motion, drive=None)
    problem = limits.problem_of(motion, None, amplitude, pressure=pressure, poisson=poisson)
    if not problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is a motion that oscillates")
    force = real("force", force, 0.0)
    if tolerance is None:
        raise InputError("tolerance", tolerance, "allowed is a number")
    problem = limits.without_forward_motion(replace(problem, velocity=0.0, drive=Force(force)))
    given: dict[str, Any] = {"model": model, "tolerance": tolerance, "progress": progress}
    request = requests.request_of(problem, most_work=most_work, time_limit=time_limit, **given)
    if not limits.is_even(problem):
        allowed = "allowed is a motion that exerts no forward force by itself, such as transverse"
        raise InputError("motion", problem.motion.name, allowed)
    limit, away = _threshold(request)
    if not away and force >= limit.value - limit.error:
        away = f"the error of the threshold, {limit.error:.1e}, leaves open whether the force is "
        away += "below"
        if force > limit.value + limit.error:
            away = f"drifts on for ever: the force is above the threshold, {limit.value:.4g}"
    own: dict[str, Any] = {name: about(problem)[name] for name in ("motion", "pressure")}
    own |= {"amplitude": problem.amplitude, "poisson": poisson, "force": force}
    own |= {"threshold": limit.value, "threshold_error": limit.error}
    return _to_rest(request, own, away)


def _threshold(request: requests.Request) -> tuple[Estimate, str]:
    """Compute the static limit, and a message if the contact runs away (otherwise "")."""
    problem = request.problem
    away = limits.runs_away(problem)
    if not limits.oscillates(problem):
        return Estimate(1.0), away
    if away:
        return Estimate(math.nan, {"model": math.inf}), away
    tolerance = min(request.tolerance or STATIC_TOLERANCE, STATIC_TOLERANCE)
    still = replace(problem, drive=None)
    changes: dict[str, Any] = {"problem": still, "chosen": True, "tolerance": tolerance}
    return requests.answer_of(replace(request, **changes)).friction, ""


def _to_rest(request: requests.Request, own: dict[str, Any], away: str) -> Shakedown:
    """Run the contact to rest, unless it moves away.  `own`: values of the Shakedown."""
    endless = {"displacement": Estimate(math.inf, {"model": math.inf})}
    answer = Answer(request.problem, {"imposed": False}, endless, away)
    if not away:
        planned = replace(request.problem, velocity=PLANNED_VELOCITY)
        ladder = requests.ladder_of(replace(request, problem=planned), request.accuracy)
        # the contact must come to rest in the coarsest run too
        ladder = replace(ladder, start=2 * ladder.start)
        share = REST_SHARE * requests.RUN_SHARE
        settings: dict[str, Any] = {"ladder": ladder, "share": share}
        answer = requests.runs(request, request.accuracy, "displacement", **settings)
    still = {"friction": Estimate(own["force"])}
    result = requests.result_of_runs(request, answer, request.tolerance, "displacement", **still)
    displacement, run = answer.estimates["displacement"], answer.values.get("finest")
    errors = {name: displacement.by_source.get(one, 0.0) for one, name in ERRORS.items()}
    if away:
        errors = dict.fromkeys(errors, 0.0)
    own |= {name: getattr(result, name) for name in SHARED} | errors
    finest = {} if run is None else run.values
    own |= {name: finest.get(name, math.nan) for name in ("pushed", "most_after")}
    own |= {"displacement": displacement.value, "displacement_error": displacement.error}
    return Shakedown(request.problem, own | {"work": result.effort.work}, reason=result.reason)
