"""Pressures: how the load is spread over the contact, and so what every point can take.

A pressure is one `Pressure` record (see pressure.py for it and for the working units), in a file
of its name, as PRESSURE.  A family gives one for numbers that follow its name: its file holds
DEFAULTS, the numbers and their values if they are not given, and pressure(name, **numbers), which
raises InputError for numbers out of range.  A source gives one for a text of its own that follows
a word and a colon: its file holds SOURCE, the word, and pressure(name).
"""

from __future__ import annotations

import os
from functools import lru_cache
from importlib import import_module
from pkgutil import iter_modules

from microslip import pressures
from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.pressures.hertz import PRESSURE as HERTZ
from microslip.pressures.pressure import Pressure

__all__ = ["FAMILIES", "HERTZ", "PRESSURES", "Pressure", "pressure_named"]

PRESSURES = {HERTZ.name: HERTZ}
"""Name -> Pressure."""
FAMILIES = {}
"""Name -> module with DEFAULTS, numbers and their values if not given, and pressure(name, ...)."""
SOURCES = {}
"""Word -> module with pressure(name), for names that begin with the word and a colon."""


def find(folder: str | os.PathLike) -> None:
    """Make the families in a folder known: those of the package, or one's own."""
    if str(folder) not in pressures.__path__:
        pressures.__path__.append(str(folder))
    for file in iter_modules([str(folder)]):
        if not file.name.isidentifier():
            continue  # a copy or a checkpoint of one, which nobody means
        module = import_module(f"{pressures.__name__}.{file.name}")
        if hasattr(module, "PRESSURE"):
            PRESSURES[file.name] = module.PRESSURE
        elif hasattr(module, "DEFAULTS"):
            FAMILIES[file.name.replace("_", "-")] = module
        elif hasattr(module, "SOURCE"):
            SOURCES[module.SOURCE] = module


for _folder in list(pressures.__path__):
    find(_folder)


def pressure_named(name: str) -> Pressure:
    """The Pressure of this name, of a family for the numbers that follow its name, such as
    "power:exponent=1", or from a source, as in "file:measured.csv".  Raises InputError saying what
    is allowed."""
    if isinstance(name, str) and name in PRESSURES:
        return PRESSURES[name]
    known = [*PRESSURES, *FAMILIES, *SOURCES]
    if not isinstance(name, str):
        raise InputError("pressure", name, f"allowed is one of {', '.join(known)}")
    word, colon, _ = name.partition(":")
    if colon and word in SOURCES:
        return SOURCES[word].pressure(name)
    family, numbers = spec.split(name, "pressure", known)
    module = FAMILIES.get(family)
    spec.refuse_unknown(name, "pressure", numbers, list(module.DEFAULTS if module else ()))
    try:
        return _of_family(family, tuple(sorted(numbers.items())))
    except InputError as error:  # about the name as it is kept
        raise InputError("pressure", name, error.allowed) from None


@lru_cache(maxsize=64)
def _of_family(family, numbers):
    """One record for a name: what is prepared for a pressure is found again by it."""
    module = FAMILIES[family]
    given = {key: value for key, value in numbers if value != module.DEFAULTS[key]}
    words = ",".join(f"{key}={value:.12g}" for key, value in given.items())
    return module.pressure(
        f"{family}:{words}" if words else family, **(module.DEFAULTS | dict(numbers))
    )
