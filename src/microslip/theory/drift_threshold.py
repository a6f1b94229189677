"""The force above which a vibrated contact drifts, where it is known exactly.

It is the static limit: a constant force keeps the forward force of the contact constant, as does a
velocity that vanishes.  The contact must not oscillate along the force.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from microslip.theory.exact import STATIC_LIMITS

KNOWN = ("transverse", "zigzag", "bore")
"""Motions under Hertz's pressure that it is known of."""
WIDEST = 1e3
"""Amplitude at which it is smaller than any force here."""


def is_known(motion: str, pressure: str, poisson: float) -> bool:
    """Whether the threshold of a motion under a pressure, by their names, is known exactly."""
    return pressure == "hertz" and motion in KNOWN and (poisson == 0.0 or any_poisson(motion))


def any_poisson(motion: str) -> bool:
    """Whether that of one of KNOWN holds for every Poisson's ratio, else for 0."""
    return STATIC_LIMITS[motion].any_poisson


def threshold(motion: str, amplitude: np.ndarray | float) -> np.ndarray | float:
    """The force over mu F_z, an array or a float like the amplitude, >= 0."""
    return STATIC_LIMITS[motion].function(amplitude)


def first_amplitude(motion: str, force: float) -> float:
    """Amplitude above which a force above 0 and below 1 moves the contact."""
    return float(brentq(lambda a: float(threshold(motion, a)) - force, 0.0, WIDEST, xtol=1e-14))
