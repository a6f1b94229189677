"""Symmetry of an oscillation that follows from the numbers of cycles of its components."""

from __future__ import annotations

import math


def reverses_forward(*, forward: int, lateral: int = 0, angle: int = 0, load: int = 0) -> bool:
    """Whether the oscillation at a later phase equals the original one with its forward component
    reversed.

    Such an oscillation exerts no mean forward force, so it cannot propel the contact.

    Each component is a sine.  The arguments are the number of cycles of each component in a period,
    0 if it does not oscillate.  Let d be the greatest common divisor of the cycles.  After half of
    1/d of the period every component has its previous value, with the opposite sign if its cycles
    are an odd multiple of d.  The forward component must change its sign, and the load must not.
    The signs of lateral and angle do not matter, because solutions under a symmetric pressure have
    two images that are solutions as well: the mirror image that reverses forward and angle, and the
    point reflection q(-forward, -lateral) that reverses the angle (the influence of one point on
    another is an even function of their distance vector).  Together with -q, which reverses all
    components, these images give every combination of signs, and the forward force has the sign of
    the forward motion.
    """
    common = math.gcd(forward, lateral, angle, load)
    return forward // common % 2 == 1 and load // common % 2 == 0
