"""Displacement of a vibrated contact under a constant force until it comes to rest (shakedown).

A vibrated contact under a constant force below the static limit comes to rest.  Period by period,
the slip zones relax and transfer their load to the stick zone, until no point slips forward any
more.  The displacement depends on the history.  Here, the force is applied first, to a contact
without tangential load.  Then the vibration starts at its mean position.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from typing import Any

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.closed_forms import solve_prescribed
from microslip.adaptive.driven_contact import STATIC_TOLERANCE
from microslip.adaptive.friction import ladder_of
from microslip.adaptive.request import Request, request_for, result_of_runs
from microslip.adaptive.result import ERRORS
from microslip.adaptive.under_force import (
    is_even,
    oscillates,
    runs_away,
    without_forward_motion,
)
from microslip.estimate.estimate import Estimate
from microslip.estimate.refine import refine, run_tolerance
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.motions.drive import Force
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure
from microslip.solver.discretise import Resolution
from microslip.solver.run import Run, Settings
from microslip.solver.simulate import simulate

TOLERANCE = 1e-2
"""Default tolerance of the displacement, in u_lim."""
RUN_SHARE = 0.2
"""Tolerance of a shakedown run divided by the tolerance of a periodic state.  The step residuals
accumulate over all periods.  Near the static limit, a run takes several hundred periods
(tests/adaptive/test_shakedown.py)."""
PLANNED_VELOCITY = 0.1
"""Velocity for which the time steps are chosen; for velocity 0, the ladder has no time steps."""

SHARED = ("converged", "reason", "cells", "angles", "steps_per_period", "periods", "solve_time_s")
"""Fields that a Shakedown has in common with a Result."""


@dataclass(frozen=True, kw_only=True)
class Shakedown:
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

    motion: str
    pressure: str
    model: str
    amplitude: float
    poisson: float
    force: float
    tolerance: float
    threshold: float
    threshold_error: float
    displacement: float
    displacement_error: float
    pushed: float = math.nan
    most_after: float = math.nan
    converged: bool
    reason: str = ""
    error_resolution: float = 0.0
    error_periodicity: float = 0.0
    error_solver: float = 0.0
    error_model: float = 0.0
    cells: int = 0
    angles: int = 0
    steps_per_period: int = 0
    periods: float = 0.0
    work: int = 0
    solve_time_s: float = 0.0

    def to_dict(self) -> dict:
        """The fields as a dict."""
        return asdict(self)


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
    problem = checked_problem(motion, None, amplitude, pressure=pressure, poisson=poisson)
    if not problem.motion.periodic:
        raise InputError("motion", problem.motion.name, "allowed is a motion that oscillates")
    force = real("force", force, 0.0)
    if tolerance is None:
        raise InputError("tolerance", tolerance, "allowed is a number")
    problem = without_forward_motion(replace(problem, velocity=0.0, drive=Force(force)))
    request = request_for(
        problem, model, tolerance, most_work=most_work, time_limit=time_limit, progress=progress
    )
    if not is_even(problem):
        allowed = "allowed is a motion that exerts no forward force by itself, such as transverse"
        raise InputError("motion", problem.motion.name, allowed)
    return _answer(request, force)


def _answer(request: Request, force: float) -> Shakedown:
    """Compute the Shakedown under a force."""
    threshold, error, away = _threshold(request)
    request_fields: dict[str, Any] = {
        "motion": request.problem.motion.name,
        "pressure": request.problem.pressure.name,
        "model": request.model,
        "amplitude": request.problem.amplitude,
        "poisson": request.problem.poisson,
        "force": force,
        "tolerance": request.tolerance,
        "threshold": threshold,
        "threshold_error": error,
    }
    if not away and force >= threshold - error:
        away = f"the error of the threshold, {error:.1e}, leaves open whether the force is below"
        if force > threshold + error:
            away = f"drifts on for ever: the force is above the threshold, {threshold:.4g}"
    if away:
        endless: dict[str, Any] = {"displacement": math.inf, "displacement_error": math.inf}
        endless |= {"converged": False, "reason": away, "solve_time_s": request.seconds}
        return Shakedown(**request_fields, **endless)
    return Shakedown(**request_fields, **_certified(request, force))


def _threshold(request: Request) -> tuple[float, float, str]:
    """Compute the static limit, its error, and a message if the contact runs away (otherwise
    "")."""
    problem = request.problem
    away = runs_away(problem)
    if not oscillates(problem):
        return 1.0, 0.0, away
    if away:
        return math.nan, math.inf, away
    tolerance = min(request.tolerance or STATIC_TOLERANCE, STATIC_TOLERANCE)
    still = replace(problem, drive=None)
    static = solve_prescribed(replace(request, problem=still, chosen=True, tolerance=tolerance))
    return static.mu_macro, static.mu_macro_error, ""


def _certified(request: Request, force: float) -> dict[str, Any]:
    """Run the contact to rest and return the resulting fields of a Shakedown."""
    planned = replace(request.problem, velocity=PLANNED_VELOCITY)
    ladder = ladder_of(replace(request, problem=planned), request.accuracy)
    # the contact must come to rest in the coarsest run too
    ladder = replace(ladder, start=2 * ladder.start)
    remaining = RUN_SHARE * run_tolerance(request.accuracy)
    settings = Settings(request.how, budget=request.budget)

    def run(problem: Problem, resolution: Resolution, guess: Run | None) -> Run:
        request.show(resolution)
        return simulate(problem, request.model, resolution, remaining, settings=settings)

    every = (request.problem, *request.problem.readings)
    refined = refine(run, ladder, every, request.accuracy, "displacement")
    answer = result_of_runs(
        request, refined, request.tolerance, "displacement", friction=Estimate(force)
    )
    displacement, finest = refined.estimates["displacement"], refined.finest.values
    result = {name: getattr(answer, name) for name in SHARED}
    result |= {ERRORS[source]: error for source, error in displacement.by_source.items()}
    result |= {name: finest[name] for name in ("pushed", "most_after") if name in finest}
    return result | {
        "work": refined.effort.work,
        "displacement": displacement.value,
        "displacement_error": displacement.error,
    }
