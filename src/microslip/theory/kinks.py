"""Kinks in the friction of a motion, where its interpolation needs a border.

At two places friction is continuous, but its slope or curvature is not: at the amplitude from which
on nothing sticks in slow sliding, and at the velocity above which nothing sticks at any time. A
border can be inexact, because the samples of friction resolve the rest of the kink. Stored results
do not depend on this module.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation import spec

LOOP = "elliptic"
"""Name of the motions that oscillate along two directions; their numbers are 1 by default."""
LOAD = "normal"
"""Name of the motions whose normal load or indentation oscillates; the load is 1 by default."""


class Kinks(NamedTuple):
    """Amplitudes and velocity of the kinks of friction, dimensionless.

    Attributes
    ----------
    amplitudes : tuple of float
        Amplitudes of kinks that exist below the velocity of the kink.
    velocity : tuple of float
        Velocity of the kink. (): there is no kink; (v,): v at all amplitudes;
        (n0, n1, c0, c1, c2): (n0 + n1 A + A^2) / (c0 + c1 A + c2 A^2) at the amplitude A.
    """

    amplitudes: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()


KINKS = {
    # The centre of rotation leaves the contact at the velocity 1.
    "bore": Kinks((), (1.0,)),
    # Contact is lost at the amplitude 1. At smaller amplitudes friction is full above a velocity,
    # because the load never grows faster than the springs at the growing edge are stretched. The
    # velocity is the maximum over t of A sin t / (1.5 (1 - A cos t)^(1/3)), here up to 2 % larger.
    "normal": Kinks((1.0,), (0.0, 1.0, 1.5, 1.25, 0.0)),
}
"""Kinks by motion under Hertz's pressure."""
UNDER_ANY = {
    # The whole contact slides sideways at the amplitude 1. Above the velocity a part of the contact
    # no longer sticks at the turning points. The curve is fitted to jumps in the second differences
    # of friction under Hertz's pressure: 0.030, 0.113, 0.30, 0.56 and 0.69 at the amplitudes 0.2,
    # 0.5, 1, 2 and 3. It passes a little above them, because this deforms the neighbouring cells
    # less. Under other pressures it saves a tenth to a quarter of the points.
    "transverse": Kinks((1.0,), (0.004, 0.12, 1.69, 0.975, 0.965)),
    # Friction is full at velocities above A, because the contact never moves backward. From the
    # amplitude 1 on the whole contact slides backward, too.
    "longitudinal": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
    # Springs that are pressed deeper have the same velocity. Contact is lost at the amplitude 1.
    "normal:indentation=1": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
}
"""Kinks under any pressure, in the units of that pressure."""


def kinks_of(motion: str, pressure: str = "hertz") -> Kinks:
    """Kinks of a motion under a pressure, both by their names; most motions have none."""
    of_hertz = KINKS if pressure == "hertz" else {}
    kinks = UNDER_ANY | of_hertz
    return kinks[motion] if motion in kinks else _of_family(motion)


def _of_family(motion: str) -> Kinks:
    """Kinks of loops, and of an oscillating load together with another component.

    The velocity of a loop is the largest velocity of its forward oscillation: at larger velocities
    the loop never moves backward. Friction has no kink there, but it changes on this scale of
    velocities at all amplitudes. Under an oscillating load the scale is the amplitude, and contact
    is lost from an amplitude on.
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
    """Velocity of the kink at amplitudes >= 0, of their shape. `kinks.velocity` is not empty."""
    first, *rest = kinks.velocity
    amplitude = np.asarray(amplitude, float)
    if not rest:
        return np.full_like(amplitude, first)
    n1, c0, c1, c2 = rest
    return (first + n1 * amplitude + amplitude**2) / (c0 + c1 * amplitude + c2 * amplitude**2)
