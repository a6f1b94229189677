"""Materials by name, with the sources of their properties."""

from __future__ import annotations

import csv
import difflib
import math
from dataclasses import dataclass
from pathlib import Path

from microslip.foundation.errors import InputError
from microslip.si.quantities import read


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.

    Texts with units, and pint quantities, are converted to numbers in SI units.

    Attributes
    ----------
    young : float
        Young's modulus, Pa; infinite for a rigid body.
    poisson : float
        Poisson's ratio, 0 to 0.5, dimensionless.
    density : float or None
        Density, kg/m^3; None if unknown.
    hardness : float or None
        Mean pressure under a hardness indenter, Pa; None if unknown.
    source : str
        Source of the numbers.

    Raises
    ------
    InputError
        If a value is out of range or not a number.
    """

    young: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    source: str = "given"

    def __post_init__(self) -> None:
        if not (isinstance(self.young, float) and self.young == math.inf):
            self._keep("young", read("young", self.young, "Pa").si)
        self._keep("poisson", read("poisson", self.poisson, "", low_open=False, high=0.5).si)
        for name, unit in (("density", "kg/m^3"), ("hardness", "Pa")):
            if getattr(self, name) is not None:
                self._keep(name, read(name, getattr(self, name), unit).si)
        if not isinstance(self.source, str):
            raise InputError("source", self.source, "allowed is a text")

    def _keep(self, name: str, value: float) -> None:
        object.__setattr__(self, name, value)  # the record is frozen

    @property
    def rigid(self) -> bool:
        return math.isinf(self.young)

    @property
    def shear_modulus(self) -> float:
        """Shear modulus G = E/(2 (1 + nu)), Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))


RIGID = Material(math.inf, 0.0, source="by definition")
TABLE = Path(__file__).with_name("materials.csv")
"""Table of the materials, in SI units.  An empty cell means that the property is unknown."""


def _materials() -> dict[str, Material]:
    with TABLE.open(encoding="utf-8", newline="") as file:
        _, *rows = csv.reader(file)
    materials = {}
    for name, young, poisson, *others, source in rows:
        density, hardness = (float(cell) if cell else None for cell in others)
        materials[name] = Material(float(young), float(poisson), density, hardness, source)
    return materials


MATERIALS = _materials() | {"rigid": RIGID}
GRADES = {"100cr6": "bearing-steel", "52100": "bearing-steel", "ti-6al-4v": "titanium"}
"""Material names keyed by aliases in lower case, for hints."""


def material_named(name: object) -> Material:
    """The Material called `name`.  Raises InputError, with a hint, if the name is unknown."""
    if isinstance(name, str) and name in MATERIALS:
        return MATERIALS[name]
    allowed = f"allowed is one of {', '.join(MATERIALS)}"
    names = {material.lower(): material for material in MATERIALS} | GRADES
    for near in difflib.get_close_matches(str(name).lower(), names, n=1):
        allowed += f" (did you mean {names[near]}?)"
    raise InputError("material", name, allowed)
