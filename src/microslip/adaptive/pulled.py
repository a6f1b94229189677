"""The friction of a contact that a spring pulls, and the velocity of one that a force pulls."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from typing import Any

from microslip.adaptive.closed_forms import CLOSED_FORM, ROUNDING
from microslip.adaptive.request import Request, verdict, within_friction
from microslip.adaptive.result import Result, of_closed_form
from microslip.adaptive.several import solve_each
from microslip.adaptive.under_force import (
    CLOSEST_FORCE,
    Near,
    drive_of,
    force_of,
    is_even,
    oscillates,
    refuse_nearly_full,
    refuse_steady,
    runs_away,
    steady_velocity,
    velocity_near,
    without_forward_motion,
)
from microslip.estimate.estimate import Estimate
from microslip.estimate.ladder import Ladder, ladder_for, refuse_free, with_mass
from microslip.estimate.refine import UNKNOWN, Refined, refine, run_tolerance, unknown
from microslip.foundation.errors import InputError
from microslip.models.registry import MODELS
from microslip.motions.drive import Drive, Force
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.body_run import simulate_each
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.method_names import SHIPPED
from microslip.solver.pulled_run import Accuracy, simulate_pulled
from microslip.solver.run import Run, Settings
from microslip.solver.stick_edge import found_focus
from microslip.theory.exact import LARGEST_DROPS

STEADY_ERROR = 1e-9
"""Stated error of the velocity of a steady motion, over 1 and the velocity."""
COARSE_TOLERANCE = 1e-2
"""Tolerance of the coarse runs that locate the velocity under a force."""
COARSEST = Resolution(cells=8, angles=4, steps=4)
"""Resolution of a contact that is built for its stiffness only."""
FIRST_VELOCITY = 0.1
"""Velocity for which the coarse runs are planned."""
SLOWEST_SHARE = 0.3
"""Least velocity of the coarse run under the force, over the velocity from the friction of coarse
runs; a slower run under the force is not resolved and is not used."""
SCALE_SHARE = 0.9
"""Share of the coarse velocity that the relative tolerance refers to."""
ROUGH_TOLERANCE = 3e-2
"""First tolerance of the static limit.  It is divided by 10 until the force differs from the limit
by more than the error."""
STATIC_TOLERANCE = 1e-3
"""Largest accepted error of a static limit that a force is close to; the SI side asks for the same,
so that both agree on what is below the threshold."""
GAP_MARGIN = 2.0
"""Errors of the static limit above it at which the contact moves for certain."""


def refuse_drive(problem: Problem, model: str) -> None:
    """Raise InputError where a model, by name, or a motion does not go with a drive."""
    motion, drive = problem.motion, drive_of(problem)
    pulls = "stiffness" if drive.force is None else "force"
    if drive.force is not None and drive.force < 0.0 and not problem.propels:
        allowed = f"allowed is a number of at least 0: {motion.name} propels nothing"
        raise InputError("force", drive.force, allowed)
    if not MODELS[model].drivable:
        raise InputError("model", model, f"does not know a {pulls}, a velocity alone")
    if drive.force is not None:
        if not motion.periodic:
            refuse_steady(problem)
        refuse_nearly_full(problem)
    elif motion.periodic and problem.velocity == 0.0 and not is_even(problem):
        allowed = f"allowed is a number above 0 where a spring pulls {motion.name}"
        raise InputError("velocity", 0.0, allowed)


def refuse_pull(request: Request) -> None:
    """Raise InputError where what is asked does not go with a drive."""
    drive = drive_of(request.problem)
    refuse_drive(request.problem, request.model)
    if request.method != SHIPPED:
        pulls = "stiffness" if drive.force is None else "force"
        raise InputError("method", request.method, f"allowed is {SHIPPED} with a {pulls}")


def solve_pulled(request: Request) -> Result:
    """The friction, or under a force the velocity, with its error estimate: a result.Result; see
    microslip.solve.

    It is for the caller to `refuse_pull` before.
    """
    drive = drive_of(request.problem)
    if drive.force is not None:
        return _under_force(request)
    body: dict[str, Any] = {
        "stiffness": drive.stiffness,
        "mass": drive.mass,
        "damping": drive.damping,
    }
    problem = request.problem
    if not problem.motion.periodic or problem.velocity == 0.0 or not oscillates(problem):
        # what is steady stretches the spring to one length, whatever it is
        return replace(solve_each(_prescribed(request)), **body)
    bracket = _bracket(request)
    if bracket is not None:
        point = request.point | {"model": CLOSED_FORM}
        return replace(of_closed_form(point, bracket, request.seconds), **body)
    refined, ladder = _refined(request, Accuracy(request.accuracy))
    return Result(
        **request.point,
        **body,
        model=request.model,
        friction=within_friction(problem, refined.value),
        **verdict(request, refined, ladder, request.tolerance),
    )


def _bracket(request: Request) -> tuple[float, None, float] | None:
    """(mu, torque, error) by the energy bound of theory/bounds.py, or None where its error is above
    the tolerance.

    The bound of a transverse or bore motion holds for any body on a spring: the work of the spring
    in a period is the mean force times the way, a mass adds nothing, and a dashpot takes some away.
    """
    motion = request.problem.motion
    imposed = request.cells is not None or request.steps is not None
    if not request.chosen or imposed or request.tolerance is None or request.problem.parts:
        return None
    if motion.name not in ("transverse", "bore") or (
        motion.rotates and request.problem.pressure != HERTZ
    ):
        return None
    drop = LARGEST_DROPS[motion.name](request.problem.velocity, request.problem.size)
    error = 0.5 * drop + ROUNDING
    return (1.0 - 0.5 * drop, None, error) if error <= request.tolerance else None


def _prescribed(request: Request) -> Request:
    """The request at the prescribed velocity of the problem, without its drive."""
    return replace(request, problem=replace(request.problem, drive=None))


def _driven(request: Request, **drive: float) -> Request:
    """The request with a changed drive."""
    problem = request.problem
    changed = problem.drive
    assert isinstance(changed, Force)
    return replace(request, problem=replace(problem, drive=replace(changed, **drive)))


def _under_force(request: Request) -> Result:
    """The velocity under a force."""
    drive = drive_of(request.problem)
    if drive.mass == 0.0 and request.problem.motion.periodic:
        request = replace(request, problem=without_forward_motion(request.problem))
    problem, force = request.problem, force_of(request.problem)
    if force < 0.0 and not problem.propels:  # a pull back is a pull forward, seen from behind
        ahead = _under_force(_driven(request, force=-force))
        return replace(
            ahead, force=force, friction=-ahead.friction, mean_velocity=-ahead.mean_velocity
        )
    away = runs_away(problem)
    if away:
        return _known(request, math.nan, math.inf, away)
    if not problem.motion.periodic:
        velocity = steady_velocity(problem)
        return _known(request, velocity, STEADY_ERROR * max(1.0, velocity))
    if not oscillates(problem):
        return _known(request, 0.0, 0.0)
    least = -math.inf
    if is_even(problem):
        static = _static(request, force)
        if _is_close(force, static) and (request.tolerance or 0.0) > STATIC_TOLERANCE:
            exact = _at_rest(request, STATIC_TOLERANCE)
            if _is_below(force, exact) or _surely_moving(static) >= CLOSEST_FORCE:
                static = exact
        if _is_below(force, static):
            return replace(
                _known(request, 0.0, 0.0),
                model=static.model,
                cells=static.cells,
                angles=static.angles,
            )
        if _is_close(force, static):
            least = _surely_moving(static)
            if not least < CLOSEST_FORCE:
                error = static.mu_macro_error
                return _given_up(
                    request,
                    f"the error of the force threshold, {error:.1e}, does not tell whether the "
                    "contact moves, and a larger force is too close to full friction",
                )
    return _moving(request, max(force, least))


def _is_below(force: float, static: Result) -> bool:
    """Whether a force is below the static limit by its error or more."""
    return force <= static.mu_macro - static.mu_macro_error


def _is_close(force: float, static: Result) -> bool:
    """Whether the error of the static limit leaves open on which side of it a force is."""
    low, high = (static.mu_macro + sign * static.mu_macro_error for sign in (-1, 1))
    return low < force <= high


def _surely_moving(static: Result) -> float:
    """A force at which the contact moves, by the error estimate of the static limit."""
    return static.mu_macro + GAP_MARGIN * static.mu_macro_error


def _static(request: Request, force: float) -> Result:
    """The Result of the static limit, no more exactly than the force needs to be told from it."""
    rough = ROUGH_TOLERANCE
    while request.tolerance is not None and request.tolerance < rough:
        static = _at_rest(request, rough)
        if abs(force - static.mu_macro) > static.mu_macro_error:
            return static
        rough *= 0.1
    return _at_rest(request, request.tolerance)


def _at_rest(request: Request, tolerance: float | None) -> Result:
    """The Result of the static limit, to a tolerance."""
    problem = replace(request.problem, velocity=0.0, drive=None)
    return solve_each(replace(request, problem=problem, tolerance=tolerance))


def _known(request: Request, velocity: float, error: float, reason: str = "") -> Result:
    """The Result where nothing has to be marched."""
    drive, force = drive_of(request.problem), force_of(request.problem)
    return Result(
        **request.point | {"mean_velocity": Estimate(velocity, {"model": error})},
        **_pulling(drive),
        model=CLOSED_FORM if request.chosen else request.model,
        friction=Estimate(math.copysign(1.0, force) if reason else force),
        converged=not reason and _good_enough(error, velocity, request.tolerance),
        periodic=not reason,
        reason=reason,
        solve_time_s=request.seconds,
    )


def _good_enough(error: float, velocity: float, tolerance: float | None) -> bool:
    return tolerance is None or error <= tolerance * max(1.0, abs(velocity))


def _pulling(drive: Drive) -> dict[str, Any]:
    """Fields that say how a force pulls."""
    return {"force": drive.force} | ({"mass": drive.mass} if drive.mass > 0.0 else {})


def _moving(request: Request, marched: float) -> Result:
    """The Result of a contact that moves, marched under a force that it moves under for certain.

    Where the static limit is not known well enough to tell whether it moves under the force that
    was asked for, its velocity is between 0 and that one.
    """
    drive, force, original = drive_of(request.problem), force_of(request.problem), request
    request = _driven(request, force=marched)
    try:
        near = _near(request)
    except Spent as spent:
        return _given_up(original, str(spent))
    request = replace(request, problem=replace(request.problem, velocity=near.velocity))
    scale = SCALE_SHARE * near.velocity
    while True:
        accuracy = Accuracy(request.accuracy * max(1.0, scale), near.slope)
        refined, ladder = _refined(request, accuracy)
        velocity = abs(refined.value.value)
        if not refined.converged or scale <= max(1.0, velocity):
            break
        scale = SCALE_SHARE * velocity  # with a small mass it may be far below the coarse one
    found = refined.value
    if not request.problem.propels:
        found = replace(found, value=max(found.value, 0.0))  # below are rounding and error
    if not refined.converged and not found.error < abs(found.value):
        found = UNKNOWN  # not even its order of magnitude
    elif marched > force:
        half = 0.5 * found.value
        found = Estimate(half, {**found.by_source, "model": half})
    refined = replace(refined, value=found)
    tolerance = request.tolerance
    largest = None if tolerance is None else tolerance * max(1.0, abs(found.value))
    return Result(
        **request.point | {"mean_velocity": found},
        **_pulling(drive),
        model=request.model,
        friction=Estimate(force),
        **verdict(request, refined, ladder, largest),
    )


def _near(request: Request) -> Near:
    """The under_force.Near of what the force makes of the contact, by coarse runs.

    Friction of the contact that is moved tells about where it is, and one run under the force more
    exactly, unless it is so slow that this would take finer ones.
    """
    moving = replace(request.problem, velocity=FIRST_VELOCITY)
    force = force_of(request.problem)
    # the plan depends on where slip starts, and finds it again by itself
    found_focus(moving, request.model, request.budget, request.progress)
    ladder = ladder_for(moving, request.model, COARSE_TOLERANCE, request.cells, request.steps)
    if request.tolerance is None:
        refuse_free(ladder, request.cells, request.steps)
    coarse = ladder.resolution(ladder.levels(COARSE_TOLERANCE)[0])
    settings = Settings(request.how, budget=request.budget)
    if request.progress is not None:
        request.progress(coarse)

    def friction_at(velocity: float) -> float:
        there = replace(moving, velocity=velocity)
        return simulate_each(there, request.model, coarse, COARSE_TOLERANCE, settings).mu

    near = velocity_near(moving, force, friction_at)
    place = replace(moving, velocity=near.velocity)
    accuracy = Accuracy(COARSE_TOLERANCE * near.velocity, near.slope)
    found = simulate_pulled(place, request.model, coarse, accuracy, settings)
    if found.converged and found.velocity > SLOWEST_SHARE * near.velocity:
        return near._replace(velocity=found.velocity)
    return near


def _given_up(request: Request, reason: str) -> Result:
    """The Result of a point of which nothing is known yet."""
    unknown = replace(_known(request, math.nan, math.inf, reason), model=request.model)
    return replace(
        unknown,
        friction=Estimate(force_of(request.problem)),
        exhausted=request.budget.exhausted,
        effort=request.budget.taken,
    )


def _refined(request: Request, accuracy: Accuracy) -> tuple[Refined, Ladder]:
    """The refine.Refined to an accuracy, and its ladder."""
    problem, tolerance = request.problem, accuracy.tolerance
    drive = drive_of(problem)
    try:
        found_focus(problem, request.model, request.budget, request.progress)
    except Spent as spent:
        return unknown(f"{spent}: no error is known yet"), Ladder(1, 0, 0)
    ladder = ladder_for(problem, request.model, tolerance, request.cells, request.steps)
    contact = contact_of(problem, request.model, COARSEST)
    ladder, unresolved = with_mass(ladder, problem, contact, drive.mass, tolerance)
    share = accuracy._replace(tolerance=run_tolerance(tolerance))
    if request.tolerance is None:
        refuse_free(ladder, request.cells, request.steps)
    settings = Settings(request.how, budget=request.budget)

    def run(resolution: Resolution, guess: Run | None, problem: Problem = problem) -> Run:
        if request.progress is not None:
            request.progress(resolution)
        return simulate_pulled(problem, request.model, resolution, share, settings, guess=guess)

    readings = [
        partial(run, problem=replace(problem, pressure=other))
        for other in problem.pressure.readings
    ]
    quantity = "mu" if drive.force is None else "velocity"
    refined = refine(run, ladder, tolerance, readings, quantity)
    if unresolved and refined.converged:
        refined = replace(refined, converged=False, reason=unresolved)
    return refined, ladder
