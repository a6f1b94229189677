"""Mean velocity of a contact under a constant force at large amplitude, in closed form.

At each instant, a massless rigid contact moves at the velocity at which friction balances the
force. So its velocity is proportional to the velocity of the vibration.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from microslip.foundation.errors import InputError
from microslip.theory.hertz import checked
from microslip.theory.paper import bore_forward

_FASTEST = 1e6
"""Largest velocity of a steady bore. Its friction 1 - 0.1/v^2 is within 1e-13 of full friction. So
a rounding error of 1e-16 in the force changes the velocity by a fraction of 1e-3."""


def transverse_drift(
    force: np.ndarray | float, amplitude: np.ndarray | float
) -> np.ndarray | float:
    """Mean velocity of a rigid contact under transverse oscillation, (2/pi) A P / sqrt(1 - P^2).

    Parameters
    ----------
    force : array_like
        Force P divided by mu F_z, >= 0.
    amplitude : array_like
        Amplitude A in u_lim, >= 0. It is broadcast with the force.

    Returns
    -------
    np.ndarray or float
        Velocity divided by omega u_lim. It is infinite for P >= 1, where friction cannot balance
        the force.

    Raises
    ------
    ValueError
        If an argument is out of range.
    """
    force, amplitude = checked("force", force), checked("amplitude", amplitude)
    lateral = np.sqrt(np.maximum(1.0 - force**2, 0.0))
    with np.errstate(divide="ignore"):
        return 2.0 / np.pi * amplitude * np.where(force < 1.0, force / lateral, np.inf)[()]


def bore_drift(force: np.ndarray | float, amplitude: np.ndarray | float) -> np.ndarray | float:
    """Mean velocity of a rigid contact under oscillating bore.

    It is (2/pi) E^-1(P), where E is the friction of Eq 21 as a function of velocity. The velocity
    is in units of Omega phi0 a. This unit is proportional to the amplitude, so the result does not
    depend on the amplitude. The arguments and exceptions are those of `transverse_drift`; forces
    between 1 - 1e-13 and 1 raise InputError.
    """
    steady = np.vectorize(_steady_bore, otypes=[float])(checked("force", force))
    return np.broadcast_arrays(2.0 / np.pi * steady, checked("amplitude", amplitude))[0].copy()


def _steady_bore(force: float) -> float:
    """Velocity of a steady bore with the forward friction `force` (inverse of Eq 21)."""
    if force >= 1.0:
        return np.inf
    if force > bore_forward(_FASTEST):
        allowed = "allowed are forces up to 1 - 1e-13, and forces of at least 1"
        raise InputError("force", float(force), allowed)
    return brentq(lambda velocity: float(bore_forward(velocity)) - force, 0.0, _FASTEST, xtol=1e-14)
