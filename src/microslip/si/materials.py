"""A few materials by name, with the sources of their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.

    young: Pa, infinite for a rigid one; poisson: 0..0.5; density: kg/m^3; hardness: Pa, the mean
    pressure that it yields under at large; None: not known; source: of the numbers.
    """

    young: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    source: str = "given"

    @property
    def rigid(self):
        return math.isinf(self.young)

    @property
    def shear_modulus(self):
        """G = E/(2 (1 + nu)), Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))


RIGID = Material(math.inf, 0.0, source="by definition")
MATERIALS = {
    "steel": Material(210e9, 0.3, 7850.0, source="EN 1993-1-1, 3.2.6; EN 1991-1-1, Table A.4"),
    "stainless-steel": Material(200e9, 0.3, 7900.0, source="EN 1993-1-4, 2.1.3; EN 10088-1"),
    "aluminium": Material(70e9, 0.3, 2700.0, source="EN 1999-1-1, 3.2.5"),
    "glass": Material(70e9, 0.2, 2500.0, 6e9, source="EN 572-1, Table 1: soda lime; Knoop"),
    "rigid": RIGID,
}


def material_named(name):
    """The Material of this name; raises ValueError, with those there are, if none."""
    if name not in MATERIALS:
        raise ValueError(f"material = {name!r}: allowed is one of {', '.join(MATERIALS)}")
    return MATERIALS[name]
