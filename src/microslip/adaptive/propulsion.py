"""Stall force and no-load velocity of a self-propelled motion.

The sphere moves forward at a prescribed velocity v, like a body too heavy for its velocity to
change during a period.  The contact exerts the force -mu(v) on its own body.  The stall force is
-mu(v -> 0), the load that stops the body.  The no-load velocity is the root of mu(v).  Friction
never decreases with the velocity (theory/bounds.py), so two velocities at which friction has
opposite signs bracket the root.

A body without mass under a constant load is not propelled: it follows the forward oscillation (see
under_force.without_forward_motion).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from microslip.adaptive.checks import checked_problem
from microslip.adaptive.point import solve
from microslip.adaptive.result import Result
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.motions.motion import Motion
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

FACTOR, FASTEST, MOST_STEPS = 4.0, 1e6, 60
"""Search for the root: factor between trial velocities, largest velocity divided by the first one,
and largest number of steps."""


@dataclass(frozen=True, kw_only=True)
class Propulsion:
    """Stall force and no-load velocity of a self-propelled motion.

    Both are negative if the motion propels the body backward, and 0 if it propels nothing.

    Attributes
    ----------
    stall_force, stall_force_error : float
        Load that stops the body, divided by mu times the mean normal load, and its error estimate.
    no_load_velocity, no_load_velocity_error : float
        Velocity without a load, in the unit of the velocity of the motion, and its error estimate.
    converged : bool
        Whether the errors of all forces are within the tolerance.
    reason : str
        Reason why the result is not converged or why the motion propels nothing, otherwise empty.
    """

    stall_force: float
    stall_force_error: float
    no_load_velocity: float
    no_load_velocity_error: float
    converged: bool
    reason: str


class _Failure(Exception):
    """A velocity at which friction was not computed to within the tolerance."""


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
    problem = _checked(checked_problem(motion, None, amplitude, pressure=pressure, poisson=poisson))
    behind = replace(problem, backward=not problem.backward)
    ahead = solve(problem, **settings)
    back = solve(behind, **settings) if ahead.mu_macro >= 0.0 else ahead
    if ahead.mu_macro >= 0.0 and back.mu_macro >= 0.0:
        return _at_rest(ahead, back)
    sign, moving, stall = (1.0, problem, ahead) if back is ahead else (-1.0, behind, back)

    @cache
    def friction(velocity: float) -> tuple[float, float]:
        result = solve(replace(moving, velocity=velocity), **settings)
        if not result.converged:
            raise _Failure(f"velocity = {sign * velocity:g}: {result.reason}")
        return result.mu_macro, result.mu_macro_error

    try:
        velocity, error = _root(friction, problem.mean_speed / problem.unit_drift)
        reason = stall.reason
    except _Failure as failure:
        velocity, error, reason = math.nan, math.inf, str(failure)
    return Propulsion(
        stall_force=-sign * stall.mu_macro,
        stall_force_error=stall.mu_macro_error,
        no_load_velocity=sign * velocity,
        no_load_velocity_error=error,
        converged=not reason,
        reason=reason,
    )


def _checked(problem: Problem) -> Problem:
    """Return a problem at velocity 0 that can propel the contact.  Raises InputError."""
    if problem.velocity != 0.0:
        raise InputError("velocity", problem.velocity, "allowed is 0: propulsion() determines it")
    if not problem.propels:
        allowed = "elliptic:forward_cycles=2,phase=0 or normal:forward=1,phase=90"
        allowed = f"allowed is a self-propelled motion, such as {allowed}"
        raise InputError("motion", problem.motion.name, allowed)
    if not problem.pressure.mirrored:
        allowed = "allowed is one that is its own mirror image"
        raise InputError("pressure", problem.pressure.name, allowed)
    if problem.amplitude == 0.0:
        raise InputError("amplitude", problem.amplitude, "allowed is a number above 0")
    return problem


def _at_rest(ahead: Result, back: Result) -> Propulsion:
    """Build the Propulsion of a body that friction holds at rest in both directions."""
    low = number_text(-back.mu_macro, back.mu_macro_error)
    high = number_text(ahead.mu_macro, ahead.mu_macro_error)
    holds = f"propels nothing: friction holds a body at rest against forces from {low} to {high}"
    # the sign of a static limit within its error of 0 is uncertain
    errors = [one.mu_macro_error - one.mu_macro for one in (ahead, back)]
    reason = ahead.reason or back.reason
    if not reason and max(errors) > 0.0:
        reason = "the sign of the static limit is uncertain: the tolerance is too large"
    return Propulsion(
        stall_force=0.0,
        stall_force_error=max(*errors, 0.0),
        no_load_velocity=0.0,
        no_load_velocity_error=math.inf if reason else 0.0,
        converged=not reason,
        reason=reason or holds,
    )


def _root(friction: Any, first: float) -> tuple[float, float]:
    """Return the velocity at which friction vanishes, and its error estimate.

    The root is found between two velocities at which friction exceeds its error in size, with
    opposite signs.  Secant steps and bisections alternate until friction is 0 within its error.
    Steps away from the root, doubled each time, then lead to the two velocities.

    Parameters
    ----------
    friction : callable
        friction(velocity) -> (value, error) for velocities of at least 0; negative at 0.
    first : float
        First trial velocity, above 0.
    """
    low, high = 0.0, first
    while friction(high)[0] <= 0.0:
        low, high = high, FACTOR * high
        if high > FASTEST * first:
            raise _Failure(f"velocity = {low:g}: the motion propels the body at any velocity")
    bottom, top = low, high
    for step in range(MOST_STEPS):
        slope = (friction(high)[0] - friction(low)[0]) / (high - low)
        middle = low - friction(low)[0] / slope if step % 2 == 0 else 0.5 * (low + high)
        value, error = friction(middle)
        if abs(value) <= error:
            break
        low, high = (middle, high) if value < 0.0 else (low, middle)
    root, step = middle, error / slope
    low, high = max(root - step, bottom), min(root + step, top)
    while low > bottom and friction(low)[0] > -friction(low)[1]:
        low = max(root - 2.0 * (root - low), bottom)
    while high < top and friction(high)[0] < friction(high)[1]:
        high = min(root + 2.0 * (high - root), top)
    return root, max(root - low, high - root)
