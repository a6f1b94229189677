"""The transverse motion at a lateral speed that is constant but for its sign."""

from dataclasses import replace

import numpy as np

from microslip.motions import transverse


def displacement(phase: np.ndarray, velocity: float, amplitude: float, poisson: float) -> tuple:
    """Forward v~ t, lateral to and fro between -y~ and y~, straight in the plane."""
    lateral = amplitude * 2.0 / np.pi * np.arcsin(np.sin(phase))
    return velocity * phase, lateral, np.zeros_like(phase)


MOTION = replace(
    transverse.MOTION,
    name="zigzag",
    summary="sliding forward while moving sideways at constant speed, with abrupt turns",
    displacement=displacement,
)
