"""Symmetry of an oscillation, derived from the number of cycles of each component."""

from __future__ import annotations

import math


def reverses_forward(*, forward: int, lateral: int = 0, angle: int = 0, load: int = 0) -> bool:
    """Whether the oscillation at a later phase equals the original one with its forward component
    reversed.

    Such an oscillation exerts no mean forward force, so it cannot propel the contact.

    Each component is a sine.  Each argument is the number of cycles of one component in a period; 0
    if the component does not oscillate.  Let d be the greatest common divisor of these numbers.
    After a fraction 1/(2 d) of the period, every component has the same value as before, or minus
    this value if its number of cycles is an odd multiple of d.  The forward component must change
    its sign, and the load must not.  The signs of lateral and angle do not matter: under a
    symmetric pressure, two images of a solution are also solutions.  The mirror image reverses
    forward and angle.  The point reflection q(-forward, -lateral) reverses the angle.  It is a
    solution because the influence of one point on another is an even function of the vector between
    them.  Together with -q, which reverses all components, these images give every combination of
    signs.  In all images, the forward force has the sign of the forward motion.
    """
    common = math.gcd(forward, lateral, angle, load)
    return forward // common % 2 == 1 and load // common % 2 == 0
