"""Where an assumption of the theory breaks at a real contact: one sentence each."""

from __future__ import annotations

import math

from microslip.si.dimensionless import largest_slip_speed

YIELDS_AT = 0.57
"""Largest Hertz pressure over hardness at which plastic flow sets in below the surface: 1.6 of the
yield stress, with a hardness of 2.8 times that (K. L. Johnson, Contact Mechanics, 6.1 and 6.3)."""
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


def broken_assumptions(contact, motion) -> list[str]:
    """List of warnings; contact: bodies.TwoBodies, motion: dimensionless.RealMotion."""
    return [text for check in _CHECKS for text in check(contact, motion)]


def unchecked(contact) -> list[str]:
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


_CHECKS = (_plastic, _steep, _far, _inertia, _mismatched)
