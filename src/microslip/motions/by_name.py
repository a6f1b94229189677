"""Registry of motions by name.

A motion is a class in a file of the folder `motions`: the class `AMotion` in the file "a_motion.py"
has the name "a-motion" (see motion.py).  Closed forms of motions are in theory/exact.py.  No other
file of the package depends on the name of a motion.
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
"""Name of a file that cannot be used -> path of the file and error."""
find = _REGISTRY.find


def motion_named(text: str) -> Motion:
    """Return the motion for a text such as "elliptic:forward=0.5,phase=90".

    Raises
    ------
    InputError
        If the text does not name a motion.  The message lists the known names.
    """
    return _REGISTRY.parse(text)
