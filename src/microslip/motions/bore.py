"""The paper's second motion: forward sliding with an oscillating rotation (spin)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.motions.motion import Motion, within_rings
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz, paper


@dataclass(frozen=True)
class Bore(Motion):
    """Sliding forward with a sinusoidal rotation about the contact normal (spin)."""

    summary = "sliding forward while oscillating in rotation about the contact normal"
    velocity_label = "v0 / (Omega phi0 a)"
    amplitude_label = "phi0 / phi_lk(a/2)"
    rotates = True
    half_period_mirror = True

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ phi_0 t and angle phi_0 sin t (Eqs 23, 27 and 28)."""
        angle = hertz.bore_angle(amplitude, poisson)
        return velocity * angle * phase, np.zeros_like(phase), angle * np.sin(phase)

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Lubkin's stick radius of the oscillation alone (Eq 30).

        The radius is used for other pressures too, because this grading does no harm there.
        """
        return within_rings(float(paper.bore_stick_radius(amplitude)))
