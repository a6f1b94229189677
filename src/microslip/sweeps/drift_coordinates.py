"""Coordinates in which the velocity under a force is even: from the threshold to the largest force.

Below the static limit of its amplitude a contact stays where it is, which needs no map.  From there
on it drifts, about as the power 3/2 of what the force is above that threshold, as friction comes
close to its static limit about as the power 2/3 of the velocity, and at the force 1 it runs away,
as the power -1/2 of what the force is below 1 if it is rigid.  So forces are even in t, where
tanh(t)^2 is their share of the way from the threshold to 1, and amplitudes gather where the
threshold comes down to the largest force and where it is gone.  Where the velocity is large, what
counts is its share: cells interpolate its area hyperbolic sine, whose error is that of the velocity
where this is small, and its relative error where it is large.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.sweeps.map_coordinates import Box, MapCoordinates, rounded
from microslip.theory.drift_threshold import first_amplitude, threshold
from microslip.theory.kinks import Kinks, kinks_of


class DriftCoordinates(NamedTuple):
    """The range of a map of drift, and where it is cut; all dimensionless.

    Attributes
    ----------
    motion : str
        Whose static limit is the threshold.
    force : float
        The largest one, below 1.
    amplitude : tuple of float
        Smallest and largest, >= 0; the map begins where a force of its range moves the contact.
    """

    motion: str
    force: float
    amplitude: tuple[float, float]

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the quantities that the map is over, in the order of scaled coordinates."""
        return "force", "amplitude"

    @property
    def degrees(self) -> tuple[int, ...]:
        """Degrees of the polynomials in a cell, by direction."""
        return 4, 4

    @property
    def poisson(self) -> tuple[float, ...]:
        """Poisson's ratio is no direction of such a map."""
        return ()

    @property
    def patches(self) -> list[Box]:
        """Boxes in scaled coordinates that cover the map."""
        return [((0.0, *low), (1.0, *high)) for low, high in self._rows.patches]

    @classmethod
    def from_json(cls, text: str) -> DriftCoordinates:
        """The coordinates from a text that `to_json` made."""
        given = json.loads(text)
        return cls(given["motion"], given["force"], tuple(given["amplitude"]))

    def to_json(self) -> str:
        """The coordinates as a text, for the attribute of a dataset."""
        return canonical_json(self._asdict())

    def scaled(
        self, force: np.ndarray, amplitude: np.ndarray, least: np.ndarray | None = None
    ) -> np.ndarray:
        """Scaled coordinates, shape (n, 2), of places that drift, in the range, shape (n,) each.

        least: the threshold at these amplitudes, where it is known already; it takes a while.
        """
        force, amplitude = (np.asarray(part, float) for part in (force, amplitude))
        known = threshold(self.motion, amplitude) if least is None else least
        ends = _stretched(self.force, known)
        share = np.clip(_stretched(force, known) / np.where(ends > 0.0, ends, 1.0), 0.0, 1.0)
        return np.column_stack([share, self._rows.scaled(amplitude)])

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Force and amplitude at scaled coordinates."""
        share, row = node
        (amplitude,) = self._rows.place((row,))
        least = min(float(threshold(self.motion, amplitude)), self.force)
        stretched = share * _stretched(self.force, least)
        force = least + (1.0 - least) * float(np.tanh(stretched)) ** 2
        return rounded(self.force if share == 1.0 else force), amplitude

    @property
    def _rows(self) -> MapCoordinates:
        """The amplitudes, cut as in a map of the static limit."""
        low, high = self.amplitude
        first = first_amplitude(self.motion, self.force)
        kinks = kinks_of(self.motion).amplitudes
        if first <= low:
            return MapCoordinates((), (low, high), Kinks(kinks))
        return MapCoordinates((), (rounded(first), high), Kinks((rounded(first), *kinks)))


def _stretched(force: np.ndarray | float, least: np.ndarray | float) -> np.ndarray:
    """0 at the threshold, infinite at 1."""
    return np.arctanh(np.sqrt(np.clip((force - least) / (1.0 - least), 0.0, 1.0)))


def scaled_velocity(velocity: float, error: float) -> tuple[float, float]:
    """The values that a map of drift interpolates: asinh of the velocity, and its error bound."""
    low, middle, high = np.arcsinh([velocity - error, velocity, velocity + error]).tolist()
    return middle, max(high - middle, middle - low)


def velocity_of(scaled: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The inverse, of arrays: velocities, which are not below 0, and bounds of their errors,
    infinite where a velocity is not known."""
    velocity = np.sinh(np.maximum(scaled, 0.0))
    low = np.sinh(np.maximum(scaled - error, 0.0))
    with np.errstate(over="ignore"):
        high = np.sinh(scaled + error)
    error = np.maximum(high - velocity, velocity - low)
    return velocity, np.where(np.isnan(velocity), np.inf, error)
