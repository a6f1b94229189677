"""Friction, torque and dissipated energy in closed form, with error estimates."""

from __future__ import annotations

import math
from collections.abc import Callable

from microslip.answer.answer import Estimate
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem
from microslip.theory import hertz, masing, paper
from microslip.theory.exact import LARGEST_DROPS, STATIC_LIMITS

QUADRATURE = 1e-7
"""Error of the quadrature in Eqs 17 and 18 for pressures other than Hertz.  Such pressures can have
kinks."""
WHOLE_ROUNDING = 1e-9
OF_RECORD = 1e-8
"""Errors of the closed forms that are evaluated by quadrature.  The first value is for a sphere,
where only the motion is integrated numerically.  The second value is for other indenters.  For
these indenters, the pressure is also integrated numerically."""
ROUNDING = 1e-12
"""Error of closed forms that need no quadrature."""
ON_A_SPRING = ("transverse", "bore")
"""Motions for which the bound of fast sliding also applies to a body on a spring.  Over a period,
the spring does the work of the mean force.  A mass does no work, and a dashpot dissipates
energy."""

Exact = dict[str, Estimate]
"""Estimates by name, as in a Result.  The names are `friction` and either `torque` (for steady
motions) or `dissipation`."""


def closed_form(problem: Problem, tolerance: float) -> Exact | None:
    """Return the estimates of a closed form, or None if no closed form applies.

    Closed forms exist in five cases.  At amplitude 0, the friction is 1 for every model.  The
    second case is the steady state of a motion without oscillation.  In the steady state, every
    point slips in the direction of its rigid velocity.  The third case is the limit of vanishing
    velocity.  The fourth case is motion along one line at nu = 0.  The fifth case is fast sliding.
    In fast sliding, the midpoint of the bounds in theory/exact.py is used if the midpoint is
    accurate to within the tolerance.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    tolerance : float
        Absolute tolerance of the friction.
    """
    motion, velocity = problem.motion, problem.velocity
    if problem.amplitude == 0.0:
        work = _work(problem)
        return _exact(1.0, ROUNDING, work, ROUNDING * abs(work))
    if problem.drive is not None:
        return _fast_sliding(problem, tolerance) if motion.name in ON_A_SPRING else None
    if not motion.periodic:
        return _steady_bore(problem) if motion.name == "continuous-bore" else None
    if problem.poisson == 0.0 and not (problem.follows or problem.backward):
        exact = motion.closed_form(velocity, problem.size, problem.pressure)
        if exact is not None:
            error = WHOLE_ROUNDING if velocity > 0.0 else ROUNDING
            error = error if problem.pressure.hertzian else OF_RECORD
            return _exact(exact[0], error, exact[1], error * max(1.0, exact[1]))
    if velocity == 0.0:
        limit = STATIC_LIMITS.get(motion.name)
        if limit is None or (problem.poisson > 0.0 and not limit.any_poisson):
            return None
        return _static(problem, limit.function)
    return _fast_sliding(problem, tolerance)


def _fast_sliding(problem: Problem, tolerance: float) -> Exact | None:
    """Return the midpoint of the bounds for fast sliding.  Returns None if the midpoint is not
    accurate enough.

    Let d be the drift.  The dissipated energy per radian of phase is at least d, and at most
    d (1 + drop / (4 - 2 drop)); see theory/exact.py.  `drop` is the largest value of 1 - mu.
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
    work = _work(problem)
    return _exact(1.0 - 0.5 * drop, error, work * (1.0 + excess), abs(work) * (excess + ROUNDING))


def _steady_bore(problem: Problem) -> Exact | None:
    """Evaluate Eqs 21 and 22 for the steady bore of a sphere, or Eqs 17 and 18 for other
    pressures."""
    velocity, error = problem.velocity, ROUNDING
    if problem.pressure == HERTZ:
        both = paper.bore_forward(velocity), paper.bore_torque(velocity)
    elif problem.pressure.is_round:
        from microslip.theory import indenters  # imported here because it loads slowly

        both, error = indenters.bore_of(problem.pressure.bound, velocity), QUADRATURE
    else:
        return None
    forward, torque = (Estimate(float(value), {"model": error}) for value in both)
    return {"friction": forward, "torque": torque}


def _static(problem: Problem, of_sphere: Callable) -> Exact | None:
    """Return the static limit, or None if there is no closed form for the pressure."""
    motion, pressure, amplitude = problem.motion, problem.pressure, problem.size
    sphere = pressure == HERTZ or (pressure.hertzian and not motion.rotates)
    if not (sphere or pressure.is_indenter):
        return None
    from microslip.theory import indenters as limits  # imported here because it loads slowly

    error = ROUNDING if sphere else OF_RECORD
    if motion.rotates:
        place = float(hertz.bore_angle(amplitude, problem.poisson)), problem.poisson
        mu = of_sphere(amplitude) if sphere else limits.static_bore(pressure, *place)
        energy, energy_error = limits.torsion_energy(pressure, *place), OF_RECORD
    else:
        mu = of_sphere(amplitude) if sphere else limits.static_transverse(pressure, amplitude)
        energy, energy_error = float(masing.loop_energy(amplitude, pressure.loading)), error
    return _exact(float(mu), error, energy, energy_error * max(1.0, energy))


def _exact(mu: float, mu_error: float, energy: float, energy_error: float) -> Exact:
    friction = Estimate(mu, {"model": mu_error})
    return {"friction": friction, "dissipation": Estimate(energy, {"model": energy_error})}


def _work(problem: Problem) -> float:
    """Return the work of full friction along the distance drifted in one period."""
    return 2.0 * math.pi * problem.mean_load * problem.drift
