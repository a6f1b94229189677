"""Pressures: how the load is spread over the contact, and so what every point can take.

A pressure is one `Pressure` record (see pressure.py for it and for the working units), in a file
of its name, as PRESSURE.  A family gives one for numbers that follow its name: its file holds
DEFAULTS, the numbers and their values if they are not given, and pressure(name, **numbers), which
raises InputError for numbers out of range.  A source gives one for a text of its own that follows
a word and a colon: its file holds SOURCE, the word, and pressure(name).
"""

from __future__ import annotations

from microslip import pressures
from microslip.foundation.errors import InputError
from microslip.foundation.families import missing_parts, modules_in, record_named
from microslip.pressures.hertz import PRESSURE as HERTZ
from microslip.pressures.pressure import Pressure

__all__ = ["FAMILIES", "HERTZ", "PRESSURES", "Pressure", "pressure_named"]

PRESSURES = {HERTZ.name: HERTZ}
"""Name -> Pressure."""
FAMILIES = {}
"""Name -> module with DEFAULTS, numbers and their values if not given, and pressure(name, ...)."""
SOURCES = {}
"""Word -> module with pressure(name), for names that begin with the word and a colon."""


BROKEN = {}
"""File -> its path and why it cannot be used."""


def find(folder: str) -> None:
    """Register the pressures in a folder: those of the package, or the user's own.

    A file that cannot be used, or whose name a file in another folder has, is an InputError where a
    pressure of its name is requested.
    """
    for file, module in modules_in(folder, pressures, BROKEN):
        reason = missing_parts(module, "PRESSURE", Pressure, "pressure")
        if reason:
            BROKEN[file] = reason
        elif hasattr(module, "PRESSURE"):
            PRESSURES[file] = module.PRESSURE
        elif hasattr(module, "DEFAULTS"):
            FAMILIES[file.replace("_", "-")] = module
        elif hasattr(module, "SOURCE"):
            SOURCES[module.SOURCE] = module
    for file in BROKEN:
        PRESSURES.pop(file, None)


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
    return record_named(name, "pressure", FAMILIES, known, make="pressure", broken=BROKEN)
