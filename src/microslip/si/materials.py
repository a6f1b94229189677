"""A few materials by name, with the sources of their numbers."""

from __future__ import annotations

import difflib
import math
from dataclasses import dataclass

from microslip.foundation.errors import InputError
from microslip.si.quantities import si_value


@dataclass(frozen=True)
class Material:
    """An isotropic elastic body.

    Texts with units and pint quantities are taken, too, and kept as numbers in SI units.

    Attributes
    ----------
    young : float
        Young's modulus, Pa; infinite for a rigid body.
    poisson : float
        Poisson's ratio, 0 to 0.5, dimensionless.
    density : float or None
        kg/m^3; None: not known.
    hardness : float or None
        Mean pressure that it yields under at large, Pa; None: not known.
    source : str
        Where the numbers are from.

    Raises
    ------
    InputError
        For a value that is out of range or no number; it is a ValueError.
    """

    young: float
    poisson: float
    density: float | None = None
    hardness: float | None = None
    source: str = "given"

    def __post_init__(self) -> None:
        if not (isinstance(self.young, float) and self.young == math.inf):
            self._keep("young", si_value("young", self.young, "Pa"))
        self._keep("poisson", si_value("poisson", self.poisson, "", low_open=False, high=0.5))
        for name, unit in (("density", "kg/m^3"), ("hardness", "Pa")):
            if getattr(self, name) is not None:
                self._keep(name, si_value(name, getattr(self, name), unit))
        if not isinstance(self.source, str):
            raise InputError("source", self.source, "allowed is a text")

    def _keep(self, name: str, value: float) -> None:
        object.__setattr__(self, name, value)  # the record is frozen for everybody else

    @property
    def rigid(self) -> bool:
        return math.isinf(self.young)

    @property
    def shear_modulus(self) -> float:
        """G = E/(2 (1 + nu)), Pa."""
        return self.young / (2.0 * (1.0 + self.poisson))


RIGID = Material(math.inf, 0.0, source="by definition")
MATERIALS = {
    "steel": Material(210e9, 0.3, 7850.0, source="EN 1993-1-1, 3.2.6; EN 1991-1-1, Table A.4"),
    "stainless-steel": Material(200e9, 0.3, 7900.0, source="EN 1993-1-4, 2.1.3; EN 10088-1"),
    "aluminium": Material(70e9, 0.3, 2700.0, source="EN 1999-1-1, 3.2.5"),
    "cast-iron": Material(110e9, 0.26, 7200.0, source="EN 1561, Annex A: EN-GJL-250, middle of E"),
    "titanium": Material(
        *(113.8e9, 0.342, 4430.0),
        source="ASM, asm.matweb.com, MTP643: Ti-6Al-4V ELI, annealed",
    ),
    "concrete": Material(33e9, 0.2, 2400.0, source="EN 1992-1-1, Table 3.1: C30/37; EN 1991-1-1"),
    "glass": Material(70e9, 0.2, 2500.0, 6e9, source="EN 572-1, Table 1: soda lime; Knoop"),
    "bearing-steel": Material(
        *(207e9, 0.3, 7810.0, 7.4e9),
        source="W. D. Callister and D. G. Rethwisch, Fundamentals of Materials Science and "
        "Engineering, 3rd ed., Table B.2: E of steels; data sheets of AISI 52100 (100Cr6): nu, "
        "density, 60 HRC (700 HV) at least when hardened",
    ),
    "brass": Material(
        *(101e9, 0.35, 8530.0),
        source="N. E. Dowling, Mechanical Behavior of Materials, Table 5.2: 70Cu-30Zn; Olin "
        "Brass, data sheet of C26000: density",
    ),
    "copper": Material(
        *(130e9, 0.343, 8960.0),
        source="N. E. Dowling, Mechanical Behavior of Materials, Table 5.2; CRC Handbook: density",
    ),
    "gold": Material(*(78e9, 0.44, 19300.0), source="WebElements, gold: physical properties"),
    "PTFE": Material(
        *(0.5e9, 0.46, 2170.0),
        source="W. D. Callister and D. G. Rethwisch, Fundamentals of Materials Science and "
        "Engineering, 3rd ed., Tables B.1, B.2: 0.40 to 0.55 GPa; Kintek, properties of PTFE: nu",
    ),
    "PEEK": Material(
        *(4.0e9, 0.4, 1300.0),
        source="MakeItFrom.com: unfilled; Scientific Reports 14, 2024, s41598-024-79536-3, "
        "Table 1: nu",
    ),
    "CoCrMo": Material(
        *(220e9, 0.29, 8400.0),
        source="MakeItFrom.com: low-carbon Co-28Cr-6Mo (ASTM F1537 alloy 1, ISO 5832-12)",
    ),
    "alumina": Material(
        *(416e9, 0.231, 3984.0, 16.2e9),
        source="R. G. Munro, J. Am. Ceram. Soc. 80, 1919, 1997 (NIST SRD 150): sintered, 99.5 %; "
        "15 GPa Vickers",
    ),
    "zirconia": Material(
        *(210e9, 0.3, 6050.0, 12.7e9),
        source="Open Biomaterials Journal 5, TOBIOMTJ-5-1, Table 1: Y-TZP, 1200 HV; nu assumed",
    ),
    "diamond": Material(
        *(1143e9, 0.0691, 3515.0, 86e9),
        source="C. A. Klein and G. F. Cardinale, Diamond Relat. Mater. 2, 1993: polycrystalline; "
        "PubMed Central, PMC7227005, Table 1: 79.7 GPa Vickers; density of its lattice",
    ),
    "rigid": RIGID,
}
GRADES = {"100cr6": "bearing-steel", "52100": "bearing-steel", "ti-6al-4v": "titanium"}
"""Other names of the materials, in lower case, for hints."""


def material_named(name: object) -> Material:
    """The Material of this name; raises InputError, with all names and a hint, if there is none."""
    if isinstance(name, str) and name in MATERIALS:
        return MATERIALS[name]
    allowed = f"allowed is one of {', '.join(MATERIALS)}"
    names = {known.lower(): known for known in MATERIALS} | GRADES
    near = difflib.get_close_matches(str(name).lower(), names, n=1)
    raise InputError(
        "material", name, allowed + (f" (did you mean {names[near[0]]}?)" if near else "")
    )
