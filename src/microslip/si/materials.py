"""Materials, the sources of their properties, and hardness scales."""

from __future__ import annotations

import csv
import difflib
import math
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import prefixed_text
from microslip.foundation.units import Quantity, read

ROCKWELL = {20: 238, 25: 266, 30: 302, 35: 345, 40: 392, 45: 446, 50: 513, 55: 595, 60: 697}
ROCKWELL |= {65: 832, 68: 940}
"""Vickers numbers of steels, keyed by Rockwell C numbers (ASTM E140, Table 1)."""
VICKERS = 9.80665e6 / 0.9272
"""Mean pressure for a Vickers number of 1, in Pa.  The Vickers number is the force in kgf divided
by the area of the indent's faces in mm^2.  The projected area of the indent is sin(68 degrees)
times the area of the faces."""
BRINELL = 0.95
"""Brinell number divided by Vickers number, for steels from 80 to 650 HV (ISO 18265, Table A.1)."""
SCALES = re.compile(r"(.*?)\s*(HV|HRC|HBW?|HBS|HR[ABD-Z]|HK|HS|Shore.*|Mohs)", re.S)
GRADES = {"100cr6": "bearing-steel", "52100": "bearing-steel", "ti-6al-4v": "titanium"}
"""Material names keyed by aliases in lower case, for hints."""
UNITS = {"young": "Pa", "poisson": "", "density": "kg/m^3", "hardness": "Pa"}
"""SI unit of each property."""
EXAMPLE = "E and nu as in '70 GPa, 0.22', with a point before decimals"


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.  Strings with units are converted to numbers in SI units.

    Attributes
    ----------
    young : float
        Young's modulus, in Pa; infinite for a rigid body.
    poisson : float
        Poisson's ratio, 0 to 0.5, dimensionless.
    density, hardness : float or None
        Density, in kg/m^3, and hardness as the mean pressure under the indenter, in Pa; None if
        unknown.
    source : str
        Source of the properties.

    Raises
    ------
    InputError
        If a value is out of range, uncertain, or not a quantity.
    """

    young: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    source: str = ""

    def __post_init__(self) -> None:
        for name, unit in UNITS.items():
            value = getattr(self, name)
            if value is None or hasattr(value, "shape") and value.shape or value == math.inf:
                continue
            try:
                one = read_hardness(value) if name == "hardness" else read(value, unit)
            except ValueError as error:
                raise InputError(name, value, str(error)) from None
            in_range = one.si > 0.0 if unit else 0.0 <= one.si <= 0.5
            if one.deviation or not in_range:
                limits = f"above 0 {unit}" if unit else "at least 0 and at most 0.5"
                allowed = f"allowed is a finite value {limits}, without an uncertainty"
                raise InputError(name, value, allowed)
            object.__setattr__(self, name, one.si)  # the record is frozen

    @property
    def rigid(self) -> bool:
        return isinstance(self.young, float) and math.isinf(self.young)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus, in Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))

    def __str__(self) -> str:
        if self.rigid:
            return "rigid"
        parts = [f"E = {prefixed_text(self.young, 'Pa', 6)}", f"nu = {self.poisson:g}"]
        parts += [f"hardness {prefixed_text(self.hardness, 'Pa', 6)}"] if self.hardness else []
        parts += [f"density {self.density:.6g} kg/m^3"] if self.density else []
        return ", ".join(parts)


def read_body(argument: str, value: Any) -> tuple[Material, str]:
    """Return a body and its description.  Raises InputError.

    value: a Material, the name of a material, a string "E, nu", or a pair (E, nu).
    """
    if isinstance(value, Material):
        return value, str(value)
    parts = value.split(",") if isinstance(value, str) else value
    if not isinstance(parts, tuple | list):
        raise InputError(argument, value, f"allowed is a text, {EXAMPLE}, a pair or a Material")
    if isinstance(value, str) and len(parts) == 1:
        name = value.strip()
        if name in MATERIALS:
            return MATERIALS[name], name if MATERIALS[name].rigid else f"{name} ({MATERIALS[name]})"
        names = {material.lower(): material for material in MATERIALS} | GRADES
        near = difflib.get_close_matches(name.lower(), names, n=1)
        hint = f" (did you mean {names[near[0]]}?)" if near else ""
        allowed = f"allowed is one of {', '.join(MATERIALS)}{hint}, or {EXAMPLE}"
        raise InputError(argument, value, allowed)
    if len(parts) != 2:
        raise InputError(argument, value, f"{len(parts)} values; allowed: {EXAMPLE}")
    try:
        pair: Any = (part.strip() if isinstance(part, str) else part for part in parts)
        body = Material(*pair)
    except InputError as error:
        title = "Poisson's ratio" if error.argument == "poisson" else "Young's modulus"
        problem = f"its {title} {error.value!r}: {error.allowed}, as in '70 GPa, 0.22'"
        raise InputError(argument, value, problem) from None
    return body, str(body)


def read_hardness(value: object) -> Quantity:
    """Read a hardness, and return it as the mean pressure under the indenter, in Pa.  The value is
    a pressure, or a string such as "200 HV" or "60 HRC".  Raises ValueError."""
    match = SCALES.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None:
        return read(value, "Pa")
    text, scale = match.groups()
    allowed = "allowed are Vickers (200 HV), Rockwell C (60 HRC) and 7 GPa"
    if scale not in ("HV", "HRC") and not scale.startswith("HB"):
        raise ValueError(f"the scale {scale} is not supported; {allowed}")
    number = read(text, "").si
    if scale.startswith("HB"):
        hint = f"this Brinell hardness is about {number / BRINELL:.0f} HV for steels"
        raise ValueError(f"{hint}; {allowed}")
    if scale == "HRC":
        if not 20.0 <= number <= 68.0:
            raise ValueError("allowed is 20 to 68 HRC, or a Vickers hardness")
        from numpy import interp  # late, since NumPy is slow to import

        number = float(interp(number, [*ROCKWELL], [*ROCKWELL.values()]))
    pressure = number * VICKERS
    return Quantity(pressure, f"{' '.join(match[0].split())} = {pressure / 1e9:.3g} GPa")


def _materials() -> dict[str, Material]:
    with Path(__file__).with_name("materials.csv").open(encoding="utf-8", newline="") as file:
        _, *rows = csv.reader(file)
    numbers = {name: [float(x) if x else None for x in cells] for name, *cells, _ in rows}
    return {name: Material(*numbers[name], source) for name, *_, source in rows}  # type: ignore


MATERIALS = _materials() | {"rigid": Material(math.inf, 0.0)}
"""Materials from materials.csv in SI units, keyed by name."""
