"""Exact threshold force above which a vibrated contact drifts.

The threshold equals the static limit, because the forward force of the contact is constant in both
cases. This applies to oscillations without a component along the force.
"""

from __future__ import annotations

import numpy as np

from microslip.theory.exact import STATIC_LIMITS

MOTIONS = ("transverse", "zigzag", "bore")
"""Motions with an exact threshold under Hertz pressure."""
WIDEST = 1e3
"""Amplitude at which the threshold is practically zero, used as the upper end of the search."""


def is_known(motion: str, pressure: str, poisson: float) -> bool:
    """True if the exact threshold is known. The motion and the pressure are given by name."""
    if pressure != "hertz" or motion not in MOTIONS:
        return False
    return poisson == 0.0 or STATIC_LIMITS[motion].any_poisson


def threshold(motion: str, amplitude: np.ndarray | float) -> np.ndarray | float:
    """Threshold force divided by mu F_z, with the shape of the amplitude (>= 0)."""
    return STATIC_LIMITS[motion].function(amplitude)


def first_amplitude(motion: str, force: float) -> float:
    """Amplitude above which a force (between 0 and 1) moves the contact."""
    from scipy.optimize import brentq  # only here, because it takes a while to load

    return float(brentq(lambda a: float(threshold(motion, a)) - force, 0.0, WIDEST, xtol=1e-14))
