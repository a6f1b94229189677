"""Forward sliding with a steady rotation about the contact normal, the paper's third motion."""

import numpy as np

from microslip.motions.motion import Motion, within_rings
from microslip.pressures.pressure import Pressure


def displacement(phase: np.ndarray, velocity: float, amplitude: float, poisson: float) -> tuple:
    """Eqs 12 and 13: forward v~ and angle 1 for each unit of turned angle (in u_lim / a)."""
    return velocity * phase, np.zeros_like(phase), phase + 0.0


def focus(velocity: float, amplitude: float, pressure: Pressure) -> float | None:
    """The instantaneous centre of rotation, while it lies inside the contact (Eq 14)."""
    return within_rings(velocity) if velocity < 1.0 else None


MOTION = Motion(
    name="continuous-bore",
    summary="sliding forward while rotating steadily about the contact normal",
    displacement=displacement,
    periodic=False,
    rotates=True,
    half_period_mirror=False,
    focus=focus,
    velocity_label="v0 / (omega a)",
)
