"""The transverse motion with a triangular wave in place of the sine."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.motions.transverse import Transverse


@dataclass(frozen=True)
class Zigzag(Transverse):
    """Sliding forward with a triangular oscillation in the lateral direction."""

    summary = "sliding forward while moving sideways at constant speed, with abrupt turns"

    def displacement(
        self, phase: np.ndarray, velocity: float, amplitude: float, poisson: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forward displacement v~ t, and lateral displacement y~ times a triangular wave."""
        lateral = amplitude * 2.0 / np.pi * np.arcsin(np.sin(phase))
        return velocity * phase, lateral, np.zeros_like(phase)
