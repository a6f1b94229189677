"""Pressures by name."""

from __future__ import annotations

from microslip.foundation.named_files import Family
from microslip.pressures.ellipse import Ellipse
from microslip.pressures.grid_file import create_pressure
from microslip.pressures.hertz import Hertz
from microslip.pressures.power import Power
from microslip.pressures.pressure import Pressure
from microslip.pressures.punch import Punch
from microslip.pressures.ring import Ring

CLASSES = Hertz, Ellipse, Power, Punch, Ring
pressure_named = Family("pressure", Pressure, CLASSES, create_pressure)
"""Function that returns the pressure for a text such as "power:exponent=1", "file:measured.csv" or
"mine/blunt.py"."""
PRESSURES = pressure_named.classes
"""Name -> subclass of Pressure, for the pressures of the package."""
