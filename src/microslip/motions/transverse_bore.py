"""Oscillation in the lateral direction together with an oscillating rotation.

    transverse-bore:lateral=L,angle=B,phase=P

With the amplitude A, the lateral displacement is A L sin(t).  The angle is sin(t + P) times the
largest angle of a bore with the amplitude A B; P is in degrees.  B = 0 gives the transverse motion.
L = 0 gives the bore, except that the velocity is divided by omega u_lim.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.motions.motion import Motion, stick_focus, within_rings
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz, paper


@dataclass(frozen=True)
class TransverseBore(Motion):
    """Sliding forward with a lateral oscillation and an oscillating rotation.

    Parameters
    ----------
    lateral, angle : float
        Amplitudes divided by the amplitude of the motion, 0 to 1.  The unit of `lateral` is u_lim,
        and the unit of `angle` is phi_lk(a/2).
    phase : float
        Phase of the rotation, in degrees.

    Raises
    ------
    InputError
        If an amplitude is outside 0 to 1, or if both are 0.
    """

    lateral: float = 1.0
    angle: float = 1.0
    phase: float = 0.0

    summary = "sliding forward while oscillating sideways and in rotation"
    numbers = (
        "such as angle=0.5,phase=90: fractions of A, lateral (1, divided by u_lim) and angle (1, "
        "divided by phi_lk(a/2)), phase of the rotation in degrees (0)"
    )
    half_period_mirror = True

    def __post_init__(self) -> None:
        super().__post_init__()
        spec.refuse_shares(self.name, "motion", {"lateral": self.lateral, "angle": self.angle})
        if max(self.lateral, self.angle) == 0.0:
            raise InputError("motion", self.name, "allowed is lateral or angle above 0")

    @property
    def lead(self) -> float:
        """Phase of the rotation, in radians."""
        return float(np.deg2rad(self.phase % 360.0)) if self.lateral > 0.0 else 0.0

    @property
    def rotates(self) -> bool:
        return self.angle > 0.0

    @property
    def half_disc(self) -> bool:
        return self.angle == 0.0 or self.lateral == 0.0

    @property
    def straight(self) -> bool:
        return self.angle == 0.0 or self.lead % np.pi == 0.0

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t, lateral displacement A L sin t, and an angle proportional to
        sin(t + P)."""
        angle = hertz.bore_angle(amplitude * self.angle, poisson) * np.sin(phase + self.lead)
        return velocity * phase, amplitude * self.lateral * np.sin(phase), angle

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Stick radius of the lateral oscillation alone, or of the rotation alone if L = 0."""
        if self.lateral > 0.0:
            return stick_focus(amplitude * self.lateral, pressure)
        return within_rings(float(paper.bore_stick_radius(amplitude * self.angle)))
