"""Estimates in closed form, which need no run."""

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
"""Errors of closed forms with a quadrature.  For a sphere, the quadrature is over the motion only;
for another indenter, it is also over the pressure."""
ROUNDING = 1e-12
"""Error of closed forms that need no quadrature."""
ON_A_SPRING = ("transverse", "bore")
"""Motions for which the bound of fast sliding also applies to a body on a spring.  Over a period,
the spring does the work of the mean force, a mass does no work, and a dashpot dissipates energy."""

Exact = dict[str, Estimate]
"""Estimates of a Result by name: friction, and torque (of steady motions) or dissipation."""


def no_vibration(problem: Problem) -> Exact | None:
    """Closed form for any model if the amplitude is 0, otherwise None."""
    still = problem.motion.periodic and problem.amplitude == 0.0
    return _of_drag(problem, _within(1.0, ROUNDING), _within(1.0, ROUNDING)) if still else None


def closed_form(problem: Problem, tolerance: float) -> Exact | None:
    """Estimates of a closed form, or None if no closed form applies.

    Closed forms exist in four cases.  The first is the steady state of a motion without
    oscillation, where every point slips in the direction of its rigid velocity.  The second is the
    limit of vanishing velocity, and the third is motion along one line at nu = 0.  The fourth is
    fast sliding, if the bounds in theory/exact.py differ by less than the tolerance.

    Parameters
    ----------
    problem : problem.Problem
        The problem, already checked.
    tolerance : float
        Absolute tolerance of the friction.
    """
    motion, velocity = problem.motion, problem.velocity
    if problem.drive is not None:
        return _fast_sliding(problem, tolerance) if motion.name in ON_A_SPRING else None
    if not motion.periodic:
        return _steady_bore(problem) if motion.name == "continuous-bore" else None
    if problem.poisson == 0.0 and not (problem.follows or problem.backward):
        exact = motion.closed_form(velocity, problem.size, problem.pressure)
        if exact is not None:
            error = WHOLE_ROUNDING if velocity > 0.0 else ROUNDING
            return _exact(*exact, error if problem.pressure.hertzian else OF_RECORD)
    if velocity == 0.0:
        limit = STATIC_LIMITS.get(motion.name)
        if limit is None or (problem.poisson > 0.0 and not limit.any_poisson):
            return None
        return _static(problem, limit.function)
    return _fast_sliding(problem, tolerance)


def _fast_sliding(problem: Problem, tolerance: float) -> Exact | None:
    """Midpoint of the bounds for fast sliding, or None if they differ by more than the tolerance.

    Per radian, the dissipated energy is between the drift d and d (1 + drop / (4 - 2 drop)), see
    theory/exact.py.  `drop` is the largest value of 1 - mu.
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
    velocity, error = problem.velocity, ROUNDING
    if problem.pressure == HERTZ:
        both = paper.bore_forward(velocity), paper.bore_torque(velocity)
    elif problem.pressure.is_round:
        from microslip.theory import indenters  # imported here because it loads slowly

        both, error = indenters.bore_of(problem.pressure.bound, velocity), QUADRATURE
    else:
        return None
    return {
        name: _within(float(value), error)
        for name, value in zip(("friction", "torque"), both, strict=True)
    }


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
    return _exact(float(mu), energy, OF_RECORD) | {"friction": _within(float(mu), error)}


def _within(value: float, error: float) -> Estimate:
    """Estimate of a value in closed form."""
    return Estimate(value, {"model": error})


def _exact(mu: float, energy: float, error: float) -> Exact:
    """Friction and energy; the error is absolute for the friction, and relative for an energy above
    1."""
    return {
        "friction": _within(mu, error),
        "dissipation": _within(energy, error * max(1.0, energy)),
    }


def _of_drag(problem: Problem, friction: Estimate, drag: Estimate) -> Exact:
    """Closed form in which the dissipated energy is the work of the mean force `drag`."""
    work = 2.0 * math.pi * problem.mean_load * problem.drift
    return {"friction": friction, "dissipation": work * drag}
