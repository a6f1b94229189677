"""Data of the page's form for a real contact: fields, units, materials, rules and sentences.

All are those of microslip.predict, so that the page asks, warns and refuses as it does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from microslip.foundation.arguments import LARGEST
from microslip.report.explorer.certified import gauss_rule
from microslip.si import validity
from microslip.si.inputs import LARGEST_MU
from microslip.si.materials import MATERIALS, Material
from microslip.si.motions import MOTIONS
from microslip.si.quantities import read
from microslip.theory.hertz import D_half

CHOICES = ("transverse", "bore")
"""Motions of the form."""
OF_NUMBERS = "by E and ν"
"""Instead of the name of a material."""


@dataclass(frozen=True)
class Field:
    """A quantity that is typed.

    Attributes
    ----------
    label : str
        What it is called on the page and in messages.
    unit : str
        The SI unit, as si.quantities.read takes it.
    units : tuple of str
        Units to choose from; the first one is chosen at first.
    example : str
        The number that stands there at first.
    low_open : bool
        Whether 0 itself is not allowed.
    high : float or None
        The largest value; None: any.
    """

    label: str
    unit: str
    units: tuple[str, ...]
    example: str
    low_open: bool = True
    high: float | None = None


_PRESSURES = ("GPa", "MPa", "kPa", "Pa", "psi")
_RATIO: dict[str, Any] = {"low_open": False, "high": 0.5}
FIELDS = {
    "radius": Field("radius of the sphere", "m", ("mm", "um", "m", "inch"), "5"),
    "load": Field("normal load", "N", ("N", "mN", "uN", "kN", "kgf", "lbf"), "10"),
    "young": Field("E of the sphere", "Pa", _PRESSURES, "210"),
    "nu": Field("ν of the sphere", "", ("",), "0.3", **_RATIO),
    "counter_young": Field("E of the flat", "Pa", _PRESSURES, "210"),
    "counter_nu": Field("ν of the flat", "", ("",), "0.3", **_RATIO),
    "mu": Field("μ without vibration", "", ("",), "0.3", high=LARGEST_MU),
    "speed": Field("forward speed", "m/s", ("mm/s", "um/s", "m/s", "m/min", "km/h"), "10", False),
    "frequency": Field("frequency", "Hz", ("kHz", "Hz", "MHz", "rpm", "rad/s"), "20"),
    "stroke": Field("amplitude (half stroke)", "m", ("um", "nm", "mm", "m"), "0.3", False),
    "angle": Field("amplitude (half angle)", "rad", ("mrad", "deg", "rad"), "1", False),
}
"""By the names that the scripts know them by, in the order of the form."""
SIDES = {"material": ("young", "nu"), "counterbody": ("counter_young", "counter_nu")}
"""Both bodies, and the fields that take the place of a name."""
AMPLITUDE_OF = {"transverse": "stroke", "bore": "angle"}
CHOSEN = {"material": "steel", "counterbody": "steel", "motion": "transverse"}
"""Initial choices of the form besides numbers."""


def packed() -> dict:
    """All that the form needs as one value that JSON can hold."""
    return {
        "motions": {motion: f"{motion}: {MOTIONS[motion]}" for motion in CHOICES},
        "fields": {name: _field(field) for name, field in FIELDS.items()},
        "sides": {side: list(fields) for side, fields in SIDES.items()},
        "amplitude_of": AMPLITUDE_OF,
        "chosen": CHOSEN,
        "of_numbers": OF_NUMBERS,
        "materials": {name: _material(body) for name, body in MATERIALS.items()},
        "checks": [[rule._asdict() for rule in rules] for rules in validity.CHECKS],
        "properties": validity.PROPERTIES,
        "not_given": validity.MISSING,
        "whose": validity.SIDES,
        "adhesion": validity.ADHESION,
        "range": validity.RANGE,
        "short": validity.SHORT,
        "rubbery": validity.RUBBERY,
        "senseless": validity.SENSELESS,
        "half_stuck": D_half(),
        "rule": gauss_rule(),
        "largest_velocity": LARGEST["velocity"],
        "largest_amplitude": LARGEST["amplitude"],
    }


def _field(field: Field) -> dict:
    return {
        "label": field.label,
        "units": [_unit(name, field.unit) for name in field.units],
        "example": field.example,
        "low": 0.0,
        "low_open": field.low_open,
        "high": field.high,
    }


def _unit(name: str, unit: str) -> dict:
    """A unit in that of the SI: a factor, and which power of ten it is; None where it is none."""
    factor = read(name, f"1 {name}", unit).si
    power = round(math.log10(factor))
    exact = float(f"1e{power}") == factor
    return {"name": name, "factor": factor, "power": power if exact else None}


def _material(body: Material) -> dict:
    return {
        "young": None if body.rigid else body.young,
        "poisson": body.poisson,
        "density": body.density,
        "hardness": body.hardness,
    }
