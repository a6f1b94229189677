"""Stall force and no-load velocity of a self-propelled motion.

The sphere moves forward at a prescribed velocity v. A body moves in this way if it is too heavy for
its velocity to change during a period.  The contact exerts the force -mu(v) on the body.  The stall
force is the load that stops the body. The stall force equals -mu in the limit v -> 0.  The no-load
velocity is the root of mu(v).  Friction never decreases with the velocity (theory/exact.py), so two
velocities at which friction has opposite signs bracket the root.

A body without mass under a constant load is not propelled.  Such a body follows the forward
oscillation (see limits.without_forward_motion).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

from microslip.answer import limits
from microslip.answer.answer import Answer, Result
from microslip.answer.point import solve
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.scene.hertz import HERTZ
from microslip.scene.motion import Motion
from microslip.scene.pressure import Pressure
from microslip.scene.problem import Problem

FACTOR, FASTEST = 4.0, 1e6
"""FACTOR: ratio of successive trial velocities in the search for the root.  FASTEST: largest
velocity divided by the first trial velocity."""


class Propulsion(Answer):
    """Stall force and no-load velocity of a self-propelled motion.

    Both values are negative if the motion propels the body backward, and 0 if the motion does not
    propel the body.

    Attributes
    ----------
    stall_force, stall_force_error : float
        Load that stops the body, divided by mu times the mean normal load, and its error estimate.
    no_load_velocity, no_load_velocity_error : float
        Velocity without a load, in the unit of the velocity in `microslip.solve`, and its error
        estimate.
    converged : bool
        Whether the errors of all forces are within the tolerance.
    reason : str
        Reason why the result has not converged, or why the motion does not propel the body;
        otherwise empty.
    """


class _Failure(Exception):
    """Raised if the friction at a velocity was not computed to within the tolerance."""


def propulsion(
    motion: str | Motion | Problem,
    amplitude: float | None = None,
    *,
    pressure: str | Pressure = HERTZ,
    poisson: float = 0.0,
    **settings: Any,
) -> Propulsion:
    """Compute the stall force and the no-load velocity of a self-propelled motion.

    Parameters
    ----------
    motion : str, Motion or Problem
        A motion that can propel the contact, such as "elliptic:forward_cycles=2,phase=0" or
        "normal:forward=1,phase=90".
    amplitude : float
        Amplitude as in `microslip.solve`, above 0.
    pressure, poisson
        See `microslip.solve`.
    **settings
        Further arguments of `microslip.solve` at each velocity, such as `tolerance`, the absolute
        tolerance of every force.

    Returns
    -------
    Propulsion
        Stall force and no-load velocity, with error estimates.

    Raises
    ------
    InputError
        If an argument is out of range, or if no amplitude of the motion can propel the contact.
    """
    problem = limits.problem_of(motion, None, amplitude, pressure=pressure, poisson=poisson)
    example = "elliptic:forward_cycles=2,phase=0 or normal:forward=1,phase=90"
    name, mirror = problem.motion.name, problem.pressure.mirrored
    if problem.velocity != 0.0:
        raise InputError("velocity", problem.velocity, "allowed is 0: propulsion() determines it")
    if not problem.propels:
        raise InputError("motion", name, f"allowed is a self-propelled motion, such as {example}")
    if not mirror:
        raise InputError("pressure", problem.pressure.name, "allowed is a symmetric pressure")
    if not problem.amplitude:
        raise InputError("amplitude", problem.amplitude, "allowed is a number above 0")
    behind = replace(problem, backward=not problem.backward)
    ahead = solve(problem, **settings)
    back = solve(behind, **settings) if ahead.mu_macro >= 0.0 else ahead
    if ahead.mu_macro >= 0.0 and back.mu_macro >= 0.0:
        return _at_rest(ahead, back)
    sign, moving, stall = (1.0, problem, ahead) if back is ahead else (-1.0, behind, back)

    @cache
    def friction(velocity: float) -> Result:
        result = solve(replace(moving, velocity=velocity), **settings)
        if not result.converged:
            raise _Failure(f"velocity = {sign * velocity:g}: {result.reason}")
        return result

    try:
        velocity, error = _root(friction, problem.mean_speed / problem.unit_drift)
        reason = stall.reason
    except _Failure as failure:
        velocity, error, reason = math.nan, math.inf, str(failure)
    values = {"stall_force": -sign * stall.mu_macro, "stall_force_error": stall.mu_macro_error}
    values |= {"no_load_velocity": sign * velocity, "no_load_velocity_error": error}
    return Propulsion(problem, values, reason=reason)


def _at_rest(ahead: Result, back: Result) -> Propulsion:
    """Create the `Propulsion` result for a body that friction holds at rest in both directions."""
    low = number_text(-back.mu_macro, back.mu_macro_error)
    high = number_text(ahead.mu_macro, ahead.mu_macro_error)
    holds = f"propels nothing: friction holds a body at rest against forces from {low} to {high}"
    # the sign of a static limit within its error of 0 is uncertain
    error = max(0.0, *(one.mu_macro_error - one.mu_macro for one in (ahead, back)))
    reason = ahead.reason or back.reason
    if not reason and error > 0.0:
        reason = "the sign of the static limit is uncertain: the tolerance is too large"
    values = {"stall_force": 0.0, "stall_force_error": error, "no_load_velocity": 0.0}
    values |= {"no_load_velocity_error": math.inf if reason else 0.0, "converged": not reason}
    return Propulsion(ahead.problem, values, reason=reason or holds)


def _root(friction: Callable[[float], Result], first: float) -> tuple[float, float]:
    """Find the velocity at which friction vanishes, with its error estimate.

    Brent's method finds a velocity at which the magnitude of the friction is at most the error of
    the friction.  From this velocity, the search takes steps of doubling length in both directions.
    These steps lead to two velocities that bracket the root.  At these two velocities, the friction
    has opposite signs. The magnitude of the friction exceeds its error at both velocities.

    Parameters
    ----------
    friction : callable
        friction(velocity) for velocities of at least 0; negative at 0.
    first : float
        First trial velocity, above 0.
    """
    from scipy.optimize import brentq  # imported here because it loads slowly

    def certain(velocity: float) -> float:  # 0 if within the error
        one = friction(velocity)
        return one.mu_macro if abs(one.mu_macro) > one.mu_macro_error else 0.0

    low, high = 0.0, first
    while certain(high) <= 0.0:
        low, high = (high if certain(high) < 0.0 else low), FACTOR * high
        if high > FASTEST * first:
            raise _Failure(f"velocity = {low:g}: the motion propels the body at any velocity")
    root = brentq(certain, low, high)
    slope = (friction(high).mu_macro - friction(low).mu_macro) / (high - low)
    ends = []
    for sign, end in ((-1.0, low), (1.0, high)):
        step = friction(root).mu_macro_error / slope
        while step < abs(end - root) and sign * certain(root + sign * step) <= 0.0:
            step *= 2.0
        ends.append(min(step, abs(end - root)))
    return root, max(ends)
