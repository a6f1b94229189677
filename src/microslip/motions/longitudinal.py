"""Forward sliding with an oscillation in the forward direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.motions.motion import Motion, stick_focus
from microslip.pressures.pressure import Pressure
from microslip.theory import masing


@dataclass(frozen=True)
class Longitudinal(Motion):
    """Sliding forward with a sinusoidal oscillation in the forward direction."""

    summary = "sliding forward while oscillating along the same direction"
    amplitude_label = "x0 / u_lim"

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t + x~ sin t."""
        forward = velocity * phase + amplitude * np.sin(phase)
        return forward, np.zeros_like(phase), np.zeros_like(phase)

    def focus(self, velocity: float, amplitude: float, pressure: Pressure) -> float | None:
        """Stick radius of the oscillation alone (Eq 8)."""
        return stick_focus(amplitude, pressure)

    def turns(self, velocity: float, amplitude: float) -> tuple[float, ...]:
        """Phases at which v~ + x~ cos t changes its sign. If its sign never changes, -pi/2, pi/2
        and 3 pi/2."""
        back = np.arccos(-velocity / amplitude) if velocity < amplitude else np.pi / 2
        return -back, back, 2.0 * np.pi - back

    def closed_form(
        self, velocity: float, amplitude: float, pressure: Pressure
    ) -> tuple[float, float] | None:
        """Friction and energy by Masing's rule, for pressures with a known loading curve."""
        if pressure.loading is None:
            return None
        place = velocity, amplitude, pressure.loading
        return float(masing.longitudinal(*place)), masing.longitudinal_energy(*place)
