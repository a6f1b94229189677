"""Every motion by its name, under the pressure asked for.

A scene is one `Scene` record (see motion.py for it and for the names of directions).  A motion is
a file in the folder `motions`, "a_motion.py" for the name "a-motion", and nothing else in the
package has to name it; closed forms that hold for it alone have their place in
adaptive/closed_forms.py.
"""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from importlib import import_module

import numpy as np

from microslip import motions
from microslip.foundation.errors import InputError
from microslip.foundation.families import modules_in, record_named
from microslip.motions.motion import Scene
from microslip.pressures.registry import HERTZ, pressure_named

_FIRST = ("transverse", "longitudinal", "zigzag", "bore", "continuous_bore")
"""Files in the order in which they are listed, before all others."""
SCENES = {}
"""Name -> Scene."""
FAMILIES = {}
"""Name -> module with DEFAULTS, numbers and their values if not given, and scene(name, ...)."""


def find(folder: str) -> None:
    """Make the motions in a folder known: those of the package, or one's own."""
    for file, module in modules_in(folder, motions):
        _add(file, module)


def _add(file, module):
    name = file.replace("_", "-")
    if hasattr(module, "SCENE"):
        SCENES[name] = module.SCENE
    elif hasattr(module, "DEFAULTS"):
        FAMILIES[name] = module


for _file in _FIRST:
    _add(_file, import_module(f"{motions.__name__}.{_file}"))
for _folder in list(motions.__path__):
    find(_folder)


def scene_named(name: str, pressure: str = HERTZ.name) -> Scene:
    """The scene of this name, or of a family for the numbers that follow its name, such as
    "elliptic:forward=0.5,phase=90", under the pressure of this name (see pressures.registry).
    Raises InputError saying what is allowed."""
    scene = _motion_named(name)
    return scene if pressure == HERTZ.name else _under(scene, pressure_named(pressure))


def read_otherwise(scene: Scene) -> list[Scene]:
    """The scene under each of the other pressures that its own may stand for, see Pressure."""
    return [replace(scene, pressure=other) for other in scene.pressure.readings]


@lru_cache(maxsize=64)
def _under(scene, pressure):
    if pressure.mirrored or not scene.half_period_mirror:
        return replace(scene, pressure=pressure)

    def turns(velocity, amplitude):
        """The second half of the period is no mirror image: it turns as the first one does."""
        first = scene.turns(velocity, amplitude)
        return (*first, *(phase + np.pi for phase in first[1:]))

    return replace(scene, pressure=pressure, half_period_mirror=False, turns=turns)


def _motion_named(name):
    if isinstance(name, str) and name in SCENES:
        return SCENES[name]
    known = [*SCENES, *FAMILIES]
    if not isinstance(name, str):
        raise InputError("scene", name, f"allowed is one of {', '.join(known)}")
    return record_named(name, "scene", FAMILIES, known, make="scene")
