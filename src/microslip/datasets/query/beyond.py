"""Friction outside the tabulated range: proved limits, and brackets between them and the map.

Proved without a map: friction is 1 without vibration, it tends to the static limit for vanishing
velocity, never falls with the velocity (bounds.py), and the energy balance bounds its drop below 1.
Computed everywhere: friction falls with the amplitude.

At the edge of a map the bracket is as narrow as the error estimate there.  Outward it opens as two
powers of the coordinate allow: the distance of friction from its limit follows a power law whose
local exponent lies between 0 and twice the asymptotic one.  Local exponents of computed points:
0 to 1 towards the static limit, 1.2 to 2.5 towards fast sliding, 0.6 to 2 towards no vibration.

For large amplitudes friction tends to a limit (Eqs 6 and 29) from both sides: the sign of the
distance depends on the velocity.  The largest distance at the upper edge of the map within a decade
of velocities bounds the distance at all larger amplitudes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from microslip.theory.catalogue import FORMS
from microslip.theory.exact import LARGEST_DROPS, STATIC_LIMITS

ROUNDING = 1e-12
SLOW_EXPONENT = 2.0 / 3.0
"""Power of the velocity with which friction approaches its static limit."""
FAST_EXPONENT = 2.0
"""Power of 1 / velocity with which friction approaches 1 in fast sliding (Eqs 6 and 29)."""
NARROW_EXPONENT = 1.0
"""Power of the amplitude to which 1 - mu_macro is proportional for small amplitudes."""
WIDE_EXPONENT = 1.0
"""Power of 1 / amplitude with which friction approaches its limit for large amplitudes."""
STEEPEST = 2.0
"""Largest local exponent of a power law, relative to the asymptotic one."""
POISSON_DROP = 0.1
"""Static friction under transverse motion: its largest drop with Poisson's ratio nu, divided by
(nu / (2 - nu))^2.  Computed by solve("transverse", 0, A, poisson=nu): at most 0.067, near A = 0.9,
for nu from 0.1 to 0.5."""


class Estimate(NamedTuple):
    """Friction and its error estimate.

    Attributes
    ----------
    value, error : np.ndarray, shape (n,)
        Dimensionless.
    """

    value: np.ndarray
    error: np.ndarray


@dataclass(frozen=True)
class Limits:
    """Proved limits and bounds of a motion, functions of arrays of velocity and amplitude.

    Attributes
    ----------
    static_at_nu_0 : callable
        Limit for vanishing velocity at Poisson's ratio 0, of the amplitude.
    poisson_drop : float
        Largest drop of that limit with Poisson's ratio nu, divided by (nu / (2 - nu))^2.
    large : callable
        Limit for large amplitudes.
    same_limit : callable
        Velocity at which another amplitude has the same limit for large amplitudes, from velocity,
        amplitude and other amplitude.
    drop : callable
        Upper bound of 1 - mu_macro.
    """

    static_at_nu_0: Callable
    poisson_drop: float
    large: Callable
    same_limit: Callable
    drop: Callable

    def static(self, amplitude: np.ndarray, nu: float) -> Estimate:
        """Limit for vanishing velocity at Poisson's ratio `nu`, and its error bound."""
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


def is_known(motion: str, pressure: str) -> bool:
    """True if limits of a motion under a pressure are proved."""
    return pressure == "hertz" and (motion in LIMITS or motion == "continuous-bore")


def has_limits(dataset: xr.Dataset) -> bool:
    """True if limits are proved for a dataset: one contact, prescribed velocity, known motion."""
    if not is_alone(dataset):
        return False
    return is_known(dataset.attrs["motion"], dataset.attrs.get("pressure", "hertz"))


def is_alone(dataset: xr.Dataset) -> bool:
    """True for a dataset of one contact at a prescribed velocity."""
    return not {"drive", "contacts"} & set(dataset.attrs)


def slower(
    limits: Limits,
    edge: Estimate,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    nu: float,
    slowest: float,
) -> tuple:
    """Value and error for velocities from 0 to the slowest of a map, shape (n,) each.

    edge: at the slowest velocity and the same amplitudes; nu: Poisson's ratio.
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
    """Value and error for velocities above the fastest of a map, shape (n,) each.

    edge: at the fastest velocity and the same amplitudes; NaN where the map has no value.
    """
    low = 1.0 - limits.drop(velocity, amplitude)
    low = np.clip(np.fmax(low, edge.value - edge.error), 0.0, 1.0)  # never falls with the velocity
    share = (fastest / velocity) ** FAST_EXPONENT
    gap = np.fmax(1.0 - edge.value - edge.error, 0.0)
    high = np.maximum(1.0 - share**STEEPEST * gap, low)
    far = 1.0 - (1.0 - edge.value) * share
    return _within(low, high, np.where(np.isnan(far), low, far))


def wider(
    limits: Limits,
    edge: Estimate,
    distance: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    widest: float,
) -> tuple:
    """Value and error for amplitudes above the largest of a map, shape (n,) each.

    edge: at the largest amplitude, at the velocity with the same limit; distance: see `distances`.
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
    """Largest distance of friction from its limit for large amplitudes, at the edge of a map.

    Parameters
    ----------
    nodes, values, errors : numpy.ndarray, shape (m,)
        Velocities, friction and its errors along the largest amplitude of the map.
    velocity : numpy.ndarray, shape (n,)
        Velocities; the nodes within a decade of each count.
    widest : float
        Largest amplitude of the map.

    Returns
    -------
    numpy.ndarray, shape (n,)
    """
    if not velocity.size:
        return velocity  # the limit of the bore is expensive
    off = np.abs(values - limits.large(nodes, np.full_like(nodes, widest))) + errors
    away = np.abs(np.log10(np.clip(velocity, nodes[0], nodes[-1])[:, None] / nodes))
    near = (away <= 1.0) | (away == away.min(axis=1, keepdims=True))
    return np.where(near, off, 0.0).max(axis=1)


def narrower(limits: Limits, edge: Estimate, amplitude: np.ndarray, narrowest: float) -> tuple:
    """Value and error for amplitudes from 0 to the smallest of a map, shape (n,) each.

    edge: at the smallest amplitude and the same velocities.
    """
    low = np.clip(edge.value - edge.error, 0.0, 1.0)
    share = (amplitude / narrowest) ** NARROW_EXPONENT
    gap = np.maximum(1.0 - edge.value - edge.error, 0.0)
    high = np.maximum(1.0 - share**STEEPEST * gap, low)
    return _within(low, high, 1.0 - (1.0 - edge.value) * share)


def within_the_balance(
    limits: Limits,
    value: np.ndarray,
    error: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
) -> tuple:
    """Clip values and errors to the bounds from the energy balance; NaN remains NaN."""
    low = np.maximum(1.0 - limits.drop(velocity, amplitude), 0.0)
    value = np.clip(value, low, 1.0)
    reach = np.maximum(1.0 - value, value - low) + ROUNDING
    return value, np.where(np.isnan(value), error, np.fmin(error, reach))


def _within(low: np.ndarray, high: np.ndarray, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Clip a guess to its bracket; return it with its largest distance from the ends."""
    value = np.clip(guess, low, high)
    return value, np.maximum(high - value, value - low) + ROUNDING
