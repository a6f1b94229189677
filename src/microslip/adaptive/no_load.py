"""The no-load velocity of a self-propelled motion, where its friction changes sign.

Friction never falls with the velocity, so that every velocity at which its sign is certain bounds
the no-load velocity.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

FACTOR = 4.0
"""From one velocity to the next in search of one at which the contact resists."""
FASTEST = 1e6
MOST_HALVINGS = 60
WIDENING = 1.5
"""Steps away from the no-load velocity over the way in which friction rises by its error."""
MOST_WIDENINGS = 40


class NoLoad(NamedTuple):
    """The no-load velocity.

    Attributes
    ----------
    velocity, error : float
        In the unit of the motion: the error is certain where those of friction are.
    reason : str
        Why there is none, else empty.
    """

    velocity: float
    error: float
    reason: str


def no_load(friction: Callable, first: float) -> NoLoad:
    """The velocity at which friction vanishes, 0 where it is not negative at velocity 0.

    Parameters
    ----------
    friction : callable
        friction(velocity) -> a record with value, error and reason, for velocities of at least 0,
        where 0 stands for the limit.
    first : float
        Velocity above 0 to begin with.
    """
    still = friction(0.0)
    high = first
    while not (resists := friction(high)).value > 0.0:
        high *= FACTOR
        if resists.reason or high > FASTEST:
            return NoLoad(math.nan, math.inf, resists.reason or "drives at any velocity")
    velocity, slope = 0.0, (resists.value - still.value) / high
    if still.value < 0.0:
        velocity, slope, reason = _root(friction, (0.0, still.value), (high, resists.value))
        if reason:
            return NoLoad(math.nan, math.inf, reason)
    below = _certain(friction, velocity, -1.0, slope)
    above = _certain(friction, velocity, 1.0, slope)
    if above is None or below is None:
        return NoLoad(velocity, math.inf, "no velocity is known at which it resists for certain")
    return NoLoad(velocity, max(above - velocity, velocity - below), "")


def _root(
    friction: Callable, low: tuple[float, float], high: tuple[float, float]
) -> tuple[float, float, str]:
    """A velocity at which friction is 0 within its error, the slope there, and why there is none.

    low, high: velocity and friction on both sides.  Chords and halvings take turns.
    """
    for count in range(MOST_HALVINGS):
        width, rise = high[0] - low[0], high[1] - low[1]
        slope = rise / width
        middle = low[0] - low[1] / slope if count % 2 == 0 else 0.5 * (low[0] + high[0])
        found = friction(middle)
        if found.reason:
            return middle, slope, found.reason
        if abs(found.value) <= found.error:
            # by the slope to the side on which more is known of it
            return max(middle - found.value / slope, 0.5 * middle), slope, ""
        if found.value < 0.0:
            low = middle, found.value
        else:
            high = middle, found.value
    return middle, slope, ""


def _certain(friction: Callable, velocity: float, sign: float, slope: float) -> float | None:
    """The velocity next to another at which the sign of friction is certain; 0 below the lowest
    such one, None above the highest."""
    step = WIDENING * friction(velocity).error / slope
    if not math.isfinite(step):
        return 0.0 if sign < 0.0 else None
    for _ in range(MOST_WIDENINGS):
        place = velocity + sign * step
        if place <= 0.0:
            return 0.0
        found = friction(place)
        if sign * found.value > found.error:
            return place
        step *= 2.0
    return 0.0 if sign < 0.0 else None
