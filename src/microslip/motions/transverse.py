"""Forward sliding with an oscillation across it, the paper's first motion."""

import numpy as np

from microslip.motions.motion import Motion, stick_focus


def displacement(phase: np.ndarray, velocity: float, amplitude: float, poisson: float) -> tuple:
    """Eq 1 with Eqs 2 and 4: forward v~ t, lateral y~ sin t."""
    return velocity * phase, amplitude * np.sin(phase), np.zeros_like(phase)


MOTION = Motion(
    name="transverse",
    summary="sliding forward while oscillating sideways",
    displacement=displacement,
    periodic=True,
    rotates=False,
    half_period_mirror=True,
    # the stick radius of the oscillation alone (Eq 8); nowhere once it slides fully
    focus=lambda velocity, amplitude, pressure: stick_focus(amplitude, pressure),
    velocity_label="v0 / (omega u_lim)",
    amplitude_label="y0 / u_lim",
)
