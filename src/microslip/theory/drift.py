"""Velocity that a constant force gives a contact of large amplitude, in closed form.

A rigid contact without mass moves at each instant as fast as makes its friction equal to the force,
so that its velocity follows that of the vibration in proportion.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from microslip.foundation.errors import InputError
from microslip.theory.hertz import checked
from microslip.theory.paper import bore_forward

_FASTEST = 1e6
"""Largest velocity of a steady bore: its friction, 1 - 0.1/v^2, is within 1e-13 of full friction,
so that rounding of the force (1e-16) already moves the velocity by 1e-3 of itself."""


def transverse_drift(
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


def bore_drift(force: np.ndarray | float, amplitude: np.ndarray | float) -> np.ndarray | float:
    """Mean velocity under oscillating bore, (2/pi) E^-1(P) with the friction E of Eq 21.

    Arguments and errors are those of `transverse_drift`; forces between 1 - 1e-13 and 1 are
    refused, too.  The velocity is in the unit of that motion, which is proportional to the
    amplitude, so that it does not depend on the amplitude.
    """
    steady = np.vectorize(_steady_bore, otypes=[float])(checked("force", force))
    return np.broadcast_arrays(2.0 / np.pi * steady, checked("amplitude", amplitude))[0].copy()


def _steady_bore(force: float) -> float:
    """Velocity of a steady bore whose forward friction is `force` (inverse of Eq 21)."""
    if force >= 1.0:
        return np.inf
    if force > bore_forward(_FASTEST):
        allowed = "allowed are forces up to 1 - 1e-13, and from 1 on, where the contact runs away"
        raise InputError("force", float(force), allowed)
    return brentq(lambda velocity: float(bore_forward(velocity)) - force, 0.0, _FASTEST, xtol=1e-14)


def antiphase_drift(force: np.ndarray | float, amplitude: np.ndarray | float) -> np.ndarray | float:
    """Mean velocity of two spheres on one body that oscillate along its way against each other,
    (2/pi) (A - 1 + P^(2/3)) where that is above 0.

    The body has no mass, nu = 0, and the loads are equal.  While one sphere slides at its bound the
    other one sticks under 2 P - 1 of its own bound, and the body follows it without strain.  Where
    the way turns, the two change their parts: the forces of both change by 2 - 2 P, for which each
    is strained by twice the displacement of a first loading to 1 - P, 2 (1 - P^(2/3)), one forward
    and one back (Masing, Cattaneo and Mindlin), while the body stays.  What is left of the stroke
    is the way of the body.  It moves from P = (1 - A)^(3/2) on, the static limit of each alone, and
    a rigid one at (2/pi) A under any force.

    Arguments, result and errors as `transverse_drift`; at P = 0 it is the limit of a small force.
    """
    force, amplitude = checked("force", force), checked("amplitude", amplitude)
    moved = np.maximum(amplitude - 1.0 + force ** (2.0 / 3.0), 0.0)
    return 2.0 / np.pi * np.where(force < 1.0, moved, np.inf)[()]
