"""Every motion by its name, under the pressure asked for.

A motion is one `Motion` record (see motion.py for it and for the names of directions).  A motion is
a file in the folder `motions`, "a_motion.py" for the name "a-motion", and nothing else in the
package has to name it; closed forms that hold for it alone have their place in
theory/exact.py.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import numpy as np

from microslip import motions
from microslip.foundation.errors import InputError
from microslip.foundation.families import missing_parts, modules_in, record_named
from microslip.motions.motion import Motion
from microslip.pressures.by_name import HERTZ, pressure_named

_FIRST = ("transverse", "longitudinal", "zigzag", "bore", "continuous_bore")
"""Files in the order in which they are listed, before all others."""
MOTIONS = {}
"""Name -> Motion."""
FAMILIES = {}
"""Name -> module with DEFAULTS, numbers and their values if not given, and motion(name, ...)."""


BROKEN = {}
"""File -> its path and why it cannot be used."""


def find(folder: str) -> None:
    """Register the motions in a folder: those of the package, or the user's own.

    A file that cannot be used, or whose name a file in another folder has, is an InputError where a
    motion of its name is requested.
    """
    modules = dict(modules_in(folder, motions, BROKEN))
    for file in dict.fromkeys((*(file for file in _FIRST if file in modules), *modules)):
        name, module = file.replace("_", "-"), modules[file]
        reason = missing_parts(module, "MOTION", Motion, "motion")
        if reason:
            BROKEN[file] = reason
        elif hasattr(module, "MOTION"):
            MOTIONS[name] = module.MOTION
        elif hasattr(module, "DEFAULTS"):
            FAMILIES[name] = module
    for file in BROKEN:
        MOTIONS.pop(file.replace("_", "-"), None)


for _folder in list(motions.__path__):
    find(_folder)


def motion_named(name: str, pressure: str = HERTZ.name) -> Motion:
    """The motion of this name, or of a family for the numbers that follow its name, such as
    "elliptic:forward=0.5,phase=90", under the pressure of this name (see pressures.by_name).
    Raises InputError saying what is allowed."""
    motion, under = _motion_named(name), pressure_named(pressure)
    return motion if under is HERTZ else _under(motion, under)


def read_otherwise(motion: Motion) -> list[Motion]:
    """The motion under each of the other pressures that its own may stand for, see Pressure."""
    return [replace(motion, pressure=other) for other in motion.pressure.readings]


@lru_cache(maxsize=64)
def _under(motion, pressure):
    if pressure.mirrored or not motion.half_period_mirror:
        return replace(motion, pressure=pressure)

    def turns(velocity, amplitude):
        """The second half of the period is no mirror image: it turns as the first one does."""
        first = motion.turns(velocity, amplitude)
        return (*first, *(phase + np.pi for phase in first[1:]))

    return replace(motion, pressure=pressure, half_period_mirror=False, turns=turns)


def _motion_named(name):
    if isinstance(name, str) and name in MOTIONS:
        return MOTIONS[name]
    known = [*MOTIONS, *FAMILIES]
    if not isinstance(name, str):
        raise InputError("motion", name, f"allowed is one of {', '.join(known)}")
    return record_named(name, "motion", FAMILIES, known, make="motion", broken=BROKEN)
