"""Hardness as a pressure, a Vickers number (200 HV) or a Rockwell C number (60 HRC)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.quantities import Quantity, read

KILOGRAM_FORCE_PER_SQUARE_MM = 9.80665e6
"""Unit of the Vickers number, Pa."""
PROJECTED = 0.9272
"""Projected area of a Vickers indent divided by the area of its faces, sin(68 degrees).  The mean
pressure is the Vickers number divided by this ratio."""
ROCKWELL = np.array([20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 68.0])
"""Rockwell C numbers of the table."""
VICKERS = np.array([238.0, 266.0, 302.0, 345.0, 392.0, 446.0, 513.0, 595.0, 697.0, 832.0, 940.0])
"""Vickers numbers of steels with these Rockwell C numbers (ASTM E140, Table 1)."""

VICKERS_OVER_BRINELL = 1.0 / 0.95
"""Vickers number divided by Brinell number, for unalloyed and low-alloy steels from 80 to 650 HV
(ISO 18265, Table A.1)."""
ALLOWED = (
    "allowed are Vickers and Rockwell C, as in '200 HV' and '60 HRC', and pressures, as '7 GPa'"
)

_SCALE = re.compile(r"(.*?)\s*(HV|HRC|HBW?|HBS|HR[ABD-Z]|HK|HS|Shore.*|Mohs)", re.S)
"""Pattern of a hardness with its scale.  Not all of these scales are supported."""


def read_hardness(name: str, value: Any) -> Quantity:
    """Read a hardness as the mean pressure under the indenter, Pa.  Raises InputError.

    name: name of the argument; value: a pressure, or a text such as "200 HV" or "60 HRC".
    """
    match = _SCALE.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None:
        return read(name, value, "Pa")
    text, scale = match.groups()
    brinell = scale.startswith("HB")
    if not brinell and scale not in ("HV", "HRC"):
        raise InputError(name, value, f"the scale {scale} is not supported; {ALLOWED}")
    try:
        number = read(name, text, "").si
    except InputError as error:
        raise InputError(name, value, error.allowed) from None
    if brinell:
        hint = f"this Brinell hardness is about {VICKERS_OVER_BRINELL * number:.0f} HV for steels"
        raise InputError(name, value, f"{hint}; {ALLOWED}")
    if scale == "HRC":
        if not ROCKWELL[0] <= number <= ROCKWELL[-1]:
            ends = f"{ROCKWELL[0]:g} to {ROCKWELL[-1]:g} HRC"
            raise InputError(name, value, f"allowed is {ends}, or a Vickers hardness")
        number = float(np.interp(number, ROCKWELL, VICKERS))
    pressure = number * KILOGRAM_FORCE_PER_SQUARE_MM / PROJECTED
    return Quantity(pressure, f"{' '.join(value.split())} = {pressure / 1e9:.3g} GPa")
