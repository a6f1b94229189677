"""Every pressure by its name.

A pressure is a class in a file of the folder `pressures` (see pressure.py); "file:measured.csv" is
one that a file holds, see from_file.
"""

from __future__ import annotations

from microslip import pressures
from microslip.foundation import named_files
from microslip.foundation.families import Registry
from microslip.pressures import from_file
from microslip.pressures.pressure import Pressure

_REGISTRY = Registry(pressures, Pressure, "pressure", first=("hertz",), others=("file",))
PRESSURES = _REGISTRY.classes
"""Name -> subclass of Pressure."""
BROKEN = _REGISTRY.broken
"""File -> its path and the error in it."""
find = _REGISTRY.find


def pressure_named(text: str) -> Pressure:
    """The pressure of a text such as "power:exponent=1" or "file:measured.csv".

    Raises
    ------
    InputError
        For a text that is no pressure; the message lists the known names.
    """
    if named_files.speaks_of_file(text):
        return from_file.pressure(text)
    return _REGISTRY.parse(text)
