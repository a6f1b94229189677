"""Response of a contact to a constant force: rest, a mean velocity, or unlimited acceleration.

Friction never decreases with the velocity (theory/exact.py).  So the contact comes to rest under
every force for which a state of rest exists.  Under larger forces, the velocity increases with the
force.

A vibrated contact under a force below the static limit comes to rest (shakedown).  Period by
period, the slip zones relax and transfer their load to the stick zone, until no point slips forward
any more.  The displacement of the contact depends on the loading history.  In this computation, the
force is first applied to a contact without tangential load.  Then the vibration starts at its mean
position.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

from microslip.answer import limits
from microslip.answer.answer import ERRORS, UNKNOWN, Answer, Estimate, Result, about
from microslip.answer.closed_forms import closed_form
from microslip.answer.request import (
    RUN_SHARE,
    TOLERANCE,
    Request,
    answer_of,
    ladder_of,
    request_of,
    result_of_runs,
    runs,
)
from microslip.foundation.arguments import real
from microslip.foundation.errors import InputError
from microslip.periodic.run import Spent
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Force, Problem

FIRST_DRIFT, FACTOR = 0.1, 4.0
SLOWEST, FASTEST = 1e-6, 1e6
"""Parameters of the search for the velocity.  FIRST_DRIFT: first drift per radian of phase.
FACTOR: ratio of the drifts of two successive runs.  SLOWEST, FASTEST: bounds on the drift."""
FLATTEST = 1e-6
"""Smallest slope of the friction in the search.  The slope is the rise between two runs, divided by
the relative increase in velocity."""
HALVINGS = 2
"""Number of bisections of the last velocity interval.  The bisections are on a logarithmic
scale."""
STEADY_ERROR = 1e-9
"""Error estimate of the velocity under a force, for steady motions.  For a velocity v, the error
estimate is this value times max(1, v)."""
COARSE_TOLERANCE = 1e-2
"""Tolerance of the coarse runs that estimate the velocity under a force."""
FIRST_VELOCITY = 0.1
"""Velocity at which the resolution of the coarse runs is chosen."""
SLOWEST_SHARE = 0.3
"""Smallest accepted ratio of two velocities.  The first velocity is the velocity of the coarse run
under the force.  The second velocity is the estimate from coarse runs at prescribed velocities.  If
the ratio is smaller, the coarse run under the force is not resolved, and is not used."""
SCALE_SHARE = 0.9
"""The relative tolerance refers to this fraction of the velocity in the coarse run."""
ROUGH_TOLERANCE = 3e-2
"""First tolerance of the static limit.  The tolerance is divided by 10 until the error of the
static limit is smaller than the difference between the force and the limit."""
STATIC_TOLERANCE = 1e-3
"""Largest accepted error of the static limit when the force is close to the limit.  The SI layer
uses the same value.  Therefore, both layers agree on the forces that are below the threshold."""
GAP_MARGIN = 2.0
"""A force certainly moves the contact if the force exceeds the static limit by this factor times
the error of the limit."""
AT_REST, UNBOUNDED = Estimate(0.0, {"model": 0.0}), Estimate(math.nan, {"model": math.inf})
"""AT_REST: velocity of a contact at rest.  UNBOUNDED: velocity of a contact that has no mean
velocity."""


def under_force(request: Request) -> Result:
    """Compute the `Result` for a contact under a prescribed force."""
    problem, periodic = request.problem, request.problem.motion.periodic
    force = problem.force
    assert force is not None
    if periodic and not (problem.drive and problem.drive.mass):
        problem = limits.without_forward_motion(problem)
        request = replace(request, problem=problem)
    if force < 0.0 and not problem.propels:  # solved as the mirror image of a forward force
        ahead = under_force(_under(-force, request))
        return ahead.changed(friction=-ahead.friction, mean_velocity=-ahead.mean_velocity)
    away = limits.runs_away(problem)
    if away:
        full = Estimate(math.copysign(1.0, force))
        return _without_runs(request, UNBOUNDED, UNKNOWN, away, friction=full)
    if not periodic:
        velocity = _steady_velocity(problem, force)
        error = STEADY_ERROR * max(1.0, velocity)
        return _without_runs(request, Estimate(velocity, {"model": error}))
    if not limits.oscillates(problem):
        return _without_runs(request, AT_REST, Estimate(0.0))
    if not limits.is_even(problem):
        return _moving(request, force)
    static = _static(request, force)
    threshold, error = static.friction.value, static.friction.error
    if force <= threshold - error:
        mesh = {name: static.values[name] for name in ("model", "cells", "angles")}
        return _without_runs(request, AT_REST, static.dissipation, **mesh)
    if force > threshold + error:
        return _moving(request, force)
    least = threshold + GAP_MARGIN * error
    if not least < limits.CLOSEST_FORCE:
        return _unknown(
            request,
            f"the error of the force threshold, {error:.1e}, leaves open whether the "
            "contact moves, and a larger force is too close to full friction",
        )
    answer = _moving(request, max(force, least))
    if least > force and answer.dissipation is not None:
        # the contact moves more slowly than in the runs, or not at all
        apart = abs(answer.dissipation.value - static.dissipation.value)
        return answer.changed(dissipation=answer.dissipation + Estimate(0.0, {"model": apart}))
    return answer


def _under(force: float, request: Request) -> Request:
    """Return a copy of the request with another force."""
    assert isinstance(request.problem.drive, Force)
    return request.at(drive=replace(request.problem.drive, force=force))


def _without_runs(
    request: Request,
    velocity: Estimate,
    energy: Estimate | None = None,
    reason: str = "",
    **values: Any,
) -> Result:
    """Create a `Result` from a velocity and a dissipated energy, without a run."""
    own: dict = {"mean_velocity": velocity, "friction": Estimate(request.problem.force or 0.0)}
    if energy is not None and request.problem.motion.periodic:
        own["dissipation"] = energy
    return request.result(own, reason, periodic=not reason).changed(**values)


def _unknown(request: Request, reason: str) -> Result:
    """Create the `Result` of a point that failed.  The result contains `reason`, but no
    estimates."""
    effort = {"model": request.model, "effort": request.budget.taken}
    return _without_runs(request, UNBOUNDED, UNKNOWN, reason, **effort)


def _steady_velocity(problem: Problem, force: float) -> float:
    """Solve Eq 17 or 21 for the velocity of a steady rotation under a force from 0 to 1."""
    from scipy.optimize import brentq  # imported here because it loads slowly

    def imbalance(velocity: float) -> float:
        exact = closed_form(replace(problem, velocity=velocity, drive=None), 0.0)
        assert exact is not None  # checked by limits.refuse
        return exact["friction"].value - force

    high = 1.0
    while imbalance(high) < 0.0 and high < FASTEST:
        high *= FACTOR
    return float(brentq(imbalance, 0.0, high, xtol=1e-14, rtol=1e-14)) if force > 0.0 else 0.0


# The static limit


def _static(request: Request, force: float) -> Result:
    """Compute the static limit, just accurately enough to compare it with the force."""

    def at_rest(tolerance: float | None) -> Result:
        return answer_of(replace(request, tolerance=tolerance).at(velocity=0.0, drive=None))

    rough, tolerance = ROUGH_TOLERANCE, request.tolerance
    while tolerance is not None and tolerance < rough:
        static = at_rest(rough)
        if abs(force - static.mu_macro) > static.mu_macro_error:
            return static
        rough *= 0.1
    static = at_rest(tolerance)
    limit, error = static.friction.value, static.friction.error
    if limit - error < force <= limit + error and (tolerance or 0.0) > STATIC_TOLERANCE:
        exact = at_rest(STATIC_TOLERANCE)
        below = force <= exact.mu_macro - exact.mu_macro_error
        if below or limit + GAP_MARGIN * error >= limits.CLOSEST_FORCE:
            return exact
    return static


# The velocity


def _moving(request: Request, moving_force: float) -> Result:
    """Compute the `Result` for a moving contact.

    The runs use `moving_force`, under which the contact certainly moves.  If this force is larger
    than the requested force, the velocity lies between 0 and the velocity under `moving_force`.
    """
    force, original = request.problem.force or 0.0, request
    request = _under(moving_force, request)
    try:
        near, slope = _velocity_near(request)
    except Spent as spent:
        return _unknown(original, str(spent))
    request = request.at(velocity=near)
    scale = SCALE_SHARE * near
    while True:
        accuracy = (request.tolerance or TOLERANCE) * max(1.0, scale)
        answer = runs(request, accuracy, "velocity", slope=slope)
        velocity = answer.estimates["velocity"]
        if answer.reason or scale <= max(1.0, abs(velocity.value)):
            break
        # a body of small mass can be far slower than estimated
        scale = SCALE_SHARE * abs(velocity.value)
    if not request.problem.propels:  # a negative value is within the error
        velocity = replace(velocity, value=max(velocity.value, 0.0))
    if answer.reason and not velocity.error < abs(velocity.value):
        velocity = UNKNOWN  # the order of magnitude is unknown
    elif moving_force > force:
        half = 0.5 * velocity.value
        velocity = Estimate(half, {**velocity.by_source, "model": half})
    tolerance = request.tolerance
    largest = None if tolerance is None else tolerance * max(1.0, abs(velocity.value))
    own = {"mean_velocity": velocity, "friction": Estimate(force)}
    return result_of_runs(original, answer.changed(velocity=velocity), largest, "velocity", **own)


def _velocity_near(request: Request) -> tuple[float, float]:
    """Estimate the velocity under the force, and the rise of the friction with the velocity.

    Coarse runs at prescribed velocities bracket the unknown velocity.  A further run, at the
    prescribed force, then improves the estimate, unless the velocity of this run is too low to be
    resolved.
    """
    # imported here because they load compiled code
    from microslip.periodic.run import Settings
    from microslip.periodic.simulate import simulate

    force, moving = request.problem.force or 0.0, replace(request.problem, velocity=FIRST_VELOCITY)
    ladder = ladder_of(request.at(velocity=FIRST_VELOCITY), COARSE_TOLERANCE)
    coarse = ladder.resolution(ladder.levels(COARSE_TOLERANCE)[0])
    settings, unit = Settings(budget=request.budget), moving.unit_drift
    if request.progress is not None:
        request.progress(coarse)

    @cache
    def friction(drift: float) -> float:  # NaN if the run failed
        there = replace(moving, velocity=drift / unit, drive=None)
        return simulate(there, request.model, coarse, COARSE_TOLERANCE, settings=settings).mu

    low, high = FIRST_DRIFT / FACTOR, FIRST_DRIFT
    while high < FASTEST and friction(high) < force:
        low, high = high, FACTOR * high
    while low > SLOWEST and friction(low) > force:
        low, high = low / FACTOR, low
    slope = (friction(high) - friction(low)) / (high - low) * unit
    slope = max(slope, FLATTEST / high * unit)
    for _ in range(HALVINGS):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if friction(middle) < force else (low, middle)
    near = math.sqrt(low * high) / unit
    sloped, driven = replace(settings, slope=slope), replace(request.problem, velocity=near)
    run = simulate(driven, request.model, coarse, COARSE_TOLERANCE * near, settings=sloped)
    if run.converged and run.values["velocity"] > SLOWEST_SHARE * near:
        return run.values["velocity"], slope
    return near, slope


REST_TOLERANCE = 1e-2
"""Default tolerance of the displacement, in u_lim."""
REST_SHARE = 0.2
"""Ratio of two tolerances: the tolerance of a shakedown run, and the tolerance of a search for a
periodic state.  The step residuals accumulate over all periods.  Near the static limit, a run takes
several hundred periods (tests/answer/test_shakedown.py)."""
PLANNED_VELOCITY = 0.1
"""Velocity for which the time steps are chosen.  This velocity is above 0, because the ladder for
velocity 0 has no time steps."""
SHARED = ("model", "tolerance", "cells", "angles", "steps_per_period", "periods", "solve_time_s")
"""Names of the values that a Shakedown has in common with a Result."""


class Shakedown(Answer):
    """Dimensionless displacement of a contact that comes to rest under a force.

    Attributes
    ----------
    motion, pressure, model : str
        Names of the motion, the pressure distribution and the contact model.
    amplitude, poisson, force, tolerance : float
        Arguments of `shakedown`.
    threshold, threshold_error : float
        Static limit divided by mu times the mean normal load, and its estimated error.  Under this
        or a larger force, the contact does not come to rest.
    displacement, displacement_error : float
        Forward displacement from the position without a force to the position at rest, in u_lim,
        and its estimated error.  Both are infinite if the contact does not come to rest.
    pushed : float
        Part of the displacement caused by the force before the oscillation starts.
    most_after : float
        Number of periods in which the contact covers nine tenths of the displacement caused by the
        oscillation.
    converged : bool
        Whether the contact certainly comes to rest and the error is within the tolerance.
    reason : str
        Reason why the result has not converged, otherwise empty.
    error_resolution, error_periodicity, error_solver, error_model : float
        Contributions to the error of the displacement, by source.  `error_periodicity` bounds the
        displacement after the last period.  `error_model` is due to the resolution of an input
        file.
    cells, angles, steps_per_period : int
        Numbers of cells, of angles and of steps per period in the finest run.
    periods : float
        Number of periods in the longest run.
    work : int
        Work of all runs together: number of step solves times number of unknowns.
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
    tolerance: float = REST_TOLERANCE,
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
    if problem.velocity:
        raise InputError("velocity", problem.velocity, "allowed is 0: the contact comes to rest")
    tolerance = limits.within("tolerance", tolerance)
    problem = limits.without_forward_motion(replace(problem, velocity=0.0, drive=Force(force)))
    given: dict[str, Any] = {"model": model, "tolerance": tolerance, "progress": progress}
    request = request_of(problem, most_work=most_work, time_limit=time_limit, **given)
    if not limits.is_even(problem):
        allowed = "allowed is a motion that exerts no forward force by itself, such as transverse"
        raise InputError("motion", problem.motion.name, allowed)
    limit, away = _threshold(request)
    if not away and force >= limit.value - limit.error:
        away = f"the error of the threshold, {limit.error:.1e}, leaves open whether the force is "
        away += "below"
        if force > limit.value + limit.error:
            away = f"drifts on for ever: the force is above the threshold, {limit.value:.4g}"
    names = ("motion", "pressure", "amplitude", "poisson", "force")
    own: dict[str, Any] = {name: about(problem)[name] for name in names}
    own |= {"threshold": limit.value, "threshold_error": limit.error}
    endless = {"displacement": Estimate(math.inf, {"model": math.inf})}
    answer = Answer(problem, {"imposed": False}, endless, away)
    if not away:
        ladder = ladder_of(request.at(velocity=PLANNED_VELOCITY), tolerance)
        # the contact must come to rest in the coarsest run too
        ladder, share = replace(ladder, start=2 * ladder.start), REST_SHARE * RUN_SHARE
        answer = runs(request, tolerance, "displacement", ladder=ladder, share=share)
    still = {"friction": Estimate(force)}
    result = result_of_runs(request, answer, request.tolerance, "displacement", **still)
    displacement = answer.displacement
    own |= {name: getattr(result, name) for name in SHARED} | dict.fromkeys(ERRORS.values(), 0.0)
    if not away:
        own |= {ERRORS[source]: error for source, error in displacement.by_source.items()}
    finest = answer.finest.values if "finest" in answer.values else {}
    own |= {name: finest.get(name, math.nan) for name in ("pushed", "most_after")}
    own |= {"displacement": displacement.value, "displacement_error": displacement.error}
    return Shakedown(problem, own | {"work": result.effort.work}, reason=result.reason)


def _threshold(request: Request) -> tuple[Estimate, str]:
    """Return the static limit, and the reason why the contact runs away.  The reason is "" if the
    contact does not run away."""
    problem = request.problem
    away = limits.runs_away(problem)
    if not limits.oscillates(problem):
        return Estimate(1.0), away
    if away:
        return Estimate(math.nan, {"model": math.inf}), away
    tolerance = min(request.tolerance or STATIC_TOLERANCE, STATIC_TOLERANCE)
    still = replace(request, chosen=True, tolerance=tolerance).at(drive=None)
    return answer_of(still).friction, ""
