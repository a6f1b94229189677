"""Registry of motions by name.

A motion is a class in a file of the folder `motions`: the class `AMotion` in the file "a_motion.py"
has the name "a-motion" (see motion.py).  A text such as "file:stroke.csv" means that the period is
read from a data file (see from_file.py).  Closed forms of motions are in theory/exact.py.  No other
file of the package depends on the name of a motion.
"""

from __future__ import annotations

from microslip import motions
from microslip.foundation.families import Registry
from microslip.motions.from_file import read_motion
from microslip.motions.motion import Motion

_REGISTRY = Registry(
    motions,
    Motion,
    "motion",
    first=("transverse", "longitudinal", "zigzag", "bore", "continuous-bore"),
    from_file=read_motion,
)
MOTIONS = _REGISTRY.classes
"""Name -> subclass of Motion."""
BROKEN = _REGISTRY.broken
"""Path and error of each file that cannot be used, by name."""
find = _REGISTRY.find
motion_named = _REGISTRY.parse
"""Function that returns the motion for a text such as "elliptic:forward=0.5,phase=90" or
"file:stroke.csv"."""
