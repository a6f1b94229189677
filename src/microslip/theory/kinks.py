"""Kinks in the friction of a motion: borders for its interpolation.

Across an amplitude that stops all sticking in the limit of slow sliding, and across the velocity
above which nothing sticks at any time, friction goes on, and its slope or its curvature does not.
A border need not be exact: what is left of a kink next to it is seen where friction is sampled.
No stored result depends on this.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation import spec

LOOP = "elliptic"
"""Name of the motions that oscillate along two directions, with numbers that are 1 if not given."""
LOAD = "normal"
"""Name of those whose load, in a share that is 1 if not given, or indentation oscillates."""


class Kinks(NamedTuple):
    """The amplitudes and the velocity at which friction has kinks; all dimensionless.

    Attributes
    ----------
    amplitudes : tuple of float
        Amplitudes of kinks below the velocity of the kink, sharpest at low velocities.
    velocity : tuple of float
        Velocity of the kink: () there is none; (v,) the same at all amplitudes;
        (n0, n1, c0, c1, c2) at (n0 + n1 A + A^2) / (c0 + c1 A + c2 A^2) of the amplitude A.
    """

    amplitudes: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()


KINKS = {
    # The centre of rotation leaves the contact at the velocity 1.
    "bore": Kinks((), (1.0,)),
    # At the amplitude 1 contact is lost.  Below it, above some velocity the load never grows
    # faster than the springs at the growing edge are stretched, and friction is full: the largest
    # A sin t / (1.5 (1 - A cos t)^(1/3)) over t, to 2 % from above.
    "normal": Kinks((1.0,), (0.0, 1.0, 1.5, 1.25, 0.0)),
}
"""By the names of motions, under Hertz's pressure."""
UNDER_ANY = {
    # At the amplitude 1 all of the contact slides sideways.  Above the velocity some of it no
    # longer sticks at the turning points: read off the second differences of friction under Hertz's
    # pressure at the amplitudes 0.2, 0.5, 1, 2 and 3 (0.030, 0.113, 0.30, 0.56, 0.69), where it
    # jumps.  A smooth curve that passes a little above these bends the cells next to it less than
    # one through them; under others it is near enough to save a tenth to a quarter of the points.
    "transverse": Kinks((1.0,), (0.004, 0.12, 1.69, 0.975, 0.965)),
    # Above the velocity A the contact is never pulled back, and friction is full; from the
    # amplitude 1 on all of it slides backward, too.
    "longitudinal": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
    # The same of springs that are pressed deeper; at the amplitude 1 contact is lost.
    "normal:indentation=1": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
}
"""Kinks under any pressure, in the units of that pressure."""


def kinks_of(motion: str, pressure: str = "hertz") -> Kinks:
    """Known kinks of a motion under a pressure, both by the solver's names; most have none."""
    of_hertz = KINKS if pressure == "hertz" else {}
    known = UNDER_ANY | of_hertz
    return known[motion] if motion in known else _of_family(motion)


def _of_family(motion: str) -> Kinks:
    """Kinks of a loop, and of a load that oscillates together with another component.

    Above the velocity that goes with its largest one forward, a loop never goes back.  There is no
    kink there, but what slower velocities feel is over that, however small the amplitude; under a
    load that oscillates it is over the amplitude.  That load is lost from some amplitude on.
    """
    name, _, rest = motion.partition(":")
    if name not in (LOOP, LOAD):
        return Kinks()
    numbers = spec.numbers_in(rest, motion, "motion", f"{name}:forward=0.5") if rest else {}
    if name == LOAD:
        share = numbers.get("indentation", 0.0) or numbers.get("load", 1.0)
        return Kinks((1.0 / share,) if share > 0.0 else (), (0.0, 1.0, 1.0, 1.0, 0.0))
    back = numbers.get("forward", 1.0) * numbers.get("forward_cycles", 1.0)
    return Kinks((), (0.0, 1.0, 1.0 / back, 1.0 / back, 0.0)) if back > 0.0 else Kinks()


def kink_velocity(kinks: Kinks, amplitude: np.ndarray | float) -> np.ndarray:
    """Velocity of the kink at amplitudes >= 0, of their shape, where `kinks.velocity` has one."""
    first, *rest = kinks.velocity
    amplitude = np.asarray(amplitude, float)
    if not rest:
        return np.full_like(amplitude, first)
    n1, c0, c1, c2 = rest
    return (first + n1 * amplitude + amplitude**2) / (c0 + c1 * amplitude + c2 * amplitude**2)
