"""Every motion by its name, under the pressure asked for.

A scene is one `Scene` record (see motion.py for it and for the names of directions).  A motion is
a file in the folder `motions`, "a_motion.py" for the name "a-motion", and nothing else in the
package has to name it; closed forms that hold for it alone have their place in
adaptive/closed_forms.py.
"""

from __future__ import annotations

import os
from dataclasses import replace
from functools import lru_cache
from importlib import import_module
from pkgutil import iter_modules

import numpy as np

from microslip import motions
from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.motion import Scene
from microslip.pressures.registry import HERTZ, pressure_named

_FIRST = ("transverse", "longitudinal", "zigzag", "bore", "continuous_bore")
"""Files in the order in which they are listed, before all others."""
SCENES = {}
"""Name -> Scene."""
FAMILIES = {}
"""Name -> module with DEFAULTS, numbers and their values if not given, and scene(name, ...)."""


def find(folder: str | os.PathLike) -> None:
    """Make the motions in a folder known: those of the package, or one's own."""
    if str(folder) not in motions.__path__:
        motions.__path__.append(str(folder))
    for file in iter_modules([str(folder)]):
        if not file.name.isidentifier():
            continue  # a copy or a checkpoint of one, which nobody means
        _add(file.name)


def _add(file):
    module = import_module(f"{motions.__name__}.{file}")
    name = file.replace("_", "-")
    if hasattr(module, "SCENE"):
        SCENES[name] = module.SCENE
    elif hasattr(module, "DEFAULTS"):
        FAMILIES[name] = module


for _file in _FIRST:
    _add(_file)
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
    if not isinstance(name, str):
        known = ", ".join([*SCENES, *FAMILIES])
        raise InputError("scene", name, f"allowed is one of {known}")
    return _of_family(name)


@lru_cache(maxsize=64)
def _of_family(name):
    """One record for a name: what is prepared for a motion is found again by it."""
    family, numbers = spec.split(name, "scene", [*SCENES, *FAMILIES])
    module = FAMILIES.get(family)
    defaults = module.DEFAULTS if module else {}
    spec.refuse_unknown(name, "scene", numbers, list(defaults))
    given = {key: value for key, value in sorted(numbers.items()) if value != defaults[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    try:
        return module.scene(f"{family}:{words}" if words else family, **(defaults | numbers))
    except InputError as error:  # about the name as it is kept
        raise InputError("scene", name, error.allowed) from None
