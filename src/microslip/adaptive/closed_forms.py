"""Results in closed form, which need no run."""

from __future__ import annotations

from collections.abc import Callable

from microslip.adaptive.request import Request
from microslip.adaptive.result import Result, of_closed_form
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.method_names import SHIPPED
from microslip.theory import hertz, paper
from microslip.theory.exact import LARGEST_DROPS, STATIC_LIMITS

CLOSED_FORM = "closed-form"
"""Name of the model in results that are not marched."""
QUADRATURE = 1e-7
"""Error of the quadrature in Eqs 17 and 18 for pressures other than Hertz, which can have kinks."""
WHOLE_ROUNDING = 1e-9
OF_RECORD = 1e-8
"""Errors of closed forms by quadrature: over the motion for a sphere, and also over the
pressure for another indenter."""
ROUNDING = 1e-12
"""Error of closed forms that need no quadrature."""


def exact_result(request: Request) -> Result | None:
    """Result in closed form, or None if there is no closed form."""
    exact = no_vibration(request.problem)
    if exact is None and request.chosen and request.method == SHIPPED:
        exact = unless_imposed(request.problem, request.tolerance, request.cells, request.steps)
    if exact is None:
        return None
    used = CLOSED_FORM if request.chosen else request.model
    return of_closed_form(request.point | {"model": used}, exact, request.seconds)


def no_vibration(problem: Problem) -> tuple | None:
    """(mu, torque, error) for any model if the amplitude is 0, otherwise None."""
    still = problem.motion.periodic and problem.amplitude == 0.0
    return (1.0, None, ROUNDING) if still else None


def unless_imposed(
    problem: Problem, tolerance: float | None, cells: int | None, steps: int | None
) -> tuple | None:
    """Result of `closed_form`, or None if an imposed resolution requires a march."""
    if problem.velocity > 0.0 and not (cells is None and steps is None):
        return None
    return closed_form(problem, tolerance or 0.0)


def closed_form(problem: Problem, tolerance: float) -> tuple | None:
    """Result of a closed form, or None if no closed form applies.

    Closed forms exist in four cases.  The first is the steady state of a motion that does not
    oscillate, where every point slips along its rigid velocity.  The others are the limit of
    vanishing velocity, motion along one line at nu = 0, and sliding so fast that the width of the
    bounds in bounds.py is within the tolerance.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    tolerance : float
        Absolute tolerance of the friction.

    Returns
    -------
    tuple or None
        Friction mu, torque (None for oscillating motions) and error.
    """
    motion, velocity, amplitude = problem.motion, problem.velocity, problem.size
    if not motion.periodic:
        return _steady_bore(problem) if motion.name == "continuous-bore" else None
    transformed = problem.follows or problem.backward
    if motion.closed_form is not None and problem.poisson == 0.0 and not transformed:
        mu = motion.closed_form(velocity, amplitude, problem.pressure)
        if mu is not None:
            error = WHOLE_ROUNDING if velocity > 0.0 else ROUNDING
            return float(mu), None, error if problem.pressure.hertzian else OF_RECORD
    if velocity == 0.0:
        limit = None if motion.closed_form is not None else STATIC_LIMITS.get(motion.name)
        if limit is None or (problem.poisson > 0.0 and not limit.any_poisson):
            return None
        return _static(problem, limit.function)
    largest_drop = LARGEST_DROPS.get(motion.name)
    if largest_drop is not None and not (motion.rotates and problem.pressure != HERTZ):
        drop = largest_drop(velocity, amplitude)
        if 0.5 * drop + ROUNDING <= tolerance:
            return 1.0 - 0.5 * drop, None, 0.5 * drop + ROUNDING
    return None


def _steady_bore(problem: Problem) -> tuple | None:
    """(mu, torque, error) of a steady bore by Eqs 17 and 18, or Eqs 21 and 22 for a sphere."""
    velocity = problem.velocity
    if problem.pressure == HERTZ:
        forward, torque = paper.bore_forward(velocity), paper.bore_torque(velocity)
        return float(forward), float(torque), ROUNDING
    if not problem.pressure.is_round:
        return None
    from microslip.theory import axisymmetric  # imported here because it loads slowly

    forward, torque = axisymmetric.bore_of(problem.pressure.bound, velocity)
    return float(forward), float(torque), QUADRATURE


def _static(problem: Problem, of_sphere: Callable) -> tuple | None:
    """(mu, None, error) of the static limit, or None without a closed form for the pressure."""
    motion, pressure, amplitude = problem.motion, problem.pressure, problem.size
    if pressure == HERTZ or (pressure.hertzian and not motion.rotates):
        return float(of_sphere(amplitude)), None, ROUNDING
    if not pressure.is_indenter:
        return None
    from microslip.theory import indenters as limits  # imported here because it loads slowly

    if motion.rotates:
        mu = limits.static_bore(
            pressure, float(hertz.bore_angle(amplitude, problem.poisson)), problem.poisson
        )
    else:
        mu = limits.static_transverse(pressure, amplitude)
    return mu, None, OF_RECORD
