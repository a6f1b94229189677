"""Answers from the cells of a certified map, in the shape in which a map of nodes gives them."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query.interpolation import Axis
from microslip.foundation.errors import InputError
from microslip.sweeps.map_cells import DEGREE
from microslip.sweeps.map_coordinates import MapCoordinates

EDGE = 97
"""Velocities at which the edge of a map is looked at, for what lies beyond it."""


def is_certified(dataset: xr.Dataset) -> bool:
    """Whether a dataset is one of a certified map."""
    return certified_map.COORDINATES in dataset.attrs


@dataclass(frozen=True, eq=False)
class CellTable:
    """Friction in the cells of a map: what interpolation.Table is for a map of nodes.

    Attributes
    ----------
    coordinates : MapCoordinates
    borders : numpy.ndarray, shape (k, 4)
        Cells: left, right, low and high, scaled.
    nodes : numpy.ndarray, shape (k, 5, 5)
        Friction at their nodes, over velocity and amplitude.
    bounds : numpy.ndarray, shape (k,)
        Of the error in each.
    """

    coordinates: MapCoordinates
    borders: np.ndarray
    nodes: np.ndarray
    bounds: np.ndarray

    @cached_property
    def rows(self) -> Axis:
        """The range of the amplitude."""
        return Axis(np.array(self.coordinates.amplitude))

    @cached_property
    def columns(self) -> Axis:
        """The range of the velocity, in even ratios."""
        slow, fast = self.coordinates.velocity
        inner = np.geomspace(slow, fast, EDGE)[1:-1]
        return Axis(np.array([slow, *inner, fast]))

    @cached_property
    def _edges(self):
        velocity = self.columns.values
        found = [self.at(np.full_like(velocity, a), velocity) for a in self.rows.values]
        return tuple(np.array(part) for part in zip(*found, strict=True))

    @property
    def values(self) -> np.ndarray:
        """Friction along the smallest and the largest amplitude, shape (2, m)."""
        return self._edges[0]

    @property
    def errors(self) -> np.ndarray:
        """Bounds of the errors of `values`."""
        return self._edges[1]

    def at(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and bounds of their errors at points inside, amplitudes and velocities of shape
        (n,) each; NaN and infinity where a point that counts is not known."""
        x, y = self.coordinates.scaled(column, row)
        most = self.coordinates.patches
        x, y = np.clip(x, 0.0, most[0]), np.clip(y, 0.0, most[1])
        value, error = np.full(len(x), np.nan), np.full(len(x), np.inf)
        for border, nodes, bound in zip(self.borders, self.nodes, self.bounds, strict=True):
            left, right, low, high = border
            here = np.flatnonzero((x >= left) & (x <= right) & (y >= low) & (y <= high))
            if len(here):
                across = _weights((x[here] - left) / (right - left))
                along = _weights((y[here] - low) / (high - low))
                value[here] = np.einsum("in,jn,ij->n", across, along, nodes)
                error[here] = bound
        return value, np.where(np.isnan(value), np.inf, error)


def _weights(share):
    """Weights (5, n) of equally spaced values for the polynomial through them, at shares (n,)."""
    steps = DEGREE * share
    weights = np.ones((DEGREE + 1, len(share)))
    for own in range(DEGREE + 1):
        for other in range(DEGREE + 1):
            if other != own:
                weights[own] *= (steps - other) / (own - other)
    return weights


@dataclass(frozen=True, eq=False)
class CellNodes:
    """The points of a certified map; what nodes.Nodes is for a map of nodes.

    Attributes
    ----------
    poisson : numpy.ndarray, shape (1,)
    values, errors : numpy.ndarray, shape (n,)
        mu_macro at the points and the bounds of its error; NaN and infinite: not known.
    cells : CellTable
    """

    poisson: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    cells: CellTable

    @property
    def fingerprint(self) -> bytes:
        """What tells this map from others."""
        parts = self.poisson, self.cells.borders, self.cells.nodes, self.cells.bounds
        said = self.cells.coordinates.to_json().encode()
        return hashlib.sha256(b"|".join([said, *(part.tobytes() for part in parts)])).digest()

    def table(self, poisson: float, *, still: bool = False) -> CellTable | None:
        """The map above velocity 0; None: there is none at velocity 0."""
        return None if still else self.cells


def cells_of(dataset: xr.Dataset) -> CellNodes:
    """The map in the dataset of a certified map; raises InputError for what it has lost."""
    wanted = ("mu_macro", "mu_macro_error", "poisson", "cell_node", "cell_error")
    for name in (*wanted, *certified_map.BORDERS):
        if name not in dataset.variables:
            allowed = "friction.at needs it, and the dataset has lost it: keep it"
            raise InputError(name, None, allowed)
    values, errors = (dataset[name].values for name in ("mu_macro", "mu_macro_error"))
    picked = dataset["cell_node"].values.astype(int)
    if picked.max() >= len(values):
        raise InputError("point", len(values), "friction.at needs all points of the dataset")
    borders = np.stack([dataset[name].values for name in certified_map.BORDERS], axis=1)
    nodes = values[picked].reshape(-1, DEGREE + 1, DEGREE + 1)
    cells = CellTable(
        certified_map.coordinates_in(dataset), borders, nodes, dataset["cell_error"].values
    )
    return CellNodes(np.atleast_1d(dataset["poisson"].values), values, errors, cells)
