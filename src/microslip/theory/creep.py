"""Velocity that a constant force gives a contact of large amplitude, in closed form.

A rigid contact without mass moves at each instant as fast as makes its friction equal to the force,
so that its velocity follows that of the vibration in proportion.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from microslip.theory.hertz import checked
from microslip.theory.paper import bore_forward

_FASTEST = 1e6
"""Velocity above which a bore lacks less of full friction than any force here does."""


def transverse_creep(
    force: np.ndarray | float, amplitude: np.ndarray | float
) -> np.ndarray | float:
    """Mean velocity under sideways oscillation, (2/pi) A P / sqrt(1 - P^2).

    Parameters
    ----------
    force : array_like
        P over mu F_z, >= 0.
    amplitude : array_like
        A in u_lim, >= 0; broadcast.

    Returns
    -------
    np.ndarray or float
        In the unit of the velocity of that motion, omega u_lim; infinite from P = 1 on, where
        friction holds no more.

    Raises
    ------
    ValueError
        For arguments out of range.
    """
    force, amplitude = checked("force", force), checked("amplitude", amplitude)
    held = np.sqrt(np.maximum(1.0 - force**2, 0.0))
    with np.errstate(divide="ignore"):
        return 2.0 / np.pi * amplitude * np.where(force < 1.0, force / held, np.inf)[()]


def bore_creep(force: np.ndarray | float, amplitude: np.ndarray | float) -> np.ndarray | float:
    """Mean velocity under oscillating bore, (2/pi) E^-1(P) with the friction E of Eq 21.

    Arguments and errors as `transverse_creep`.  In the unit of the velocity of that motion, which
    is proportional to the amplitude, so that nothing else depends on it.
    """
    steady = np.vectorize(_steady_bore, otypes=[float])(checked("force", force))
    return np.broadcast_arrays(2.0 / np.pi * steady, checked("amplitude", amplitude))[0].copy()


def _steady_bore(force):
    """Velocity of a steady bore whose forward friction is `force` (inverse of Eq 21)."""
    if force >= 1.0:
        return np.inf
    return brentq(lambda velocity: float(bore_forward(velocity)) - force, 0.0, _FASTEST, xtol=1e-14)
