"""Friction of a contact on a spring, and velocity of a contact under a prescribed force."""

from __future__ import annotations

import math
from dataclasses import replace

from microslip.adaptive.closed_forms import Exact, fast_sliding, of_closed_form, solve_prescribed
from microslip.adaptive.friction import ladder_of
from microslip.adaptive.request import Request, driven_by, result_of_runs
from microslip.adaptive.result import Result
from microslip.adaptive.under_force import (
    CLOSEST_FORCE,
    Near,
    drive_of,
    force_of,
    is_even,
    oscillates,
    runs_away,
    steady_velocity,
    velocity_near,
    without_forward_motion,
)
from microslip.estimate.estimate import Estimate
from microslip.estimate.ladder import with_mass
from microslip.estimate.refine import UNKNOWN, Refined, refine, run_tolerance
from microslip.motions.drive import Force
from microslip.motions.problem import Problem
from microslip.solver.budget import Spent
from microslip.solver.discretise import Resolution, contact_of
from microslip.solver.run import Run, Settings
from microslip.solver.simulate import simulate

STEADY_ERROR = 1e-9
"""Error estimate of the velocity v of a steady motion under a force, divided by max(1, v)."""
COARSE_TOLERANCE = 1e-2
"""Tolerance of the coarse runs that estimate the velocity under a force."""
COARSEST = Resolution(cells=8, angles=4, steps=4)
"""Resolution at which the contact's stiffness is computed.  For a body with mass, the time steps
depend on this stiffness."""
FIRST_VELOCITY = 0.1
"""Velocity at which the resolution of the coarse runs is chosen."""
SLOWEST_SHARE = 0.3
"""Smallest accepted velocity of the coarse run under the force, as a fraction of the estimate from
coarse runs at prescribed velocities.  A slower run is not resolved and is not used."""
SCALE_SHARE = 0.9
"""The relative tolerance refers to this fraction of the coarse run's velocity."""
ROUGH_TOLERANCE = 3e-2
"""First tolerance of the static limit.  It is divided by 10 until the difference between the force
and the limit exceeds the error of the limit."""
STATIC_TOLERANCE = 1e-3
"""Largest accepted error of the static limit when the force is close to it.  The SI layer uses the
same value, so both agree on which forces are below the threshold."""
GAP_MARGIN = 2.0
"""Distance above the static limit at which the contact certainly moves, in units of the limit's
error."""


def solve_driven(request: Request) -> Result:
    """Compute the friction of a driven contact, or its velocity under a prescribed force."""
    problem, drive = request.problem, drive_of(request.problem)
    if drive.force is not None:
        return _under_force(request)
    if not problem.motion.periodic or problem.velocity == 0.0 or not oscillates(problem):
        # under a constant force the length of the spring is constant
        answer = solve_prescribed(replace(request, problem=replace(problem, drive=None)))
        return replace(answer, **driven_by(drive))
    exact = _fast(request)
    if exact is not None:
        return of_closed_form(request, exact)
    return result_of_runs(request, _refined(request, request.accuracy), request.tolerance)


def _fast(request: Request) -> Exact | None:
    """Closed form from the energy bound of theory/bounds.py.

    Returns None if the error exceeds the tolerance.  The bound for transverse and bore motions also
    applies to a body on a spring.  Over a period, the spring does the work of the mean force, a
    mass does no work, and a dashpot dissipates energy.
    """
    problem = request.problem
    imposed = request.cells is not None or request.steps is not None
    if not request.chosen or imposed or request.tolerance is None:
        return None
    if problem.motion.name not in ("transverse", "bore"):
        return None
    return fast_sliding(problem, request.tolerance)


def _under(force: float, request: Request) -> Request:
    """Copy a request and replace its force."""
    drive = Force(force, drive_of(request.problem).mass)
    return replace(request, problem=replace(request.problem, drive=drive))


def _under_force(request: Request) -> Result:
    """Compute the Result of a contact under a prescribed force."""
    drive = drive_of(request.problem)
    if drive.mass == 0.0 and request.problem.motion.periodic:
        request = replace(request, problem=without_forward_motion(request.problem))
    problem, force = request.problem, force_of(request.problem)
    if force < 0.0 and not problem.propels:  # solved as the mirror image of a forward force
        ahead = _under_force(_under(-force, request))
        return replace(
            ahead, force=force, friction=-ahead.friction, mean_velocity=-ahead.mean_velocity
        )
    away = runs_away(problem)
    if away:
        return _without_runs(request, math.nan, math.inf, UNKNOWN, away)
    if not problem.motion.periodic:
        velocity = steady_velocity(problem)
        return _without_runs(request, velocity, STEADY_ERROR * max(1.0, velocity), None)
    if not oscillates(problem):
        return _without_runs(request, 0.0, 0.0, Estimate(0.0))
    least = -math.inf
    if is_even(problem):
        static = _static(request, force)
        if _is_close(force, static) and (request.tolerance or 0.0) > STATIC_TOLERANCE:
            exact = _at_rest(request, STATIC_TOLERANCE)
            if _is_below(force, exact) or _surely_moving(static) >= CLOSEST_FORCE:
                static = exact
        if _is_below(force, static):
            return replace(
                _without_runs(request, 0.0, 0.0, static.dissipation),
                model=static.model,
                cells=static.cells,
                angles=static.angles,
            )
        if _is_close(force, static):
            least = _surely_moving(static)
            if not least < CLOSEST_FORCE:
                error = static.mu_macro_error
                return _without_answer(
                    request,
                    f"the error of the force threshold, {error:.1e}, leaves open whether the "
                    "contact moves, and a larger force is too close to full friction",
                )
    answer = _moving(request, max(force, least))
    if least > force and answer.dissipation and static.dissipation:
        # the contact moves more slowly than in the runs, or not at all
        apart = abs(answer.dissipation.value - static.dissipation.value)
        unknown = Estimate(0.0, {"model": apart})
        answer = replace(answer, dissipation=answer.dissipation + unknown)
    return answer


def _is_below(force: float, static: Result) -> bool:
    """Whether a force is below the static limit by at least the error of the limit."""
    return force <= static.mu_macro - static.mu_macro_error


def _is_close(force: float, static: Result) -> bool:
    """Whether a force differs from the static limit by less than the error of the limit."""
    low, high = (static.mu_macro + sign * static.mu_macro_error for sign in (-1, 1))
    return low < force <= high


def _surely_moving(static: Result) -> float:
    """A force at which the contact certainly moves, given the error of the static limit."""
    return static.mu_macro + GAP_MARGIN * static.mu_macro_error


def _static(request: Request, force: float) -> Result:
    """Compute the static limit, just accurately enough to compare it with the force."""
    rough = ROUGH_TOLERANCE
    while request.tolerance is not None and request.tolerance < rough:
        static = _at_rest(request, rough)
        if abs(force - static.mu_macro) > static.mu_macro_error:
            return static
        rough *= 0.1
    return _at_rest(request, request.tolerance)


def _at_rest(request: Request, tolerance: float | None) -> Result:
    """Compute the static limit to a tolerance."""
    problem = replace(request.problem, velocity=0.0, drive=None)
    return solve_prescribed(replace(request, problem=problem, tolerance=tolerance))


def _without_runs(
    request: Request,
    velocity: float,
    error: float,
    energy: Estimate | None,
    reason: str = "",
) -> Result:
    """Build a Result without a run, from a velocity and a dissipated energy.

    `reason` says why the result is not converged.
    """
    force, tolerance = force_of(request.problem), request.tolerance
    return Result(
        **request.point | {"mean_velocity": Estimate(velocity, {"model": error})},
        model=request.model_without_runs,
        friction=Estimate(math.copysign(1.0, force) if reason else force),
        dissipation=energy if request.problem.motion.periodic else None,
        converged=not reason and (tolerance is None or error <= tolerance * max(1.0, velocity)),
        periodic=not reason,
        reason=reason,
        solve_time_s=request.seconds,
    )


def _moving(request: Request, moving_force: float) -> Result:
    """Compute the Result of a moving contact.

    The runs use `moving_force`, under which the contact certainly moves.  If this force is larger
    than the requested force, the velocity lies between 0 and the velocity in the runs.
    """
    force, original = force_of(request.problem), request
    request = _under(moving_force, request)
    try:
        near = _near(request)
    except Spent as spent:
        return _without_answer(original, str(spent))
    request = replace(request, problem=replace(request.problem, velocity=near.velocity))
    scale = SCALE_SHARE * near.velocity
    while True:
        refined = _refined(request, request.accuracy * max(1.0, scale), near.slope)
        estimate = refined.estimates["velocity"]
        velocity = abs(estimate.value)
        if not refined.converged or scale <= max(1.0, velocity):
            break
        scale = SCALE_SHARE * velocity  # a small mass can move far more slowly than the coarse run
    if not request.problem.propels:
        # a negative value is within the error
        estimate = replace(estimate, value=max(estimate.value, 0.0))
    if not refined.converged and not estimate.error < abs(estimate.value):
        estimate = UNKNOWN  # the order of magnitude is unknown
    elif moving_force > force:
        half = 0.5 * estimate.value
        estimate = Estimate(half, {**estimate.by_source, "model": half})
    refined = replace(refined, estimates={**refined.estimates, "velocity": estimate})
    tolerance = request.tolerance
    largest = None if tolerance is None else tolerance * max(1.0, abs(estimate.value))
    more = {"mean_velocity": estimate, "friction": Estimate(force)}
    return result_of_runs(original, refined, largest, "velocity", **more)


def _near(request: Request) -> Near:
    """Estimate the velocity under the force by coarse runs.

    Runs at prescribed velocities bracket the velocity under the force.  A run under the force then
    improves the estimate, unless its velocity is too low to be resolved.
    """
    driven, moving = request.problem, replace(request.problem, velocity=FIRST_VELOCITY)
    force = force_of(request.problem)
    ladder = ladder_of(replace(request, problem=moving), COARSE_TOLERANCE)
    coarse = ladder.resolution(ladder.levels(COARSE_TOLERANCE)[0])
    settings = Settings(request.how, budget=request.budget)
    request.show(coarse)

    def friction_at(velocity: float) -> float:
        there = replace(moving, velocity=velocity, drive=None)
        return simulate(there, request.model, coarse, COARSE_TOLERANCE, settings=settings).mu

    near = velocity_near(moving, force, friction_at)
    place = replace(driven, velocity=near.velocity)
    tolerance, sloped = COARSE_TOLERANCE * near.velocity, replace(settings, slope=near.slope)
    run = simulate(place, request.model, coarse, tolerance, settings=sloped)
    if run.converged and run.values["velocity"] > SLOWEST_SHARE * near.velocity:
        return near._replace(velocity=run.values["velocity"])
    return near


def _without_answer(request: Request, reason: str) -> Result:
    """Result without any estimate, for a point that failed because of `reason`."""
    unknown = _without_runs(request, math.nan, math.inf, UNKNOWN, reason)
    return replace(
        unknown,
        model=request.model,
        friction=Estimate(force_of(request.problem)),
        exhausted=request.budget.exhausted,
        effort=request.budget.taken,
    )


def _refined(request: Request, tolerance: float, slope: float = math.inf) -> Refined:
    """Refine the runs of a driven contact; for the slope under a force see run.Settings."""
    problem, drive = request.problem, drive_of(request.problem)
    contact = contact_of(problem, request.model, COARSEST)
    ladder, unresolved = with_mass(
        ladder_of(request, tolerance), problem, contact, drive.mass, tolerance
    )
    settings, share = (
        Settings(request.how, budget=request.budget, slope=slope),
        run_tolerance(tolerance),
    )

    def run(problem: Problem, resolution: Resolution, guess: Run | None) -> Run:
        request.show(resolution)
        return simulate(problem, request.model, resolution, share, guess, settings)

    name, unit, work = "friction", problem.largest_energy, 0.0
    if drive.force is not None:  # a velocity error changes the drift and the forces
        name = "velocity"
        work = 2.0 * math.pi * problem.mean_load * problem.unit_drift * abs(drive.force)
        unit = slope * unit + work
    every = (problem, *problem.readings)
    refined = refine(run, ladder, every, tolerance, name, energy_unit=unit, drive_work=work)
    if unresolved and refined.converged:
        refined = replace(refined, reason=unresolved)
    return refined
