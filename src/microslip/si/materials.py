"""Materials by name, with the sources of their properties, and hardness scales."""

from __future__ import annotations

import csv
import difflib
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.foundation.units import Quantity, read

ROCKWELL = (
    (20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0, 65.0, 68.0),
    (238.0, 266.0, 302.0, 345.0, 392.0, 446.0, 513.0, 595.0, 697.0, 832.0, 940.0),
)
"""Rockwell C numbers, and the Vickers numbers of steels (ASTM E140, Table 1)."""
VICKERS = 9.80665e6 / 0.9272
"""Mean pressure of a Vickers number of 1, Pa: 1 kgf/mm^2 on the faces of the indent.  Its projected
area is sin(68 degrees) times that of the faces."""
BRINELL = 0.95
"""Brinell number divided by Vickers number, for steels from 80 to 650 HV (ISO 18265, Table A.1)."""
SCALES = re.compile(r"(.*?)\s*(HV|HRC|HBW?|HBS|HR[ABD-Z]|HK|HS|Shore.*|Mohs)", re.S)
GRADES = {"100cr6": "bearing-steel", "52100": "bearing-steel", "ti-6al-4v": "titanium"}
"""Material names keyed by aliases in lower case, for hints."""


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.  Texts with units are converted to numbers in SI units.

    Attributes
    ----------
    young : float
        Young's modulus, Pa; infinite for a rigid body.
    poisson : float
        Poisson's ratio, 0 to 0.5, dimensionless.
    density, hardness : float or None
        Density, kg/m^3, and mean pressure under a hardness indenter, Pa; None if unknown.
    source : str
        Source of the numbers.

    Raises
    ------
    InputError
        If a value is out of range or not a quantity.
    """

    young: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        ranges = {"young": ("Pa", math.inf), "poisson": ("", 0.5), "density": ("kg/m^3", math.inf)}
        for name, (unit, high) in (ranges | {"hardness": ("Pa", math.inf)}).items():
            value = getattr(self, name)
            if value is None or isinstance(value, np.ndarray) or value == math.inf:
                continue
            try:
                number = read(value, unit).si
            except ValueError as error:
                raise InputError(name, value, str(error)) from None
            if not (0.0 < number <= high or name == "poisson" and number == 0.0):
                limits = "at least 0 and at most 0.5" if name == "poisson" else "above 0"
                raise InputError(name, value, f"allowed is a finite value {limits} {unit}".strip())
            object.__setattr__(self, name, number)  # the record is frozen
        if not isinstance(self.source, str):
            raise InputError("source", self.source, "allowed is a text")

    @property
    def rigid(self) -> bool:
        return isinstance(self.young, float) and math.isinf(self.young)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus, Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))

    def __str__(self) -> str:
        if self.rigid:
            return "rigid"
        parts = [f"E = {self.young / 1e9:.6g} GPa", f"nu = {self.poisson:g}"]
        parts += [f"hardness {self.hardness / 1e9:.6g} GPa"] if self.hardness is not None else []
        parts += [f"density {self.density:.6g} kg/m^3"] if self.density is not None else []
        return ", ".join(parts)


def _materials() -> dict[str, Material]:
    with Path(__file__).with_name("materials.csv").open(encoding="utf-8", newline="") as file:
        _, *rows = csv.reader(file)
    table: dict[str, Any] = {
        name: [*(float(x) if x else None for x in cells), source] for name, *cells, source in rows
    }
    return {name: Material(*values) for name, values in table.items()}


RIGID = Material(math.inf, 0.0)
MATERIALS = _materials() | {"rigid": RIGID}
"""Materials by name, from materials.csv in SI units."""


def material_named(name: object) -> Material:
    """The Material called `name`.  Raises InputError, with a hint, if the name is unknown."""
    if isinstance(name, str) and name in MATERIALS:
        return MATERIALS[name]
    names = {material.lower(): material for material in MATERIALS} | GRADES
    near = difflib.get_close_matches(str(name).lower(), names, n=1)
    hint = f" (did you mean {names[near[0]]}?)" if near else ""
    raise InputError("material", name, f"allowed is one of {', '.join(MATERIALS)}{hint}")


def read_hardness(value: object) -> Quantity:
    """Read a hardness as the mean pressure under the indenter, Pa: a pressure, or a text such as
    "200 HV" or "60 HRC".  Raises ValueError."""
    match = SCALES.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None:
        return read(value, "Pa")
    (text, scale), allowed = (
        match.groups(),
        "allowed are Vickers (200 HV), Rockwell C (60 HRC) and 7 GPa",
    )
    if scale not in ("HV", "HRC") and not scale.startswith("HB"):
        raise ValueError(f"the scale {scale} is not supported; {allowed}")
    number = read(text, "").si
    if scale.startswith("HB"):
        hint = f"this Brinell hardness is about {number / BRINELL:.0f} HV for steels"
        raise ValueError(f"{hint}; {allowed}")
    if scale == "HRC":
        if not ROCKWELL[0][0] <= number <= ROCKWELL[0][-1]:
            raise ValueError("allowed is 20 to 68 HRC, or a Vickers hardness")
        number = float(np.interp(number, *ROCKWELL))
    pressure = number * VICKERS
    return Quantity(pressure, f"{' '.join(match[0].split())} = {pressure / 1e9:.3g} GPa")
