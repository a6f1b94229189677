"""Hardness as it is measured: a pressure, Vickers (200 HV) or Rockwell C (60 HRC)."""

from __future__ import annotations

import re

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.quantities import Given, read

KILOGRAM_FORCE_PER_SQUARE_MM = 9.80665e6
"""Pa."""
PROJECTED = 0.9272
"""Area of a Vickers indent seen from above over that of its faces, sin(68 degrees): the mean
pressure is the Vickers number over it."""
ROCKWELL = np.array([20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 68.0])
VICKERS = np.array([238.0, 266.0, 302.0, 345.0, 392.0, 446.0, 513.0, 595.0, 697.0, 832.0, 940.0])
"""Of the same steels (ASTM E140, Table 1)."""

_SCALE = re.compile(r"(.*?)\s*(HV|HRC)", re.S)


def read_hardness(name: str, value: object) -> Given:
    """Mean pressure under a hardness indent, Pa; raises InputError.

    name: of the argument.  value: a pressure, or a text such as "200 HV" or "60 HRC".
    """
    scale = _SCALE.fullmatch(value.strip()) if isinstance(value, str) else None
    if scale is None:
        return read(name, value, "Pa")
    try:
        number = read(name, scale[1], "").si
    except InputError as error:
        raise InputError(name, value, error.allowed) from None
    if scale[2] == "HRC":
        if not ROCKWELL[0] <= number <= ROCKWELL[-1]:
            ends = f"{ROCKWELL[0]:g} to {ROCKWELL[-1]:g} HRC"
            raise InputError(name, value, f"allowed is {ends}, or a Vickers hardness")
        number = float(np.interp(number, ROCKWELL, VICKERS))
    pressure = number * KILOGRAM_FORCE_PER_SQUARE_MM / PROJECTED
    return Given(pressure, f"{' '.join(value.split())} = {pressure / 1e9:.3g} GPa")
