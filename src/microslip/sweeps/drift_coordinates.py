"""Scaled coordinates of a map of drift: force and amplitude.

The force threshold is the static limit at the amplitude.  Below the threshold, a contact does not
drift and no map is needed.  Above it, the drift velocity is approximately proportional to (force -
threshold)^(3/2), because friction approaches its static limit in proportion to velocity^(2/3).  The
velocity becomes infinite as the force approaches 1.  Near a force of 1, the velocity of a rigid
contact is proportional to (1 - force)^(-1/2).

The scaled force t is therefore defined by tanh(t)^2 = (force - threshold) / (1 - threshold).  Nodes
are clustered at two amplitudes: where the threshold equals the largest force, and where it
vanishes.  Cells interpolate asinh(velocity).  The error of asinh equals the absolute error for
small velocities and the relative error for large ones.
"""

from __future__ import annotations

import json
from typing import NamedTuple

import numpy as np

from microslip.foundation.canonical import canonical_json
from microslip.sweeps.map_coordinates import Box, MapCoordinates, round_digits
from microslip.theory.drift_threshold import first_amplitude, threshold
from microslip.theory.kinks import Kinks, kinks_of


class DriftCoordinates(NamedTuple):
    """Range and patches of a map of drift.  All values are dimensionless.

    Attributes
    ----------
    motion : str
        Motion of the contact.  Its static limit is the force threshold.
    force : float
        Largest force, below 1.
    amplitude : tuple of float
        Smallest and largest amplitude, at least 0.  The map begins at the amplitude above which the
        largest force moves the contact.
    """

    motion: str
    force: float
    amplitude: tuple[float, float]

    @property
    def directions(self) -> tuple[str, ...]:
        """Names of the map's axes, in the order of scaled coordinates."""
        return "force", "amplitude"

    @property
    def degrees(self) -> tuple[int, ...]:
        """Degrees of the polynomials in a cell, by direction."""
        return 4, 4

    @property
    def poisson(self) -> tuple[float, ...]:
        """Empty, because Poisson's ratio is not a direction of drift maps."""
        return ()

    @property
    def patches(self) -> list[Box]:
        """Boxes in scaled coordinates that cover the map."""
        return [((0.0, *low), (1.0, *high)) for low, high in self._rows.patches]

    @classmethod
    def from_json(cls, text: str) -> DriftCoordinates:
        """Read the coordinates from the JSON text of `to_json`."""
        values = json.loads(text)
        return cls(values["motion"], values["force"], tuple(values["amplitude"]))

    def to_json(self) -> str:
        """Return the coordinates as JSON text for the attribute of a dataset."""
        return canonical_json(self._asdict())

    def scaled(
        self, force: np.ndarray, amplitude: np.ndarray, least: np.ndarray | None = None
    ) -> np.ndarray:
        """Scaled coordinates, shape (n, 2), for forces and amplitudes in the range, shape (n,)
        each.

        least: force thresholds at the amplitudes.  If None, the thresholds are computed, which is
        slow.
        """
        force, amplitude = (np.asarray(part, float) for part in (force, amplitude))
        thresholds = threshold(self.motion, amplitude) if least is None else least
        ends = _stretched(self.force, thresholds)
        share = np.clip(_stretched(force, thresholds) / np.where(ends > 0.0, ends, 1.0), 0.0, 1.0)
        return np.column_stack([share, self._rows.scaled(amplitude)])

    def place(self, node: tuple[float, ...]) -> tuple[float, ...]:
        """Return the force and amplitude at scaled coordinates."""
        share, row = node
        (amplitude,) = self._rows.place((row,))
        least = min(float(threshold(self.motion, amplitude)), self.force)
        stretched = share * _stretched(self.force, least)
        force = least + (1.0 - least) * float(np.tanh(stretched)) ** 2
        return round_digits(self.force if share == 1.0 else force), amplitude

    @property
    def _rows(self) -> MapCoordinates:
        """Coordinates of the amplitude, equal to those in a map of the static limit."""
        low, high = self.amplitude
        first = first_amplitude(self.motion, self.force)
        kinks = kinks_of(self.motion).amplitudes
        if first <= low:
            return MapCoordinates((), (low, high), Kinks(kinks))
        return MapCoordinates((), (round_digits(first), high), Kinks((round_digits(first), *kinks)))


def _stretched(force: np.ndarray | float, least: np.ndarray | float) -> np.ndarray:
    """Scaled force t, which is 0 at the threshold and infinite at a force of 1."""
    return np.arctanh(np.sqrt(np.clip((force - least) / (1.0 - least), 0.0, 1.0)))


def scaled_velocity(velocity: float, error: float) -> tuple[float, float]:
    """Return asinh(velocity) and its error bound.  A map of drift interpolates this value."""
    low, middle, high = np.arcsinh([velocity - error, velocity, velocity + error]).tolist()
    return middle, max(high - middle, middle - low)


def velocity_of(scaled: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Convert arrays of asinh(velocity) and its errors to velocities >= 0 and their error bounds.

    The error bound of an unknown velocity is infinite.
    """
    velocity = np.sinh(np.maximum(scaled, 0.0))
    low = np.sinh(np.maximum(scaled - error, 0.0))
    with np.errstate(over="ignore"):
        high = np.sinh(scaled + error)
    error = np.maximum(high - velocity, velocity - low)
    return velocity, np.where(np.isnan(velocity), np.inf, error)
