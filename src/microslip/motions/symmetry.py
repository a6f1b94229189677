"""Symmetries of an oscillation that follow from its cycles in a period."""

from __future__ import annotations

import math


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
