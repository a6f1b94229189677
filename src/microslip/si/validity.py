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


def doubts(contact, motion) -> list[str]:
    """List of warnings; contact: contact.TwoBodies, motion: groups.RealMotion."""
    return [text for text in (check(contact, motion) for check in _CHECKS) if text]


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
        return (
            f"the largest pressure, {pressure:.2g} Pa, is above {YIELDS_AT:g} of the hardness, "
            f"{min(known):.2g} Pa: the contact yields, and is larger than Hertz's"
        )
    return ""


def _steep(contact, motion):
    a = contact.contact_radius
    for radius, whose in (
        (contact.smallest_radius, "smaller radius of the bodies"),
        (contact.radius, "radius of relative curvature"),
    ):
        if a > STEEP * radius:
            return (
                f"the contact radius is {a / radius:.2g} of the {whose}: the bodies are no "
                "half-spaces"
            )
    return ""


def _far(contact, motion):
    if motion.frequency is None or motion.scene == "bore":
        return ""
    ratio = motion.amplitude / contact.contact_radius
    if ratio > SMALL:
        return (
            f"the amplitude is {ratio:.2g} of the contact radius: tractions are carried along by "
            "the material in a stroke, which the theory leaves out"
        )
    return ""


def _inertia(contact, motion):
    speeds = [
        math.sqrt(b.shear_modulus / b.density)
        for b in contact.bodies
        if b.density is not None and not b.rigid
    ]
    if not speeds:
        return ""
    wave = min(speeds)
    turn = motion.rotation if motion.frequency is None else 2.0 * math.pi * motion.frequency
    ratio = turn * contact.contact_radius / wave
    if ratio > SMALL:
        return f"a shear wave crosses the contact in {ratio:.2g} of a radian: inertia counts"
    ratio = largest_slip_speed(motion, contact) / wave
    if ratio > SMALL:
        return f"the slip speed is {ratio:.2g} of that of shear waves: inertia counts"
    return ""


def _mismatched(contact, motion):
    beta = abs(contact.mismatch)
    if beta > SMALL:
        return (
            f"the bodies are elastically unlike (Dundurs' beta {beta:.2g}): pressure moves their "
            "surfaces sideways, which the theory leaves out"
        )
    return ""


_CHECKS = (_plastic, _steep, _far, _inertia, _mismatched)
