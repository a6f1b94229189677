"""Functions that return a motion or a pressure by name."""

from __future__ import annotations

from microslip.foundation.named_files import Family
from microslip.scene.files import create_pressure, create_samples
from microslip.scene.hertz import Ellipse, Hertz, Ring
from microslip.scene.indenters import Power, Punch
from microslip.scene.motion import Motion
from microslip.scene.named import NAMED
from microslip.scene.pressure import Pressure

motion_named = Family("motion", Motion, NAMED, create_samples)
"""Function that returns the motion for a string such as "elliptic:forward=0.5,phase=90",
"file:stroke.csv" or "mine/soft_square.py"."""
MOTIONS = motion_named.classes
"""Mapping from the name of each motion of the package to its class."""


CLASSES = Hertz, Ellipse, Power, Punch, Ring
pressure_named = Family("pressure", Pressure, CLASSES, create_pressure)
"""Function that returns the pressure for a string such as "power:exponent=1", "file:measured.csv"
or "mine/blunt.py"."""
PRESSURES = pressure_named.classes
"""Mapping from the name of each pressure of the package to its class."""
