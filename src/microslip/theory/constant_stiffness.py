"""Friction under a sinusoidal indentation for a contact of constant stiffness.

Such a contact, for example a flat end, acts as a single spring. M. Popov (Front. Mech. Eng. 6:69,
2020) gives two empirical formulas, Eqs 37 and 38. Both depend on the ratio of the velocity to the
amplitude. If the ratio is above 1, the contact slides all the time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike


def sum_of_powers(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    """Compute the friction divided by mu times the mean load (Eq 37).

    Parameters
    ----------
    amplitude : array_like
        Amplitude of the indentation divided by its mean, 0 to 1.
    velocity : array_like
        Velocity divided by omega u_lim, where omega is the angular frequency.
    """
    left = _remainder(amplitude, velocity)
    return 1.0 - np.asarray(amplitude) * (0.75 * left**2 + 0.25 * left**4)


def single_power(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    """Compute the friction divided by mu times the mean load (Eq 38).

    The arguments are those of sum_of_powers.
    """
    return 1.0 - np.asarray(amplitude) * _remainder(amplitude, velocity) ** 2.4


def _remainder(amplitude: ArrayLike, velocity: ArrayLike) -> np.ndarray:
    return np.maximum(1.0 - np.asarray(velocity) / np.asarray(amplitude), 0.0)
