"""Warnings about contacts that violate an assumption of the theory.

A measure is a named number that describes a contact.  A rule consists of limits for measures, and
of a warning for contacts that violate these limits.  The explorer's web page evaluates the same
rules.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from microslip.foundation.number_text import prefixed_text
from microslip.scene.indenters import Indenter
from microslip.si.contact import Contact

YIELDS_AT = 0.57
"""Largest Hertz pressure divided by hardness at the onset of plastic flow below the surface.  At
this onset, the pressure is 1.6 times the yield stress.  The hardness is 2.8 times the yield stress
(K. L. Johnson, Contact Mechanics, 6.1 and 6.3)."""
HARDEST = 0.1
"""Largest hardness of metals, ceramics and glasses, divided by Young's modulus.  The hardness is
2.8 times the yield stress.  The yield stress is at most a few per cent of the modulus."""
RUBBERY = 0.45
"""Smallest Poisson's ratio of a rubber.  Rubber does not yield.  Rubber has internal losses, and
the modulus of rubber increases with the frequency (K. A. Grosch, Proc. R. Soc. A 274, 1963)."""
ADHESION = 0.05
"""Typical work of adhesion between clean smooth surfaces due to van der Waals forces, in N/m (J. N.
Israelachvili, Intermolecular and Surface Forces)."""
RANGE = 0.2e-9
"""Range of van der Waals forces, in m.  This range is of the order of the distance between
atoms."""
SHORT, LONG = 5.0, 0.1
"""Smallest Tabor number for the JKR theory, and largest Tabor number for the DMT theory (K. L.
Johnson and J. A. Greenwood, J. Colloid Interface Sci. 192, 1997)."""
SMALL_MU, LARGE_MU = 0.01, 1.0
"""SMALL_MU: coefficient of friction below which friction is called superlubricity (M. Z. Baykara et
al., Appl. Phys. Rev. 5, 2018).  It is rare, and a wrong unit of a force is more likely.  LARGE_MU:
coefficient of friction above which Coulomb's law is doubtful."""
SMALL = 0.1
"""Largest ratio that counts as negligible in the theory."""
STEEP = 0.2
"""Half-spaces are a poor approximation if one of two ratios is above this value.  The first ratio
is the contact radius a divided by the radius of the smaller body.  The second ratio is a divided by
the radius R of relative curvature.  Hertz's theory assumes a << R1, R2 and a << R (K. L. Johnson,
Contact Mechanics, 4.2)."""
AGREES = 0.01
"""Largest relative difference between two sizes or loads that count as equal.  This value allows
for rounding to two or three digits."""
RADII = np.geomspace(1e-3, 1e3, 3001)
"""Contact radii at which the adhesive force is evaluated, divided by the contact radius under the
load.  The largest force is the pull-off force.  Neighbouring radii differ by 0.5 %.  This step
changes the largest force by less than the last printed digit."""


ADHERES = (
    "clean smooth surfaces adhere with about {pull_off:.2g} N, {pull_off_share:.2g} of the load"
)
TABOR = "Tabor's number {tabor:.2g}, Maugis's {maugis:.2g}"
ATOMS = "less than the distance between atoms, where the theory of continua fails"


class Rule(NamedTuple):
    """Conditions under which an assumption is violated, together with the warning for this case.

    Attributes
    ----------
    where : tuple of tuple
        Conditions (left, factor, right): left > factor * right.  Each side is a number or the name
        of a measure.  The rule applies if all conditions are true.  A condition on a missing
        measure is false.
    text : str
        The warning, with measures as in {load:.2g} N; see MEASURE.
    """

    where: tuple[tuple, ...]
    text: str


MEASURE = re.compile(r"\{(\w+):\.(\d+)g\}(?: (Pa|N|m)\b)?")
"""Pattern of a measure in a sentence: the name, the number of digits, and the SI unit."""


def _checks(text: str) -> tuple[tuple[Rule, ...], ...]:
    """Parse groups of rules.

    text: a line "condition; condition: sentence" for each rule, and an empty line between groups.
    A condition has the form "left > right" or "left > k right". Here, left and right are measures
    or numbers.  The number k multiplies the right side.
    """

    def side(word: str) -> float | str:
        return word if word.isidentifier() else float(word)

    def condition(words: str) -> tuple:
        left, _, *factor, right = words.split()
        return side(left), float(factor[0]) if factor else 1.0, side(right)

    groups = []
    for group in text.strip().split("\n\n"):
        rows = (line.partition(": ") for line in group.splitlines())
        groups.append(tuple(Rule(tuple(map(condition, a.split(";"))), b) for a, _, b in rows))
    return tuple(groups)


CHECKS = _checks(f"""
largest_pressure > 1.79e308: the pressure is infinite at the tip of the indenter, so the contact \
yields there under any load; the mean pressure is {{mean_pressure:.2g}} Pa
largest_pressure > {YIELDS_AT} hardness: the largest pressure, {{largest_pressure:.2g}} Pa, is \
above {YIELDS_AT} of the hardness, {{hardness:.2g}} Pa: the contact yields, and is larger than in \
Hertz's theory

soft_pressure > {YIELDS_AT * HARDEST}: the largest pressure, {{largest_pressure:.2g}} Pa, is \
{{soft_pressure:.2g}} of Young's modulus: every metal, ceramic or glass yields under it

over_smallest_radius > {STEEP}: the contact radius is {{over_smallest_radius:.2g}} of the smaller \
radius of the bodies: half-spaces are a poor approximation
over_radius > {STEEP}: the contact radius is {{over_radius:.2g}} of the radius of relative \
curvature: half-spaces are a poor approximation

stroke > {SMALL}: the amplitude is {{stroke:.2g}} times the contact radius: the material carries \
the tractions along in a stroke, which the theory neglects

crossing > {SMALL}: a shear wave travels the contact radius in {{crossing:.2g}} radians of the \
oscillation: inertia is not negligible
slip_speed > {SMALL}: the slip speed is {{slip_speed:.2g}} times that of shear waves: inertia is \
not negligible

mismatch > {SMALL}: the bodies are elastically dissimilar (Dundurs' beta {{mismatch:.2g}}): \
pressure moves their surfaces sideways, which the theory neglects

pull_off > {SMALL} load; tabor > {SHORT}: {ADHERES} ({TABOR}: JKR): adhesion matters
pull_off > {SMALL} load; {LONG} > tabor: {ADHERES} ({TABOR}: DMT): adhesion matters
pull_off > {SMALL} load; tabor > 0: {ADHERES} ({TABOR}: between JKR and DMT): adhesion matters
pull_off > {SMALL} load: {ADHERES}: adhesion matters

separated > 0: the load falls to 0: the bodies separate in every cycle, for {{separated:.2g}} of \
it, and the mean load is {{mean_load:.4g}} N

{RANGE} > u_lim: u_lim is {{u_lim:.2g}} m, {ATOMS}

amplitude > 0; {RANGE} > amplitude: the amplitude is {{amplitude:.2g}} m, {ATOMS}

mu > {LARGE_MU}: mu is {{mu:.3g}}: above 1 it is rare except for rubber and clean metals that \
weld, for which Coulomb's law is a poor approximation
{SMALL_MU} > mu: mu is {{mu:.3g}}: below {SMALL_MU} it is rare (superlubricity): check the units \
of forces

rubbers > 0: a Poisson's ratio of {RUBBERY} or more is that of rubber and soft polymers, whose \
modulus increases with the frequency: give Young's modulus at this frequency; internal losses, \
which add to friction, are neglected
""")
"""Groups of rules.  The warnings are in the order of the groups.  In each group, the first rule
that applies gives the warning."""
PROPERTIES = {"hardness": "whether the bodies stay elastic", "density": "inertia"}
"""Checks that need an optional property of a body, keyed by the name of the property."""
MISSING = "{what} (the {name} of {whose} is missing)"
SIDES = ("the body", "the counterbody")
"""Names of the two bodies in sentences."""


def warnings_of(contact: Contact, speed: float) -> list[str]:
    """Return the warnings for a contact that moves at a given speed (in m/s)."""
    return [*_contradictions(contact), *broken_rules(measures(contact, speed))]


def broken_rules(values: Mapping[str, float | None]) -> list[str]:
    """Return the warnings for the given measures, keyed by name.  A rule applies only if the values
    of its measures are given."""

    def value(side: float | str) -> float | None:
        return values.get(side) if isinstance(side, str) else side

    def applies(rule: Rule) -> bool:
        sides = [(value(left), factor, value(right)) for left, factor, right in rule.where]
        return all(a is not None and b is not None and a > factor * b for a, factor, b in sides)

    def number(match: re.Match) -> str:
        size, digits, unit = float(values[match[1]] or 0.0), int(match[2]), match[3]
        return f"{size:.{digits}g}" if unit is None else prefixed_text(size, unit, digits)

    first = (next(filter(applies, rules), None) for rules in CHECKS)
    return [MEASURE.sub(number, rule.text) for rule in first if rule is not None]


def unchecked(contact: Contact) -> list[str]:
    """Return a message for each check that is skipped because a property is missing."""
    sides, texts = list(zip(SIDES, contact.bodies, strict=True)), []
    for name, what in PROPERTIES.items():
        whose = [side for side, b in sides if getattr(b, name) is None and not b.rigid]
        if whose and not (name == "hardness" and math.isinf(contact.largest_pressure)):
            texts.append(MISSING.format(what=what, name=name, whose=" and ".join(whose)))
    unknown = "adhesion (the pull-off force under this pressure is not known)"
    return texts + [unknown] * (_pull_off(contact)[1] is None)


def measures(contact: Contact, speed: float) -> dict[str, float | None]:
    """Compute the measures of a contact, keyed by name.  A measure that is unknown or does not
    apply is None.

    Pressures and the contact radius are computed at the largest load in a period.
    """
    inputs, kind, most, factor = contact.inputs, contact.kind, contact, 1.0
    if inputs.load_amplitude:
        most = Contact(inputs.at(load=inputs.load + inputs.load_amplitude))
    along = math.hypot(inputs.amplitude or 0.0, inputs.forward_amplitude or 0.0)
    # largest displacement, m, or speed divided by omega, and largest rotation
    reach = pace = (along, inputs.rotation_amplitude or 0.0)
    if kind.unit == "rad":
        reach = pace = (0.0, inputs.amplitude)
    elif kind.stroke is not None:
        factor, reach, pace = inputs.amplitude, kind.stroke.reach, kind.stroke.pace
    elastic = [b for b in contact.bodies if not b.rigid]
    a, pressure, edge = most.contact_radius, most.largest_pressure, contact.contact_radius
    hardness = [b.hardness for b in elastic if b.hardness is not None]
    # an infinite pressure has its own warning
    soft = [b.young for b in elastic if b.hardness is None and b.poisson < RUBBERY]
    waves = [math.sqrt(b.shear_modulus / b.density) for b in elastic if b.density is not None]
    tabor, pull = _pull_off(contact)
    values: dict[str, float | None] = {
        "largest_pressure": pressure,
        "mean_pressure": most.load / (math.pi * a**2),
        "hardness": min(hardness, default=None),
        "soft_pressure": pressure / min(soft) if soft and math.isfinite(pressure) else None,
        "over_radius": a / most.radius,
        "over_smallest_radius": a / most.smallest_radius,
        "mismatch": abs(contact.mismatch),
        "load": contact.load,
        "u_lim": contact.u_lim,
        "mu": contact.mu,
        "rubbers": sum(b.poisson >= RUBBERY for b in elastic),
        "tabor": tabor,
        "maugis": None if tabor is None else 1.157 * tabor,
        "pull_off": pull,
        "pull_off_share": None if pull is None else pull / contact.load,
        "amplitude": factor * reach[0],
        "stroke": None if kind.steady else factor * reach[0] / edge,
        "mean_load": contact.load * contact.mean_load,
        "separated": contact.separated,
    }
    if waves:
        slip = speed + contact.omega * factor * (pace[0] + edge * pace[1])
        slip = math.hypot(speed, contact.omega * edge) if kind.steady else slip
        values |= {"crossing": contact.omega * edge / min(waves), "slip_speed": slip / min(waves)}
    return values


def _pull_off(contact: Contact) -> tuple[float | None, float | None]:
    """Return Tabor's number of a paraboloid, and the pull-off force in N.  Unknown values are None.

    The pull-off force of a paraboloid is computed for an equivalent sphere.  The radius of this
    sphere is the geometric mean of the paraboloid's two radii of relative curvature.  In the DMT
    theory, the pull-off force of this sphere is exact (B. V. Derjaguin, Kolloid-Z. 69, 1934).  In
    the JKR theory, the force of the equivalent sphere is an upper bound, which slender ellipses do
    not reach (K. L. Johnson and J. A. Greenwood, J. Phys. D 38, 2005).  Let F(c) be the load
    without adhesion at the contact radius c.  For any other axisymmetric indenter, the pull-off
    force is the maximum over c of sqrt(8 pi E* w c^3) - F(c) (D. Maugis, Contact, Adhesion and
    Rupture of Elastic Solids, 4.2).  For a flat punch, this is Kendall's force (J. Phys. D 4,
    1971).
    """
    shape, crack = contact.shape, 8.0 * math.pi * contact.E_star * ADHESION
    if shape.hertzian:
        radius = contact.mean_radius
        tabor = (ADHESION**2 * radius / (contact.E_star**2 * RANGE**3)) ** (1.0 / 3.0)
        return tabor, (1.5 if tabor > SHORT else 2.0) * math.pi * ADHESION * radius
    if isinstance(shape, Indenter):
        with np.errstate(over="ignore"):
            load = contact.load * shape.total(shape.depth(RADII))
        return None, float((np.sqrt(crack * (contact.contact_radius * RADII) ** 3) - load).max())
    return None, None


def _contradictions(contact: Contact) -> list[str]:
    """Return a message for each size or load that disagrees with the value in a pressure file.
    Only files with units contain such values.

    A pressure file can be read in several ways.  The readings give a range of values.  A value is
    accepted if it lies within this range, widened by the relative difference `AGREES`.
    """
    texts, readings = [], (contact.shape, *contact.shape.readings) if not contact.radii else ()
    size, load = ("size_m", "m"), ("load_N", "N")
    known = {"contact radius": (contact.contact_radius, *size), "load": (contact.load, *load)}
    for what, (value, name, unit) in known.items():
        sizes = [getattr(one, name, None) or value for one in readings] or [value]
        if not (1.0 - AGREES) * min(sizes) <= value <= (1.0 + AGREES) * max(sizes):
            first, second = (prefixed_text(one, unit) for one in (value, sizes[0]))
            text = f"the {what} is {first}, but {second} in the pressure file: only the shape of "
            texts.append(f"{text}the pressure in the file is used")
    return texts
