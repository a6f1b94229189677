"""Warnings about assumptions of the theory that a real contact breaks, one sentence each.

The measures of a contact are numbers by name.  A rule has the limit of a measure, and the sentence
for a contact beyond it.  The explorer's page evaluates the measures itself with the same rules.
"""

from __future__ import annotations

import math
import sys
from typing import NamedTuple

from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion, largest_slip_speed, mean_load

YIELDS_AT = 0.57
"""Largest Hertz pressure over hardness at which plastic flow sets in below the surface: 1.6 of the
yield stress, with a hardness of 2.8 times that (K. L. Johnson, Contact Mechanics, 6.1 and 6.3)."""
HARDEST = 0.1
"""Hardness over Young's modulus that no metal, ceramic or glass is above: it is 2.8 times the yield
stress, which is a few per cent of the modulus at most."""
RUBBERY = 0.45
"""Poisson's ratio from which on a body is taken for a rubber, which does not yield but loses energy
inside: its modulus rises with the frequency (K. A. Grosch, Proc. R. Soc. A 274, 1963)."""
ADHESION = 0.05
"""Work of adhesion of clean smooth surfaces that only van der Waals forces hold, N/m, of that order
(J. N. Israelachvili, Intermolecular and Surface Forces)."""
RANGE = 0.2e-9
"""Range of van der Waals forces, m, which is of the order of the distance of atoms."""
SHORT, LONG = 5.0, 0.1
"""Tabor's numbers above which JKR's theory holds, and below which DMT's does (K. L. Johnson and
J. A. Greenwood, J. Colloid Interface Sci. 192, 1997)."""
LARGE_MU = 1.0
SMALL = 0.1
"""A ratio that the theory takes to vanish."""
STEEP = 0.2
"""Contact radius over the smaller radius of either body, or over that of relative curvature, beyond
which half-spaces are a poor picture: Hertz's theory is for a << R1, R2 and a << R (K. L. Johnson,
Contact Mechanics, 4.2)."""
SENSELESS = 0.5
"""Contact radius over the smaller radius of either body from which on there is no answer: the
surface is tilted by 30 degrees at the edge, and a sphere is 7 % deeper there than the parabola that
Hertz takes for it."""


class Rule(NamedTuple):
    """When an assumption breaks, and what is said then.

    Attributes
    ----------
    where : tuple of tuple
        Conditions (left, factor, right): left > factor * right, each a number or the name of a
        measure.  All have to hold, and none does of a measure that there is not.
    text : str
        The sentence, with measures in braces as str.format takes them.
    """

    where: tuple[tuple, ...]
    text: str


def _too_hard(side: str) -> Rule:
    return Rule(
        (("largest_pressure", YIELDS_AT * HARDEST, f"{side}_young"),),
        f"the largest pressure, {{largest_pressure:.2g}} Pa, is {{{side}_pressure:.2g}} of Young's "
        "modulus: no metal, ceramic or glass is so hard that it stays elastic",
    )


def _steep(radius: str, whose: str) -> Rule:
    return Rule(
        (("contact_radius", STEEP, radius),),
        f"the contact radius is {{over_{radius}:.2g}} of the {whose}: the bodies are no "
        "half-spaces",
    )


def _adhesive(theory: str, *where: tuple) -> Rule:
    return Rule(
        (("pull_off", SMALL, "load"), *where),
        "clean smooth surfaces adhere with about {pull_off:.2g} N, {pull_off_share:.2g} of the "
        f"load (Tabor's number {{tabor:.2g}}, Maugis's {{maugis:.2g}}: {theory}): adhesion counts",
    )


def _atomic(measure: str, name: str) -> Rule:
    return Rule(
        ((measure, 1.0, 0.0), (RANGE, 1.0, measure)),
        f"{name} is {{{measure}:.2g}} m, less than the distance of atoms: the surfaces are no "
        "continua there",
    )


CHECKS = (
    (
        Rule(
            (("largest_pressure", 1.0, sys.float_info.max),),
            "the pressure is infinite at the tip of the indenter, so that the contact yields there "
            "under any load; the mean pressure is {mean_pressure:.2g} Pa",
        ),
        Rule(
            (("largest_pressure", YIELDS_AT, "hardness"),),
            f"the largest pressure, {{largest_pressure:.2g}} Pa, is above {YIELDS_AT:g} of the "
            "hardness, {hardness:.2g} Pa: the contact yields, and is larger than Hertz's",
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
            "the amplitude is {stroke:.2g} of the contact radius: tractions are carried along by "
            "the material in a stroke, which the theory leaves out",
        ),
    ),
    (
        Rule(
            (("crossing", 1.0, SMALL),),
            "a shear wave crosses the contact in {crossing:.2g} of a radian: inertia counts",
        ),
        Rule(
            (("slip_speed", 1.0, SMALL),),
            "the slip speed is {slip_speed:.2g} of that of shear waves: inertia counts",
        ),
    ),
    (
        Rule(
            (("mismatch", 1.0, SMALL),),
            "the bodies are elastically unlike (Dundurs' beta {mismatch:.2g}): pressure moves "
            "their surfaces sideways, which the theory leaves out",
        ),
    ),
    (
        _adhesive("JKR", ("tabor", 1.0, SHORT)),
        _adhesive("DMT", (LONG, 1.0, "tabor")),
        _adhesive("between JKR and DMT"),
    ),
    (
        Rule(
            (("mean_load", 1.0 + 1e-9, "load"),),
            "the load oscillates to below 0: the bodies part in every cycle, and friction is over "
            "the mean load as it is then, {mean_load:.4g} N",
        ),
    ),
    (_atomic("u_lim", "u_lim"),),
    (_atomic("amplitude", "the amplitude"),),
    (
        Rule(
            (("mu", 1.0, LARGE_MU),),
            f"mu is {{mu:.3g}}: above {LARGE_MU:g} it is rare but for rubber and clean metals that "
            "weld, of which Coulomb's law is a poor picture",
        ),
    ),
    (
        Rule(
            (("rubbers", 1.0, 0.0),),
            f"Poisson's ratio from {RUBBERY:g} on is that of rubber and soft polymers, whose "
            "modulus rises with the frequency and whose losses inside rub too: give Young's "
            "modulus at this frequency; the losses are left out",
        ),
    ),
)
"""Rules in the order in which they are told; of those that stand together the first that holds."""
PROPERTIES = {"hardness": "whether the bodies stay elastic", "density": "inertia"}
"""Optional properties of a body, and the check that needs each of them."""
NOT_GIVEN = "{what} (no {name} given for {whose})"
SIDES = ("the body", "the counterbody")
"""How the two bodies are called in sentences."""


def broken_assumptions(contact: TwoBodies, motion: RealMotion) -> list[str]:
    """List of warnings; contact: bodies.TwoBodies, motion: dimensionless.RealMotion."""
    known = measures(contact, motion)
    found = (next((rule for rule in rules if _holds(rule, known)), None) for rules in CHECKS)
    return [rule.text.format(**known) for rule in found if rule is not None]


def _holds(rule: Rule, known: dict[str, float | None]) -> bool:
    def value(side: float | str) -> float | None:
        return known[side] if isinstance(side, str) else side

    return all(
        value(left) is not None and value(right) is not None and value(left) > factor * value(right)
        for left, factor, right in rule.where
    )


def unchecked(contact: TwoBodies) -> list[str]:
    """Checks that were not possible, each with the missing property and its body: list of texts."""
    sides, found = list(zip(SIDES, contact.bodies, strict=True)), []
    for name, what in PROPERTIES.items():
        whose = [side for side, b in sides if getattr(b, name) is None and not b.rigid]
        if whose and not (name == "hardness" and math.isinf(contact.largest_pressure)):
            found.append(NOT_GIVEN.format(what=what, name=name, whose=" and ".join(whose)))
    return found


def measures(contact: TwoBodies, motion: RealMotion) -> dict[str, float | None]:
    """Measures that the rules check, by name; None: does not apply, or is not known.

    Pressures and the contact radius are those under the largest load of a period.
    """
    largest = contact.with_load(contact.load + (motion.load_amplitude or 0.0))
    bodies = _of_bodies(largest) | {"load": contact.load}
    return bodies | _of_adhesion(contact) | _of_motion(contact, motion)


def _of_bodies(contact: TwoBodies) -> dict[str, float | None]:
    a, pressure = contact.contact_radius, contact.largest_pressure
    hard = [body.hardness for body in contact.bodies if body.hardness is not None]
    found = {
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
        known = body.hardness is not None or body.rigid or body.poisson >= RUBBERY
        known = known or math.isinf(pressure)  # a warning of its own
        found[f"{side}_young"] = None if known else body.young
        found[f"{side}_pressure"] = None if known else pressure / body.young
    return found


def _of_adhesion(contact: TwoBodies) -> dict[str, float | None]:
    strength = ADHESION**2 * contact.radius / (contact.E_star**2 * RANGE**3)
    tabor = strength ** (1.0 / 3.0)
    share = 1.5 if tabor > SHORT else 2.0
    pull = share * math.pi * ADHESION * contact.radius
    return {
        "tabor": tabor,
        "maugis": 1.157 * tabor,
        "pull_off": pull,
        "pull_off_share": pull / contact.load,
    }


def _of_motion(contact: TwoBodies, motion: RealMotion) -> dict[str, float | None]:
    """Measures of the motion against the contact, and wave speeds where a density is known."""
    steady, along = motion.frequency is None, motion.swing[0]
    found: dict[str, float | None]
    found = {"amplitude": along, "stroke": None if steady else along / contact.contact_radius}
    found["mean_load"] = mean_load(motion, contact)
    known = [
        (b.shear_modulus, b.density)
        for b in contact.bodies
        if b.density is not None and not b.rigid
    ]
    if not known:
        return found | {"crossing": None, "slip_speed": None}
    wave = min(math.sqrt(shear / density) for shear, density in known)
    return found | {
        "crossing": motion.turn * contact.contact_radius / wave,
        "slip_speed": largest_slip_speed(motion, contact) / wave,
    }
