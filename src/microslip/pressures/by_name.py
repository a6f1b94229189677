"""Registry of pressures by name.

A pressure is a class in a file of the folder `pressures` (see pressure.py).  A text such as
"file:measured.csv" stands for a pressure in a data file (see from_file.py).
"""

from __future__ import annotations

from microslip import pressures
from microslip.foundation.families import Registry
from microslip.pressures.from_file import read_pressure
from microslip.pressures.pressure import Pressure

_REGISTRY = Registry(pressures, Pressure, "pressure", first=("hertz",), from_file=read_pressure)
PRESSURES = _REGISTRY.classes
"""Name -> subclass of Pressure."""
BROKEN = _REGISTRY.broken
"""Name -> path and error, for files that cannot be used."""
find = _REGISTRY.find
pressure_named = _REGISTRY.parse
"""Function that returns the pressure for a text such as "power:exponent=1" or
"file:measured.csv"."""
