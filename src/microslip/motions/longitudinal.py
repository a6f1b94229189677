"""Forward sliding with an oscillation along the same direction."""

from dataclasses import replace

import numpy as np

from microslip.motions import transverse
from microslip.pressures.pressure import Pressure
from microslip.theory import masing


def displacement(phase: np.ndarray, velocity: float, amplitude: float, poisson: float) -> tuple:
    """Forward v~ t + x~ sin t."""
    forward = velocity * phase + amplitude * np.sin(phase)
    return forward, np.zeros_like(phase), np.zeros_like(phase)


def turns(velocity: float, amplitude: float) -> tuple[float, ...]:
    """Where the sphere turns back and forth, if it does: v~ + x~ cos t = 0."""
    back = np.arccos(-velocity / amplitude) if velocity < amplitude else np.pi / 2
    return -back, back, 2.0 * np.pi - back


def closed_form_of(velocity: float, amplitude: float, pressure: Pressure) -> float | None:
    """First loading with Masing's memory, where the curve of first loading is known."""
    if pressure.loading is None:
        return None
    return masing.longitudinal(velocity, amplitude, pressure.loading)


MOTION = replace(
    transverse.MOTION,
    name="longitudinal",
    summary="sliding forward while oscillating along the same direction",
    displacement=displacement,
    half_period_mirror=False,
    turns=turns,
    amplitude_label="x0 / u_lim",
    closed_form_of=closed_form_of,
)
