"""Friction outside the tabulated range, from brackets between the map and proved limits.

Four properties are proved.  Friction is 1 without vibration.  It tends to the static limit for
vanishing velocity.  It never decreases with the velocity (bounds.py).  The energy balance gives a
bound on 1 - mu_macro.  At all computed points, friction also decreases with the amplitude.

At the edge of a map, the bracket is as narrow as the error estimate.  Away from the edge, the
bracket widens.  The difference between friction and its limit is assumed to follow a power law with
a local exponent between 0 and twice the asymptotic exponent.  At the computed points, the local
exponent is 0 to 1 near the static limit, 1.2 to 2.5 in fast sliding, and 0.6 to 2 for small
amplitudes.

For large amplitudes, friction tends to a limit (Eqs 6 and 29).  The sign of the difference from
this limit depends on the velocity.  Above the map's largest amplitude, this difference is bounded
by the largest absolute difference along the map's upper edge, within a decade of velocities.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from microslip.datasets.catalogue import FORMS
from microslip.theory.exact import LARGEST_DROPS, STATIC_LIMITS

ROUNDING = 1e-12
SLOW_EXPONENT = 2.0 / 3.0
"""Friction minus its static limit is proportional to the velocity to this power."""
FAST_EXPONENT = 2.0
"""In fast sliding, 1 - mu_macro is proportional to 1 / velocity^FAST_EXPONENT (Eqs 6 and 29)."""
NARROW_EXPONENT = 1.0
"""For small amplitudes, 1 - mu_macro is proportional to the amplitude to this power."""
WIDE_EXPONENT = 1.0
"""For large amplitudes, friction minus its limit is proportional to 1 / amplitude^WIDE_EXPONENT."""
STEEPEST = 2.0
"""Largest local exponent of a power law, divided by the asymptotic exponent."""
POISSON_DROP = 0.1
"""Bound on the decrease of transverse static friction from Poisson's ratio 0 to nu, divided by
(nu / (2 - nu))^2.  solve("transverse", 0, A, poisson=nu) gives at most 0.067, near A = 0.9, for nu
from 0.1 to 0.5."""


class Estimate(NamedTuple):
    """Friction and its error estimate.

    Attributes
    ----------
    value, error : np.ndarray, shape (n,)
        Friction and the error estimate, dimensionless.
    """

    value: np.ndarray
    error: np.ndarray


@dataclass(frozen=True)
class Limits:
    """Proved limits and bounds for a motion, as functions of arrays.

    Attributes
    ----------
    static_at_nu_0 : callable
        Function of the amplitude: limit for vanishing velocity at Poisson's ratio 0.
    poisson_drop : float
        Largest decrease of this limit from Poisson's ratio 0 to nu, divided by (nu / (2 - nu))^2.
    large : callable
        Function of velocity and amplitude: limit for large amplitudes.
    same_limit : callable
        Function (velocity, amplitude, other) -> velocity.  At the returned velocity and the
        amplitude `other`, `large` has the same value as at the first two arguments.
    drop : callable
        Function of velocity and amplitude: upper bound of 1 - mu_macro.
    """

    static_at_nu_0: Callable
    poisson_drop: float
    large: Callable
    same_limit: Callable
    drop: Callable

    def static(self, amplitude: np.ndarray, nu: float) -> Estimate:
        """Return the limit for vanishing velocity at Poisson's ratio `nu`, with its error bound."""
        high = np.asarray(self.static_at_nu_0(amplitude), float)
        low = np.maximum(high - self.poisson_drop * (nu / (2.0 - nu)) ** 2, 0.0)
        return Estimate((high + low) / 2.0, (high - low) / 2.0 + ROUNDING)


def _limits(motion: str, same_limit: Callable) -> Limits:
    static, large = STATIC_LIMITS[motion], FORMS[motion]["mu_large_amplitude"]
    return Limits(
        static.function,
        0.0 if static.any_poisson else POISSON_DROP,
        lambda *point: large.function(*point[: len(large.arguments)]),
        same_limit,
        np.vectorize(LARGEST_DROPS[motion], otypes=[float]),
    )


LIMITS = {
    "transverse": _limits(
        "transverse", lambda velocity, amplitude, other: velocity * other / amplitude
    ),
    "bore": _limits("bore", lambda velocity, amplitude, other: velocity),
}


def has_limits(dataset: xr.Dataset) -> bool:
    """Return True if limits are proved for the motion, the pressure and the drive of a dataset."""
    about, motion = dataset.attrs, dataset.attrs["motion"]
    is_known = motion in LIMITS or motion == "continuous-bore"
    return is_known and about.get("pressure", "hertz") == "hertz" and is_alone(dataset)


def is_alone(dataset: xr.Dataset) -> bool:
    """Return True for a dataset at a prescribed velocity."""
    return "drive" not in dataset.attrs


def slower(
    limits: Limits,
    edge: Estimate,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    nu: float,
    slowest: float,
) -> tuple:
    """Estimate friction at velocities from 0 to the lowest velocity of a map.

    edge: friction at the lowest velocity and the same amplitudes; nu: Poisson's ratio.  Returns
    values and errors, shape (n,) each.
    """
    static = limits.static(amplitude, nu)
    least = np.maximum(static.value - static.error, 0.0)
    # Friction never falls with the velocity.
    high = np.maximum(edge.value + edge.error, static.value + static.error)
    share = (velocity / slowest) ** SLOW_EXPONENT
    low = least + share**STEEPEST * np.maximum(edge.value - edge.error - least, 0.0)
    return _within(low, high, static.value + share * (edge.value - static.value))


def faster(
    limits: Limits, edge: Estimate, velocity: np.ndarray, amplitude: np.ndarray, fastest: float
) -> tuple:
    """Estimate friction at velocities above the highest velocity of a map.

    edge: friction at the highest velocity and the same amplitudes; NaN if the map has no value
    there.  Returns values and errors, shape (n,) each.
    """
    low = 1.0 - limits.drop(velocity, amplitude)
    low = np.clip(np.fmax(low, edge.value - edge.error), 0.0, 1.0)  # never falls with the velocity
    return _near_full_friction(edge, low, (fastest / velocity) ** FAST_EXPONENT)


def wider(
    limits: Limits,
    edge: Estimate,
    distance: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    widest: float,
) -> tuple:
    """Estimate friction at amplitudes above the largest amplitude of a map.

    edge: friction at the largest amplitude of the map, at the velocities from `same_limit`;
    distance: see `distances`.  Returns values and errors, shape (n,) each.
    """
    end = limits.large(velocity, amplitude)
    share = (widest / amplitude) ** WIDE_EXPONENT
    gap = (edge.value - end) * share
    away = (distance + np.abs(gap)) * (1.0 - share**STEEPEST)
    return np.clip(end + gap, 0.0, 1.0), away + edge.error


def distances(
    limits: Limits,
    nodes: np.ndarray,
    values: np.ndarray,
    errors: np.ndarray,
    velocity: np.ndarray,
    widest: float,
) -> np.ndarray:
    """Return the largest differences between friction at a map's largest amplitude and the limit
    for large amplitudes.

    Parameters
    ----------
    nodes, values, errors : numpy.ndarray, shape (m,)
        Velocities, friction, and errors of friction along the map's largest amplitude.
    velocity : numpy.ndarray, shape (n,)
        Requested velocities.  For each velocity, all nodes within a decade are used.
    widest : float
        Largest amplitude of the map.

    Returns
    -------
    numpy.ndarray, shape (n,)
    """
    if not velocity.size:
        return velocity  # avoids the bore's limit, which is expensive
    off = np.abs(values - limits.large(nodes, np.full_like(nodes, widest))) + errors
    away = np.abs(np.log10(np.clip(velocity, nodes[0], nodes[-1])[:, None] / nodes))
    near = (away <= 1.0) | (away == away.min(axis=1, keepdims=True))
    return np.where(near, off, 0.0).max(axis=1)


def narrower(limits: Limits, edge: Estimate, amplitude: np.ndarray, narrowest: float) -> tuple:
    """Estimate friction at amplitudes from 0 to the smallest amplitude of a map.

    edge: friction at the smallest amplitude and the same velocities.  Returns values and errors,
    shape (n,) each.
    """
    low = np.clip(edge.value - edge.error, 0.0, 1.0)
    return _near_full_friction(edge, low, (amplitude / narrowest) ** NARROW_EXPONENT)


def _near_full_friction(edge: Estimate, low: np.ndarray, share: np.ndarray) -> tuple:
    """Estimate friction between its value at the edge of a map (share = 1) and 1 (share = 0).

    low: lower end of the bracket.  The value is `low` if friction at the edge is unknown.
    """
    gap = np.fmax(1.0 - edge.value - edge.error, 0.0)
    high = np.maximum(1.0 - share**STEEPEST * gap, low)
    guess = 1.0 - (1.0 - edge.value) * share
    return _within(low, high, np.where(np.isnan(guess), low, guess))


def within_the_balance(
    limits: Limits,
    value: np.ndarray,
    error: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
) -> tuple:
    """Clip values and errors to the bounds from the energy balance.  NaN stays NaN."""
    low = np.maximum(1.0 - limits.drop(velocity, amplitude), 0.0)
    value = np.clip(value, low, 1.0)
    reach = np.maximum(1.0 - value, value - low) + ROUNDING
    return value, np.where(np.isnan(value), error, np.fmin(error, reach))


def _within(low: np.ndarray, high: np.ndarray, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Clip an estimate to its bracket.  Return the estimate and its distance to the farther end."""
    value = np.clip(guess, low, high)
    return value, np.maximum(high - value, value - low) + ROUNDING
