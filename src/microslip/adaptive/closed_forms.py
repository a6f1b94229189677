"""Results in closed form, which need no run."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from microslip.adaptive.request import Request, result_of_runs
from microslip.adaptive.result import Result
from microslip.estimate.estimate import Estimate
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.method_names import SHIPPED
from microslip.theory import hertz, masing, paper
from microslip.theory.exact import LARGEST_DROPS, STATIC_LIMITS

QUADRATURE = 1e-7
"""Error of the quadrature in Eqs 17 and 18 for pressures other than Hertz.  Such pressures can have
kinks."""
WHOLE_ROUNDING = 1e-9
OF_RECORD = 1e-8
"""Errors of closed forms with a quadrature.  For a sphere, the quadrature is over the motion only;
for another indenter, it is also over the pressure."""
ROUNDING = 1e-12
"""Error of closed forms that need no quadrature."""


class Exact(NamedTuple):
    """Quantities of a Result in closed form.

    Attributes
    ----------
    friction : Estimate
        Mean friction.
    torque : Estimate or None
        Torque divided by its value at zero forward velocity; None for oscillating motions.
    dissipation : Estimate or None
        Dissipated energy per period, divided by mu F_z u_lim; None for steady motions.
    """

    friction: Estimate
    torque: Estimate | None = None
    dissipation: Estimate | None = None


def exact_for(request: Request) -> Exact | None:
    """Closed form for a request; None if there is none or if an imposed resolution requires a
    march."""
    problem = request.problem
    exact = no_vibration(problem)
    needs_march = problem.velocity > 0.0 and not (request.cells is None and request.steps is None)
    if exact is None and request.chosen and request.method == SHIPPED and not needs_march:
        exact = closed_form(problem, request.tolerance or 0.0)
    return exact


def of_closed_form(request: Request, exact: Exact) -> Result:
    """Build the Result of a closed form."""
    error, tolerance = exact.friction.error, request.tolerance
    within = tolerance is None or error <= tolerance
    return Result(
        **request.point | exact._asdict(),
        model=request.model_without_runs,
        converged=within,
        periodic=True,
        reason="" if within else f"the error is {error:.1e}, above the tolerance of {tolerance:g}",
        solve_time_s=request.seconds,
    )


def solve_prescribed(request: Request) -> Result:
    """Friction at a prescribed velocity: a closed form if there is one, otherwise runs of a
    model."""
    exact = exact_for(request)
    if exact is not None:
        return of_closed_form(request, exact)
    # imported here because they load compiled code
    from microslip.adaptive.friction import ladder_of, runs_of
    from microslip.estimate.refine import refine

    problem, accuracy = request.problem, request.accuracy
    ladder, every = ladder_of(request, accuracy), (problem, *problem.readings)
    unit = problem.largest_energy
    refined = refine(runs_of(request), ladder, every, accuracy, energy_unit=unit)
    return result_of_runs(request, refined, request.tolerance)


def no_vibration(problem: Problem) -> Exact | None:
    """Closed form for any model if the amplitude is 0, otherwise None."""
    still = problem.motion.periodic and problem.amplitude == 0.0
    return _of_drag(problem, _within(1.0, ROUNDING), _within(1.0, ROUNDING)) if still else None


def _within(value: float, error: float) -> Estimate:
    """Estimate of a value in closed form."""
    return Estimate(value, {"model": error})


def _of_drag(problem: Problem, friction: Estimate, drag: Estimate) -> Exact:
    """Closed form in which the dissipated energy is the work of the mean force `drag`."""
    work = 2.0 * math.pi * problem.mean_load * problem.drift
    return Exact(friction, dissipation=work * drag)


def closed_form(problem: Problem, tolerance: float) -> Exact | None:
    """Result of a closed form, or None if no closed form applies.

    Closed forms exist in four cases.  The first is the steady state of a motion without
    oscillation, where every point slips in the direction of its rigid velocity.  The second is the
    limit of vanishing velocity, and the third is motion along one line at nu = 0.  The fourth is
    fast sliding, if the bounds in bounds.py differ by less than the tolerance.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    tolerance : float
        Absolute tolerance of the friction.

    Returns
    -------
    Exact or None
    """
    motion, velocity, amplitude = problem.motion, problem.velocity, problem.size
    if not motion.periodic:
        return _steady_bore(problem) if motion.name == "continuous-bore" else None
    transformed = problem.follows or problem.backward
    if problem.poisson == 0.0 and not transformed:
        exact = motion.closed_form(velocity, amplitude, problem.pressure)
        if exact is not None:
            error = WHOLE_ROUNDING if velocity > 0.0 else ROUNDING
            mu, energy = exact
            return _exact(mu, energy, error if problem.pressure.hertzian else OF_RECORD)
    if velocity == 0.0:
        limit = STATIC_LIMITS.get(motion.name)
        if limit is None or (problem.poisson > 0.0 and not limit.any_poisson):
            return None
        return _static(problem, limit.function)
    return fast_sliding(problem, tolerance)


def fast_sliding(problem: Problem, tolerance: float) -> Exact | None:
    """Midpoint of the bounds for fast sliding, or None if they differ by more than the tolerance.

    Per radian, the dissipated energy is between the drift d and d (1 + drop / (4 - 2 drop)), see
    theory/bounds.py.  `drop` is the largest value of 1 - mu.
    """
    motion = problem.motion
    largest_drop = LARGEST_DROPS.get(motion.name)
    if largest_drop is None or (motion.rotates and problem.pressure != HERTZ):
        return None
    drop = largest_drop(problem.velocity, problem.size)
    error = 0.5 * drop + ROUNDING
    if error > tolerance:
        return None
    excess = 0.5 * drop / (4.0 - 2.0 * drop)
    drag = _within(1.0 + excess, excess + ROUNDING)
    return _of_drag(problem, _within(1.0 - 0.5 * drop, error), drag)


def _steady_bore(problem: Problem) -> Exact | None:
    """Steady bore motion from Eqs 17 and 18, or from Eqs 21 and 22 for a sphere."""
    velocity = problem.velocity
    if problem.pressure == HERTZ:
        both = paper.bore_forward(velocity), paper.bore_torque(velocity)
        return Exact(*(_within(float(value), ROUNDING) for value in both))
    if not problem.pressure.is_round:
        return None
    from microslip.theory import axisymmetric  # imported here because it loads slowly

    both = axisymmetric.bore_of(problem.pressure.bound, velocity)
    return Exact(*(_within(float(value), QUADRATURE) for value in both))


def _exact(mu: float, energy: float, error: float) -> Exact:
    """Build an Exact; `error` is absolute for the friction, and relative for an energy above 1."""
    return Exact(_within(mu, error), dissipation=_within(energy, error * max(1.0, energy)))


def _static(problem: Problem, of_sphere: Callable) -> Exact | None:
    """Static limit, or None if there is no closed form for the pressure."""
    motion, pressure, amplitude = problem.motion, problem.pressure, problem.size
    sphere = pressure == HERTZ or (pressure.hertzian and not motion.rotates)
    if not (sphere or pressure.is_indenter):
        return None
    from microslip.theory import indenters as limits  # imported here because it loads slowly

    error = ROUNDING if sphere else OF_RECORD
    if not motion.rotates:
        mu = of_sphere(amplitude) if sphere else limits.static_transverse(pressure, amplitude)
        return _exact(float(mu), float(masing.loop_energy(amplitude, pressure.loading)), error)
    place = float(hertz.bore_angle(amplitude, problem.poisson)), problem.poisson
    mu = of_sphere(amplitude) if sphere else limits.static_bore(pressure, *place)
    energy = limits.torsion_energy(pressure, *place)
    return _exact(float(mu), energy, OF_RECORD)._replace(friction=_within(float(mu), error))
