"""Kinks of friction as a function of velocity and amplitude. Interpolations need a border there.

At two places, friction is continuous, but its slope or curvature is not. One is the amplitude above
which no point sticks during slow sliding. The other is the velocity above which no point ever
sticks. A border need not be exact, because the samples of friction resolve the remaining part of
the kink. Stored results do not depend on this module.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation import spec

LOOP = "elliptic"
"""Name of the motions that oscillate in two directions. A parameter that is not in the name is
1."""
LOAD = "normal"
"""Name of the motions whose normal load or indentation oscillates. A load that is not in the name
is 1."""


class Kinks(NamedTuple):
    """Amplitudes and velocity of the kinks of friction, dimensionless.

    Attributes
    ----------
    amplitudes : tuple of float
        Amplitudes at which friction has a kink if the velocity is below the kink velocity.
    velocity : tuple of float
        Kink velocity: empty if there is none, (v,) if it is v at all amplitudes, and (n0, n1, c0,
        c1, c2) if it is (n0 + n1 A + A^2) / (c0 + c1 A + c2 A^2) at the amplitude A.
    """

    amplitudes: tuple[float, ...] = ()
    velocity: tuple[float, ...] = ()


KINKS = {
    # The centre of rotation leaves the contact at the velocity 1.
    "bore": Kinks((), (1.0,)),
    # Contact is lost at the amplitude 1. At smaller amplitudes, friction is full above a certain
    # velocity, because springs are then stretched faster than their friction bounds grow. This
    # velocity is the maximum over t of A sin t / (1.5 (1 - A cos t)^(1/3)), here up to 2 % larger.
    "normal": Kinks((1.0,), (0.0, 1.0, 1.5, 1.25, 0.0)),
}
"""Name of a motion -> its kinks under Hertz pressure."""
UNDER_ANY = {
    # The whole contact slides sideways at the amplitude 1. Above the kink velocity a part of the
    # contact no longer sticks at the turning points. The curve is fitted to jumps in the second
    # differences of friction under Hertz pressure: 0.030, 0.113, 0.30, 0.56 and 0.69 at the
    # amplitudes 0.2, 0.5, 1, 2 and 3. It passes a little above them, because this deforms the
    # neighbouring cells less. Under other pressures it saves a tenth to a quarter of the points.
    "transverse": Kinks((1.0,), (0.004, 0.12, 1.69, 0.975, 0.965)),
    # Friction is full at velocities above A, because the contact never moves backward. Above the
    # amplitude 1 the whole contact also slides backward.
    "longitudinal": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
    # All springs in contact are pressed in at the same velocity. Contact is lost at
    # the amplitude 1.
    "normal:indentation=1": Kinks((1.0,), (0.0, 1.0, 1.0, 1.0, 0.0)),
}
"""Name of a motion -> its kinks under any pressure, in the units of that pressure."""


def kinks_of(motion: str, pressure: str = "hertz") -> Kinks:
    """Kinks for a motion and a pressure, both given by name. Most motions have no kinks."""
    of_hertz = KINKS if pressure == "hertz" else {}
    kinks = UNDER_ANY | of_hertz
    return kinks[motion] if motion in kinks else _of_family(motion)


def _of_family(motion: str) -> Kinks:
    """Kinks of loops, and of motions that combine an oscillating load with another component.

    The velocity of a loop is the largest velocity of its forward oscillation. At larger velocities,
    the loop never moves backward. Friction has no kink there, but it changes on this scale of
    velocities at all amplitudes. Under an oscillating load, the scale is the amplitude, and contact
    is lost above a certain amplitude.
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
    """Kink velocity at each amplitude >= 0. The result has the shape of `amplitude`.
    `kinks.velocity` must not be empty."""
    first, *rest = kinks.velocity
    amplitude = np.asarray(amplitude, float)
    if not rest:
        return np.full_like(amplitude, first)
    n1, c0, c1, c2 = rest
    return (first + n1 * amplitude + amplitude**2) / (c0 + c1 * amplitude + c2 * amplitude**2)
