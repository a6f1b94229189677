"""The dimensionless groups of a motion in SI units, and back."""

from __future__ import annotations

import math
from dataclasses import dataclass

from microslip.theory import hertz


@dataclass(frozen=True)
class RealMotion:
    """A motion in SI units: forward speed, m/s; amplitude (half stroke), m or rad; frequency, Hz;
    rotation, rad/s, of a steady bore.  What a scene does not have is None."""

    scene: str
    speed: float
    amplitude: float | None = None
    frequency: float | None = None
    rotation: float | None = None


def groups(motion: RealMotion, contact) -> tuple[float, float | None]:
    """(velocity, amplitude) as microslip.solve takes them (Eqs 2, 4, 13, 27, 28).

    motion: RealMotion; contact: bodies.TwoBodies.  amplitude: None for a steady bore.
    """
    a, u_lim = contact.contact_radius, contact.u_lim
    if motion.scene == "continuous-bore":
        return _over(motion.speed, motion.rotation * a), None
    omega = 2.0 * math.pi * motion.frequency
    if motion.scene == "bore":
        if motion.amplitude == 0.0:
            return 0.0, 0.0
        amplitude = float(hertz.bore_amplitude(motion.amplitude * a / u_lim, contact.poisson))
        return _over(motion.speed, omega * motion.amplitude * a), amplitude
    return _over(motion.speed, omega * u_lim), motion.amplitude / u_lim


def _over(speed, unit):
    """A speed over another one that may have been rounded to nothing."""
    if speed == 0.0:
        return 0.0
    return speed / unit if unit > 0.0 else math.inf


def largest_slip_speed(motion: RealMotion, contact) -> float:
    """Upper bound of the speed between the surfaces, m/s: rigid, at the edge."""
    edge = contact.contact_radius
    if motion.scene == "continuous-bore":
        return math.hypot(motion.speed, motion.rotation * edge)
    swing = 2.0 * math.pi * motion.frequency * motion.amplitude
    return motion.speed + swing * (edge if motion.scene == "bore" else 1.0)
