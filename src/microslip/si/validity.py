"""Where an assumption of the theory breaks at a real contact: one sentence each."""

from __future__ import annotations

import math

from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion, largest_slip_speed

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
"""Of these forces, m; and the distance of atoms, of that order."""
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


def broken_assumptions(contact: TwoBodies, motion: RealMotion) -> list[str]:
    """List of warnings; contact: bodies.TwoBodies, motion: dimensionless.RealMotion."""
    return [text for check in _CHECKS for text in check(contact, motion)]


def unchecked(contact: TwoBodies) -> list[str]:
    """What could not be checked, for want of which property: list of texts."""
    missing = []
    for name, what in (("hardness", "whether the bodies stay elastic"), ("density", "inertia")):
        if any(getattr(b, name) is None and not b.rigid for b in contact.bodies):
            missing.append(f"{what} (no {name} given)")
    return missing


def _plastic(contact, motion):
    known = [b.hardness for b in contact.bodies if b.hardness is not None]
    pressure = contact.largest_pressure
    if known and pressure > YIELDS_AT * min(known):
        yield (
            f"the largest pressure, {pressure:.2g} Pa, is above {YIELDS_AT:g} of the hardness, "
            f"{min(known):.2g} Pa: the contact yields, and is larger than Hertz's"
        )


def _too_hard(contact, motion):
    """Of bodies without a hardness: whether any one would do."""
    pressure = contact.largest_pressure
    for body in contact.bodies:
        known = body.hardness is not None or body.rigid or body.poisson >= RUBBERY
        if not known and pressure > YIELDS_AT * HARDEST * body.young:
            share = pressure / body.young
            yield (
                f"the largest pressure, {pressure:.2g} Pa, is {share:.2g} of Young's modulus: "
                "no metal, ceramic or glass is so hard that it stays elastic"
            )
            return


def _lossy(contact, motion):
    if any(body.poisson >= RUBBERY and not body.rigid for body in contact.bodies):
        yield (
            f"Poisson's ratio from {RUBBERY:g} on is that of rubber, whose modulus rises with the "
            "frequency and whose losses inside rub too: give Young's modulus at this frequency; "
            "the losses are left out"
        )


def _adhesive(contact, motion):
    strength = ADHESION**2 * contact.radius / (contact.E_star**2 * RANGE**3)
    tabor = strength ** (1.0 / 3.0)
    share = 1.5 if tabor > SHORT else 2.0
    pull = share * math.pi * ADHESION * contact.radius
    if pull <= SMALL * contact.load:
        return
    theory = "JKR" if tabor > SHORT else "DMT" if tabor < LONG else "between JKR and DMT"
    share = pull / contact.load
    yield (
        f"clean smooth surfaces adhere with about {pull:.2g} N, {share:.2g} of the load "
        f"(Tabor's number {tabor:.2g}, Maugis's {1.157 * tabor:.2g}: {theory}): adhesion counts"
    )


def _atomic(contact, motion):
    sizes = {"u_lim": contact.u_lim, "the amplitude": motion.swing[0]}
    for name, size in sizes.items():
        if 0.0 < size < RANGE:
            yield (
                f"{name} is {size:.2g} m, less than the distance of atoms: the surfaces are no "
                "continua there"
            )


def _rough_mu(contact, motion):
    if contact.mu > LARGE_MU:
        yield (
            f"mu is {contact.mu:.3g}: above {LARGE_MU:g} it is rare but for rubber and clean "
            "metals that weld, of which Coulomb's law is a poor picture"
        )


def _steep(contact, motion):
    a, radius = contact.contact_radius, contact.radius
    whose = "radius of relative curvature"
    if a > STEEP * contact.smallest_radius:
        radius, whose = contact.smallest_radius, "smaller radius of the bodies"
    if a > STEEP * radius:
        share = f"{a / radius:.2g} of the {whose}"
        yield f"the contact radius is {share}: the bodies are no half-spaces"


def _far(contact, motion):
    if motion.frequency is None:
        return
    ratio = motion.swing[0] / contact.contact_radius
    if ratio > SMALL:
        yield (
            f"the amplitude is {ratio:.2g} of the contact radius: tractions are carried along by "
            "the material in a stroke, which the theory leaves out"
        )


def _inertia(contact, motion):
    known = [b for b in contact.bodies if b.density is not None and not b.rigid]
    if not known:
        return
    wave = min(math.sqrt(body.shear_modulus / body.density) for body in known)
    turn = motion.rotation if motion.frequency is None else 2.0 * math.pi * motion.frequency
    crossing = turn * contact.contact_radius / wave
    slip = largest_slip_speed(motion, contact) / wave
    if crossing > SMALL:
        yield f"a shear wave crosses the contact in {crossing:.2g} of a radian: inertia counts"
    elif slip > SMALL:
        yield f"the slip speed is {slip:.2g} of that of shear waves: inertia counts"


def _mismatched(contact, motion):
    beta = abs(contact.mismatch)
    if beta > SMALL:
        yield (
            f"the bodies are elastically unlike (Dundurs' beta {beta:.2g}): pressure moves their "
            "surfaces sideways, which the theory leaves out"
        )


_CHECKS = (_plastic, _too_hard, _steep, _far, _inertia, _mismatched)
_CHECKS += (_adhesive, _atomic, _rough_mu, _lossy)
