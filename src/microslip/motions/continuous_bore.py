"""The paper's third motion: forward sliding with a steady rotation about the contact normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.motions.motion import Motion, within_rings
from microslip.pressures.pressure import Pressure


@dataclass(frozen=True)
class ContinuousBore(Motion):
    """Sliding forward with a steady rotation about the contact normal."""

    summary = "sliding forward while rotating steadily about the contact normal"
    velocity_label = "v0 / (omega a)"
    amplitude_label = ""
    periodic = False
    rotates = True

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t and angle t; the phase t is the angle in u_lim / a (Eqs 12 and
        13)."""
        return velocity * phase, np.zeros_like(phase), phase + 0.0

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Radius of the instantaneous centre of rotation if it is inside the contact (Eq 14)."""
        return within_rings(velocity) if velocity < 1.0 else None
