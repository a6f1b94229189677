"""A motion seen in a mirror across the forward direction: what moved forward moves back."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

from microslip.motions.motion import Motion


@lru_cache(maxsize=64)
def mirror_image(motion: Motion) -> Motion:
    """The mirror image of a motion under forward -> -forward, with its velocity.

    At a velocity v its friction is that of the motion at -v with the other sign, provided that the
    pressure is its own image.  Lateral motion stays, a rotation changes its sense.
    """

    def displacement(phase, velocity, amplitude, poisson):
        forward, lateral, angle = motion.displacement(phase, -velocity, amplitude, poisson)
        return -forward, lateral, -angle

    return replace(
        motion,
        displacement=displacement,
        turns=lambda velocity, amplitude: motion.turns(-velocity, amplitude),
        focus=lambda velocity, amplitude, pressure: motion.focus(-velocity, amplitude, pressure),
        closed_form_of=None,
    )


def reverses_forward(*, forward: int, lateral: int = 0, angle: int = 0, load: int = 0) -> bool:
    """Whether the oscillation is its own image with forward reversed, a part of a period later.

    Then the oscillation alone exerts no mean forward force, and cannot propel the contact.

    Each component is a sine; the arguments are its cycles in a period, 0 where it does not
    oscillate.  After half a period of their greatest common divisor every component returns, with
    the opposite sign if its cycles are an odd multiple of that divisor.  Only forward has to change
    its sign, and the load must not: the signs of lateral and angle do not matter.  The tractions
    q(forward, lateral) of a contact with a symmetric pressure have two images which solve the
    problem, too: in the mirror across forward (forward and angle reversed), and q(-forward,
    -lateral) (angle reversed), since the influence of one point on another depends on their
    distance vector but not on its sign.  With -q (all reversed) these give every combination of
    signs, and the forward force has the sign of the forward motion.
    """
    common = math.gcd(forward, lateral, angle, load)
    return forward // common % 2 == 1 and load // common % 2 == 0
