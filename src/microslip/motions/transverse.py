"""The paper's first motion: forward sliding with an oscillation in the lateral direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.motions.motion import Motion, stick_focus
from microslip.pressures.pressure import Pressure


@dataclass(frozen=True)
class Transverse(Motion):
    """Sliding forward with a sinusoidal oscillation in the lateral direction."""

    summary = "sliding forward while oscillating sideways"
    amplitude_label = "y0 / u_lim"
    half_period_mirror = True

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t and lateral displacement y~ sin t (Eqs 1, 2 and 4)."""
        return velocity * phase, amplitude * np.sin(phase), np.zeros_like(phase)

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Stick radius of the oscillation alone (Eq 8)."""
        return stick_focus(amplitude, pressure)
