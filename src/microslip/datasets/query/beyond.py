"""Friction where a map ends: limits that are proved, and brackets between them and the map.

Known without a map: friction without vibration (1), the static limit, the largest drop that
the energy balance allows.  Between these and the edge of a map a value is bracketed, as friction
rises with the velocity (bounds.py) and, in all that was computed, falls with the amplitude; what a
bracket leaves open is in the error.

For large amplitudes friction tends to a limit (Eqs 6 and 29), but not from one side: how far it is
from there changes its sign with the velocity.  The largest distance that the upper edge of the map
shows within a decade of velocities is taken for that of all larger amplitudes.
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
"""Friction comes close to its static limit about as this power of the velocity."""


@dataclass(frozen=True)
class Limits:
    """What is proved about a scene, functions of arrays of velocity and amplitude.

    Attributes
    ----------
    static : callable
        Limit for vanishing velocity, of the amplitude.
    static_needs_nu_0 : bool
        Whether that is proved for Poisson's ratio 0 alone.
    large : callable
        Limit for large amplitudes.
    same_limit : callable
        Velocity at which another amplitude has the same one (velocity, amplitude, other amplitude).
    drop : callable
        Upper bound of 1 - mu_macro.
    """

    static: Callable
    static_needs_nu_0: bool
    large: Callable
    same_limit: Callable
    drop: Callable


def _limits(motion, same_limit):
    static, large = STATIC_LIMITS[motion], FORMS[motion]["mu_large_amplitude"]
    return Limits(
        static.function,
        not static.any_poisson,
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


def is_known(scene: str, pressure: str) -> bool:
    """Whether limits of a scene under a pressure are proved."""
    return pressure == "hertz" and (scene in LIMITS or scene == "continuous-bore")


def known_of(dataset: xr.Dataset) -> bool:
    """Whether limits are proved for what a dataset holds: for one contact, at a given velocity."""
    if not is_alone(dataset):
        return False
    return is_known(dataset.attrs["scene"], dataset.attrs.get("pressure", "hertz"))


def is_alone(dataset: xr.Dataset) -> bool:
    """Whether a dataset is of one contact that is moved at a velocity."""
    return not {"drive", "contacts"} & set(dataset.attrs)


class Edge(NamedTuple):
    """What is known at the edge of a map.

    Attributes
    ----------
    value, error : np.ndarray, shape (n,)
        Friction there, dimensionless.
    """

    value: np.ndarray
    error: np.ndarray


def slower(
    limits: Limits, edge: Edge, velocity: np.ndarray, amplitude: np.ndarray, slowest: float
) -> tuple:
    """Value and error for velocities from 0 to the slowest of a map, shape (n,) each.

    edge: at the slowest velocity and the same amplitudes.
    """
    static = limits.static(amplitude)
    high = np.maximum(edge.value + edge.error, static)
    share = (velocity / slowest) ** SLOW_EXPONENT
    return _within(static, high, static + share * (edge.value - static))


def faster(
    limits: Limits, edge: Edge, velocity: np.ndarray, amplitude: np.ndarray, fastest: float
) -> tuple:
    """... for velocities above the fastest of a map; the edge is NaN where nothing is known."""
    low = 1.0 - limits.drop(velocity, amplitude)
    low = np.clip(np.fmax(low, edge.value - edge.error), 0.0, 1.0)
    far = 1.0 - (1.0 - edge.value) * (fastest / velocity) ** 2
    return _within(low, np.ones_like(low), np.where(np.isnan(far), low, far))


def wider(
    limits: Limits,
    edge: Edge,
    distance: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    widest: float,
) -> tuple:
    """... for amplitudes above the largest of a map.

    edge: at the largest amplitude, at the velocity with the same limit; distance: see `distances`.
    """
    end = limits.large(velocity, amplitude)
    left = (edge.value - end) * widest / amplitude
    return np.clip(end + left, 0.0, 1.0), distance + np.abs(left) + edge.error


def distances(
    limits: Limits,
    nodes: np.ndarray,
    values: np.ndarray,
    errors: np.ndarray,
    velocity: np.ndarray,
    widest: float,
) -> np.ndarray:
    """Largest distance from the limit for large amplitudes within a decade of velocities, (n,).

    nodes, values, errors: the edge of a map at its largest amplitude, (m,); velocity: (n,).
    """
    if not velocity.size:
        return velocity  # the limit of the bore takes a while
    off = np.abs(values - limits.large(nodes, np.full_like(nodes, widest))) + errors
    away = np.abs(np.log10(np.clip(velocity, nodes[0], nodes[-1])[:, None] / nodes))
    near = (away <= 1.0) | (away == away.min(axis=1, keepdims=True))
    return np.where(near, off, 0.0).max(axis=1)


def narrower(limits: Limits, edge: Edge, amplitude: np.ndarray, narrowest: float) -> tuple:
    """... for amplitudes from 0 to the smallest of a map."""
    low = np.clip(edge.value - edge.error, 0.0, 1.0)
    guess = 1.0 - (1.0 - edge.value) * amplitude / narrowest
    return _within(low, np.ones_like(low), guess)


def within_the_balance(
    limits: Limits,
    value: np.ndarray,
    error: np.ndarray,
    velocity: np.ndarray,
    amplitude: np.ndarray,
) -> tuple:
    """Any value and error, no worse than the energy balance allows; NaN stays what it is."""
    low = np.maximum(1.0 - limits.drop(velocity, amplitude), 0.0)
    value = np.clip(value, low, 1.0)
    reach = np.maximum(1.0 - value, value - low) + ROUNDING
    return value, np.where(np.isnan(value), error, np.fmin(error, reach))


def _within(low, high, guess):
    """A guess brought into its bracket, and how far the bracket reaches from there."""
    value = np.clip(guess, low, high)
    return value, np.maximum(high - value, value - low) + ROUNDING
