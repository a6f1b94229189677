"""Registry of motions by name.

The motions of the package are in named.py.  A user's motion is a class in a file of its own: the
class `AMotion` in the file "a_motion.py" has the name "a-motion".  A text such as "file:stroke.csv"
means that the period is read from a data file (see from_file.py).
"""

from __future__ import annotations

from microslip import motions
from microslip.foundation.families import Registry
from microslip.foundation.spec import name_of
from microslip.motions.from_file import read_motion
from microslip.motions.motion import Motion
from microslip.motions.named import NAMED

_REGISTRY = Registry(motions, Motion, "motion", first=(), from_file=read_motion)
_REGISTRY.classes.update({name_of(one): one for one in NAMED})
MOTIONS = _REGISTRY.classes
"""Name -> subclass of Motion."""
BROKEN = _REGISTRY.broken
"""Path and error of each file that cannot be used, by name."""
find = _REGISTRY.find
motion_named = _REGISTRY.parse
"""Function that returns the motion for a text such as "elliptic:forward=0.5,phase=90" or
"file:stroke.csv"."""
