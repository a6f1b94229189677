"""Pack the data of the form for a real contact: fields, units, materials, rules and messages.

The data come from microslip.predict, so the page has the same checks, warnings and messages.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Any

from microslip.foundation.arguments import LARGEST
from microslip.foundation.number_text import PREFIXES
from microslip.foundation.units import read
from microslip.report.explorer.certified import gauss_rule
from microslip.si import warnings
from microslip.si.contact import LARGEST_RATIO
from microslip.si.inputs import INPUTS, MOTIONS
from microslip.si.materials import MATERIALS, Material
from microslip.theory.hertz import D_half

CHOICES = ("transverse", "bore")
"""Motions of the form."""
OF_NUMBERS = "by E and ν"
"""Choice in the list of materials for entering Young's modulus and Poisson's ratio."""


@dataclass(frozen=True)
class Field:
    """An input field for a quantity.

    Attributes
    ----------
    label : str
        Name on the page and in messages.
    unit : str
        SI unit, as for si.units.read.
    units : tuple of str
        Units offered by the field. The first one is the default.
    example : str
        Default number.
    low_open : bool
        True if values must be larger than `low`, False if they can be equal.
    low : float
        Lower limit.
    high : float or None
        Largest allowed value, or None if there is no upper limit.
    """

    label: str
    unit: str
    units: tuple[str, ...]
    example: str
    low_open: bool = True
    low: float = 0.0
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
    "mu": Field("μ without vibration", "", ("",), "0.3", high=INPUTS["mu"].high),
    "speed": Field("forward speed", "m/s", ("mm/s", "um/s", "m/s", "m/min", "km/h"), "10", False),
    "frequency": Field("frequency", "Hz", ("kHz", "Hz", "MHz", "rpm", "rad/s"), "20"),
    "stroke": Field("amplitude (half stroke)", "m", ("um", "nm", "mm", "m"), "0.3", False),
    "angle": Field("amplitude (half angle)", "rad", ("mrad", "deg", "rad"), "1", False),
}
"""Fields, keyed by their names in the scripts, in the order of the form."""
SIDES = {"material": ("young", "nu"), "counterbody": ("counter_young", "counter_nu")}
"""For each of the two bodies: the fields that can be used instead of a material's name."""
AMPLITUDE_OF = {"transverse": "stroke", "bore": "angle"}
CHOSEN = {"material": "steel", "counterbody": "steel", "motion": "transverse"}
"""Default choices in the form's lists."""


def packed() -> dict:
    """Pack the data of the form as JSON values."""
    return {
        "motions": {motion: f"{motion}: {MOTIONS[motion].description}" for motion in CHOICES},
        "fields": {
            name: asdict(field) | {"units": [_unit(unit, field.unit) for unit in field.units]}
            for name, field in FIELDS.items()
        },
        "sides": {side: list(fields) for side, fields in SIDES.items()},
        "amplitude_of": AMPLITUDE_OF,
        "chosen": CHOSEN,
        "of_numbers": OF_NUMBERS,
        "materials": {name: _material(body) for name, body in MATERIALS.items()},
        "checks": [[rule._asdict() for rule in rules] for rules in warnings.CHECKS],
        "prefixes": PREFIXES,
        "properties": warnings.PROPERTIES,
        "not_given": warnings.MISSING,
        "whose": warnings.SIDES,
        "adhesion": warnings.ADHESION,
        "range": warnings.RANGE,
        "short": warnings.SHORT,
        "rubbery": warnings.RUBBERY,
        "senseless": LARGEST_RATIO,
        "half_stuck": D_half(),
        "rule": gauss_rule(),
        "largest_velocity": LARGEST["velocity"],
        "largest_amplitude": LARGEST["amplitude"],
    }


def _unit(name: str, unit: str) -> dict:
    """Return a unit, its factor to the SI unit, and the exponent if the factor is a power of 10."""
    factor = read(f"1 {name}", unit).si
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
