"""Every motion by its name.

A motion is a class in a file of the folder `motions`: `AMotion` in "a_motion.py" has the name
"a-motion" (see motion.py).  No other file of the package has to name it, except for closed forms
that hold for it alone, in theory/exact.py.
"""

from __future__ import annotations

from microslip import motions
from microslip.foundation.families import Registry
from microslip.motions.motion import Motion

_REGISTRY = Registry(
    motions,
    Motion,
    "motion",
    first=("transverse", "longitudinal", "zigzag", "bore", "continuous-bore"),
)
MOTIONS = _REGISTRY.classes
"""Name -> subclass of Motion."""
BROKEN = _REGISTRY.broken
"""File -> its path and the error in it."""
find = _REGISTRY.find


def motion_named(text: str) -> Motion:
    """The motion of a text such as "elliptic:forward=0.5,phase=90".

    Raises
    ------
    InputError
        For a text that is no motion; the message lists the known names.
    """
    return _REGISTRY.parse(text)
