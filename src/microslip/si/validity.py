"""Warnings if a real contact violates an assumption of the theory.

Each measure is a named number that describes a contact.  A rule has a limit for a measure, and a
warning for contacts beyond this limit.  The explorer's web page also evaluates these rules.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import MovingContact
from microslip.si.printed_lines import prefixed_text

YIELDS_AT = 0.57
"""Largest Hertz pressure divided by hardness at the onset of plastic flow below the surface.  At
this onset, the pressure is 1.6 times the yield stress.  The hardness is 2.8 times the yield stress
(K. L. Johnson, Contact Mechanics, 6.1 and 6.3)."""
HARDEST = 0.1
"""Largest hardness of metals, ceramics and glasses, divided by Young's modulus.  The hardness is
2.8 times the yield stress.  The yield stress is at most a few per cent of the modulus."""
RUBBERY = 0.45
"""Smallest Poisson's ratio of a rubber.  Rubber does not yield.  It has internal losses, and its
modulus increases with the frequency (K. A. Grosch, Proc. R. Soc. A 274, 1963)."""
ADHESION = 0.05
"""Typical work of adhesion between clean smooth surfaces due to van der Waals forces, N/m (J. N.
Israelachvili, Intermolecular and Surface Forces)."""
RANGE = 0.2e-9
"""Range of van der Waals forces, m.  It is of the order of the distance between atoms."""
SHORT, LONG = 5.0, 0.1
"""Smallest Tabor number for the JKR theory, and largest Tabor number for the DMT theory (K. L.
Johnson and J. A. Greenwood, J. Colloid Interface Sci. 192, 1997)."""
LARGE_MU = 1.0
"""Coefficient of friction above which Coulomb's law is doubtful."""
SMALL = 0.1
"""Ratios up to this value are negligible in the theory."""
STEEP = 0.2
"""Ratio above which half-spaces are a poor approximation: contact radius a divided by the bodies'
smaller radius, or by the radius R of relative curvature.  Hertz's theory assumes a << R1, R2 and a
<< R (K. L. Johnson, Contact Mechanics, 4.2)."""
SENSELESS = 0.5
"""Largest accepted contact radius, divided by the bodies' smaller radius.  At this ratio, the
surface is tilted by 30 degrees at the edge, and a sphere is 7 % deeper than Hertz's parabola."""


RADII = np.geomspace(1e-3, 1e3, 3001)
"""Contact radii, divided by that under the load, among which the contact pulls off.  Neighbours
differ by 0.5 %, which changes the largest force by less than a digit that is printed."""


class Rule(NamedTuple):
    """A condition under which an assumption is violated, and the warning.

    Attributes
    ----------
    where : tuple of tuple
        Conditions (left, factor, right): left > factor * right.  Each side is a number or the name
        of a measure.  The rule applies if all conditions are true.  A condition on a missing
        measure is false.
    text : str
        The sentence, with measures as in {load:.2g} N; see MEASURE.
    """

    where: tuple[tuple, ...]
    text: str


MEASURE = re.compile(r"\{(\w+):\.(\d+)g\}(?: (Pa|N|m)\b)?")
"""Pattern of a measure in a sentence: the name, the number of digits, and the SI unit."""


def _too_hard(side: str) -> Rule:
    return Rule(
        (("largest_pressure", YIELDS_AT * HARDEST, f"{side}_young"),),
        f"the largest pressure, {{largest_pressure:.2g}} Pa, is {{{side}_pressure:.2g}} of Young's "
        "modulus: every metal, ceramic or glass yields under it",
    )


def _steep(radius: str, whose: str) -> Rule:
    return Rule(
        (("contact_radius", STEEP, radius),),
        f"the contact radius is {{over_{radius}:.2g}} of the {whose}: half-spaces are a poor "
        "approximation",
    )


def _adhesive(theory: str, *where: tuple) -> Rule:
    return Rule(
        (("tabor", 1.0, 0.0), ("pull_off", SMALL, "load"), *where),
        "clean smooth surfaces adhere with about {pull_off:.2g} N, {pull_off_share:.2g} of the "
        f"load (Tabor's number {{tabor:.2g}}, Maugis's {{maugis:.2g}}: {theory}): adhesion matters",
    )


def _atomic(measure: str, name: str) -> Rule:
    return Rule(
        ((measure, 1.0, 0.0), (RANGE, 1.0, measure)),
        f"{name} is {{{measure}:.2g}} m, less than the distance between atoms, where the theory of "
        "continua fails",
    )


CHECKS = (
    (
        Rule(
            (("largest_pressure", 1.0, sys.float_info.max),),
            "the pressure is infinite at the tip of the indenter, so the contact yields there "
            "under any load; the mean pressure is {mean_pressure:.2g} Pa",
        ),
        Rule(
            (("largest_pressure", YIELDS_AT, "hardness"),),
            f"the largest pressure, {{largest_pressure:.2g}} Pa, is above {YIELDS_AT:g} of the "
            "hardness, {hardness:.2g} Pa: the contact yields, and is larger than in Hertz's theory",
        ),
    ),
    (_too_hard("first"), _too_hard("second")),
    (
        _steep("smallest_radius", "smaller radius of the bodies"),
        _steep("radius", "radius of relative curvature"),
    ),
    (
        Rule(
            (("stroke", 1.0, SMALL),),
            "the amplitude is {stroke:.2g} times the contact radius: the material carries the "
            "tractions along in a stroke, which the theory neglects",
        ),
    ),
    (
        Rule(
            (("crossing", 1.0, SMALL),),
            "a shear wave travels the contact radius in {crossing:.2g} radians of the oscillation: "
            "inertia is not negligible",
        ),
        Rule(
            (("slip_speed", 1.0, SMALL),),
            "the slip speed is {slip_speed:.2g} times that of shear waves: inertia is not "
            "negligible",
        ),
    ),
    (
        Rule(
            (("mismatch", 1.0, SMALL),),
            "the bodies are elastically dissimilar (Dundurs' beta {mismatch:.2g}): pressure moves "
            "their surfaces sideways, which the theory neglects",
        ),
    ),
    (
        _adhesive("JKR", ("tabor", 1.0, SHORT)),
        _adhesive("DMT", (LONG, 1.0, "tabor")),
        _adhesive("between JKR and DMT"),
        Rule(
            (("pull_off", SMALL, "load"),),
            "clean smooth surfaces adhere with about {pull_off:.2g} N, {pull_off_share:.2g} of the "
            "load: adhesion matters",
        ),
    ),
    (
        Rule(
            (("separated", 1.0, 0.0),),
            "the load falls to 0: the bodies separate in every cycle, for {separated:.2g} of it, "
            "and the mean load is {mean_load:.4g} N",
        ),
    ),
    (_atomic("u_lim", "u_lim"),),
    (_atomic("amplitude", "the amplitude"),),
    (
        Rule(
            (("mu", 1.0, LARGE_MU),),
            f"mu is {{mu:.3g}}: above {LARGE_MU:g} it is rare except for rubber and clean metals "
            "that weld, for which Coulomb's law is a poor approximation",
        ),
    ),
    (
        Rule(
            (("rubbers", 1.0, 0.0),),
            f"a Poisson's ratio of {RUBBERY:g} or more is that of rubber and soft polymers, whose "
            "modulus increases with the frequency: give Young's modulus at this frequency; "
            "internal losses, which add to friction, are neglected",
        ),
    ),
)
"""Groups of rules.  The warnings have the same order as the groups.  In each group, the first rule
that applies gives the warning."""
PROPERTIES = {"hardness": "whether the bodies stay elastic", "density": "inertia"}
"""Checks that need an optional property of a body, keyed by the property's name."""
MISSING = "{what} (the {name} of {whose} is missing)"
UNKNOWN_PULL_OFF = "adhesion (the pull-off force under this pressure is not known)"
SIDES = ("the body", "the counterbody")
"""Names of the two bodies in sentences."""


def broken_assumptions(moving: MovingContact) -> list[str]:
    """The warnings for a contact and its motion."""
    return [*moving.contact.contradictions, *warnings_of(measures(moving))]


def warnings_of(values: Mapping[str, float | None]) -> list[str]:
    """The warnings for measures by name.  Rules about other measures do not apply."""
    first = (next((rule for rule in rules if _applies(rule, values)), None) for rules in CHECKS)
    return [_text(rule.text, values) for rule in first if rule is not None]


def _text(template: str, values: Mapping[str, float | None]) -> str:
    """The sentence of a rule.  A measure with a unit is printed with a prefix."""

    def number(match: re.Match) -> str:
        value, digits, unit = float(values[match[1]] or 0.0), int(match[2]), match[3]
        if unit is None:
            return f"{value:.{digits}g}"
        return prefixed_text(value, unit, digits)

    return MEASURE.sub(number, template)


def _applies(rule: Rule, values: Mapping[str, float | None]) -> bool:
    def value(side: float | str) -> float | None:
        return values.get(side) if isinstance(side, str) else side

    return all(
        value(left) is not None and value(right) is not None and value(left) > factor * value(right)
        for left, factor, right in rule.where
    )


def unchecked(contact: TwoBodies) -> list[str]:
    """Texts for the checks that are skipped because a property is missing."""
    sides, texts = list(zip(SIDES, contact.bodies, strict=True)), []
    for name, what in PROPERTIES.items():
        whose = [side for side, b in sides if getattr(b, name) is None and not b.rigid]
        if whose and not (name == "hardness" and math.isinf(contact.largest_pressure)):
            texts.append(MISSING.format(what=what, name=name, whose=" and ".join(whose)))
    if _of_adhesion(contact)["pull_off"] is None:
        texts.append(UNKNOWN_PULL_OFF)
    return texts


def measures(moving: MovingContact) -> dict[str, float | None]:
    """Measures of a contact by name.  A measure that is unknown or does not apply is None.

    Pressures and the contact radius are evaluated at the largest load in a period.
    """
    contact = moving.contact
    largest = contact.with_load(contact.load + (moving.motion.load_amplitude or 0.0))
    bodies = _of_bodies(largest) | {"load": contact.load}
    return bodies | _of_adhesion(contact) | _of_motion(moving)


def _of_bodies(contact: TwoBodies) -> dict[str, float | None]:
    a, pressure = contact.contact_radius, contact.largest_pressure
    hard = [body.hardness for body in contact.bodies if body.hardness is not None]
    values = {
        "largest_pressure": pressure,
        "mean_pressure": contact.load / (math.pi * a**2),
        "hardness": min(hard, default=None),
        "contact_radius": a,
        "radius": contact.radius,
        "smallest_radius": contact.smallest_radius,
        "over_radius": a / contact.radius,
        "over_smallest_radius": a / contact.smallest_radius,
        "mismatch": abs(contact.mismatch),
        "load": contact.load,
        "u_lim": contact.u_lim,
        "mu": contact.mu,
        "rubbers": sum(b.poisson >= RUBBERY and not b.rigid for b in contact.bodies),
    }
    for side, body in zip(("first", "second"), contact.bodies, strict=True):
        other = body.hardness is not None or body.rigid or body.poisson >= RUBBERY
        other = other or math.isinf(pressure)  # an infinite pressure has its own warning
        values[f"{side}_young"] = None if other else body.young
        values[f"{side}_pressure"] = None if other else pressure / body.young
    return values


def _of_adhesion(contact: TwoBodies) -> dict[str, float | None]:
    """Pull-off force, and Tabor's number of a paraboloid.

    A paraboloid pulls off as a sphere whose radius is the geometric mean of both radii of relative
    curvature.  This is exact in the DMT theory (B. V. Derjaguin, Kolloid-Z. 69, 1934).  In the JKR
    theory it is an upper bound, which slender ellipses do not reach (K. L. Johnson and J. A.
    Greenwood, J. Phys. D 38, 2005).  Another indenter of revolution pulls off with the largest
    sqrt(8 pi E* w c^3) - F(c), where F(c) is the load without adhesion at the contact radius c (D.
    Maugis, Contact, Adhesion and Rupture of Elastic Solids, 4.2).  For a flat punch, this is
    Kendall's force (J. Phys. D 4, 1971).
    """
    radius = contact.curvature_radius
    tabor: float | None = None
    pull: float | None = None
    if radius is not None:
        tabor = (ADHESION**2 * radius / (contact.E_star**2 * RANGE**3)) ** (1.0 / 3.0)
        pull = (1.5 if tabor > SHORT else 2.0) * math.pi * ADHESION * radius
    else:
        sizes = contact.contact_radius * RADII
        load = contact.load_at(sizes)
        if load is not None:
            crack = np.sqrt(8.0 * math.pi * contact.E_star * ADHESION * sizes**3)
            pull = float((crack - load).max())
    return {
        "tabor": tabor,
        "maugis": None if tabor is None else 1.157 * tabor,
        "pull_off": pull,
        "pull_off_share": None if pull is None else pull / contact.load,
    }


def _of_motion(moving: MovingContact) -> dict[str, float | None]:
    """Measures of the motion.  Measures of inertia are None without a density."""
    contact, motion = moving.contact, moving.motion
    along, radius = motion.swing[0], contact.contact_radius
    values: dict[str, float | None]
    values = {"amplitude": along, "stroke": None if motion.steady else along / radius}
    values |= {"mean_load": moving.mean_load, "separated": moving.separated}
    waves = [
        (b.shear_modulus, b.density)
        for b in contact.bodies
        if b.density is not None and not b.rigid
    ]
    if not waves:
        return values | {"crossing": None, "slip_speed": None}
    wave = min(math.sqrt(shear / density) for shear, density in waves)
    return values | {
        "crossing": motion.turn * radius / wave,
        "slip_speed": moving.largest_slip_speed / wave,
    }
