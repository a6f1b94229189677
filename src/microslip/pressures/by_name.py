"""Registry of pressures by name.

A pressure is a class in a file of the folder `pressures` (see pressure.py).  A text such as
"file:measured.csv" stands for a pressure in a data file (see from_file.py).
"""

from __future__ import annotations

from microslip import pressures
from microslip.foundation.families import Registry
from microslip.pressures import from_file
from microslip.pressures.pressure import Pressure

_REGISTRY = Registry(pressures, Pressure, "pressure", first=("hertz",), others=("file",))
PRESSURES = _REGISTRY.classes
"""Name -> subclass of Pressure."""
BROKEN = _REGISTRY.broken
"""Name of a file that cannot be used -> path of the file and error."""
find = _REGISTRY.find


def pressure_named(text: str) -> Pressure:
    """Return the pressure for a text such as "power:exponent=1" or "file:measured.csv".

    Raises
    ------
    InputError
        If the text does not name a pressure.  The message lists the known names.
    """
    if from_file.is_file(text):
        return from_file.pressure(text)
    return _REGISTRY.parse(text)
