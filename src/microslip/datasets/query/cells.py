"""Interpolation in the cells of a certified map."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query.answers import LOST
from microslip.datasets.query.interpolation import Axis, Table, lagrange
from microslip.foundation.errors import InputError
from microslip.sweeps.map_coordinates import MapCoordinates

EDGE = 97
"""Number of velocities at which friction is evaluated along the largest amplitude."""


def is_certified(dataset: xr.Dataset) -> bool:
    """Return True for the dataset of a certified map."""
    return certified_map.COORDINATES in dataset.attrs


def is_static(dataset: xr.Dataset) -> bool:
    """Return True for the dataset of a certified map of the static limit."""
    return is_certified(dataset) and "velocity" not in dataset.attrs.get("directions", "").split()


@dataclass(frozen=True, eq=False)
class CellTable:
    """Friction in the cells of a certified map, with the methods of interpolation.Table.

    Attributes
    ----------
    coordinates : MapCoordinates
        Scaled coordinates of the map.
    borders : numpy.ndarray, shape (k, directions, 2)
        Lower and upper ends of the cells, in scaled coordinates.
    nodes : numpy.ndarray, shape (k, 5, 5) or (k, 5, 5, 3)
        Friction at the nodes of each cell.  The axes are the cells, velocity and amplitude.
        Poisson's ratio is the last axis if it is a direction of the map.
    bounds : numpy.ndarray, shape (k,)
        Error bound for each cell.
    ratios : numpy.ndarray, shape (1,) or (2,)
        The only Poisson's ratio, or the smallest and the largest Poisson's ratio.
    poisson : float, optional
        Poisson's ratio at which the map is evaluated, if Poisson's ratio is a direction of the map.
    """

    coordinates: MapCoordinates
    borders: np.ndarray
    nodes: np.ndarray
    bounds: np.ndarray
    ratios: np.ndarray
    poisson: float = 0.0

    @cached_property
    def rows(self) -> Axis:
        """The range of the amplitude."""
        return Axis(np.array(self.coordinates.amplitude))

    @property
    def _velocity(self) -> tuple[float, ...]:
        """The range of the velocity; () for a static-limit map or a drift map."""
        coordinates = self.coordinates
        return coordinates.velocity if isinstance(coordinates, MapCoordinates) else ()

    @property
    def is_static(self) -> bool:
        """True for a map of the static limit, which has no direction of velocity."""
        return not self._velocity

    @cached_property
    def columns(self) -> Axis:
        """Logarithmically spaced velocities over the range of the map.  For a static limit, the
        only velocity is 0."""
        if not self._velocity:
            return Axis(np.zeros(1))
        slow, fast = self._velocity
        inner = np.geomspace(slow, fast, EDGE)[1:-1]
        return Axis(np.array([slow, *inner, fast]))

    @cached_property
    def last_row(self) -> tuple[np.ndarray, np.ndarray]:
        """Friction and its error bounds along the largest amplitude, shape (m,) each."""
        velocity = self.columns.values
        return self.at(np.full_like(velocity, self.rows.values[-1]), velocity)

    def at(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at amplitudes and velocities inside the map.

        The arrays have the shape (n,).  In a cell with an unknown node, the values are NaN and the
        error bounds are infinite.
        """
        place = [column, row] if self._velocity else [row]
        if self.coordinates.poisson:
            place.append(np.full(len(row), self.poisson))
        return self.at_scaled(self.coordinates.scaled(*place))

    def at_scaled(self, scaled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at scaled coordinates of the shape (n, directions)."""
        value, error = np.full(len(scaled), np.nan), np.full(len(scaled), np.inf)
        for (begin, end), nodes, bound in zip(
            self.borders.transpose(0, 2, 1), self.nodes, self.bounds, strict=True
        ):
            here = np.flatnonzero(((scaled >= begin) & (scaled <= end)).all(axis=1))
            if len(here):
                value[here] = _polynomial(nodes, (scaled[here] - begin) / (end - begin))
                error[here] = bound
        return value, np.where(np.isnan(value), np.inf, error)


def _polynomial(nodes: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """Evaluate the polynomial through equally spaced nodes.

    shares: relative positions in the cells, 0 to 1, shape (n, directions).  Returns shape (n,).
    """
    value = nodes[..., None]  # the axis of the points is the last one
    for share in shares.T:
        degree = len(value) - 1
        weights = lagrange(np.arange(degree + 1.0)[None], degree * share)
        # The terms are summed one by one, so that rounding at a point does not depend on the other
        # points.
        value = sum(w * part for w, part in zip(weights.T, value, strict=True))
    return value


Map = Table | CellTable
"""Friction over velocity and amplitude at one Poisson's ratio."""


def cells_of(dataset: xr.Dataset) -> CellTable:
    """Read the cells of a certified map.

    Raises InputError with the name of a missing variable.
    """
    coordinates = _coordinates_in(dataset)
    names = [certified_map.BORDERS[direction] for direction in coordinates.directions]
    names_needed = ("mu_macro", "mu_macro_error", "poisson", "cell_node", "cell_error")
    for name in (*names_needed, *sum(names, ())):
        if name not in dataset.variables:
            raise InputError(name, None, LOST)
    values = dataset["mu_macro"].values
    cell_nodes = dataset["cell_node"].values.astype(int)
    if cell_nodes.max() >= len(values):
        raise InputError("point", len(values), "allowed are all points of the dataset")
    borders = np.stack([[dataset[name].values for name in pair] for pair in names])
    nodes = values[cell_nodes].reshape(-1, *(n + 1 for n in coordinates.degrees))
    bounds, ratios = dataset["cell_error"].values, coordinates.poisson or dataset["poisson"].values
    return CellTable(coordinates, borders.transpose(2, 0, 1), nodes, bounds, np.atleast_1d(ratios))


def _coordinates_in(dataset: xr.Dataset) -> MapCoordinates:
    try:
        return certified_map.coordinates_in(dataset)
    except (KeyError, TypeError, ValueError):
        text = dataset.attrs[certified_map.COORDINATES]
        allowed = "is of another version; allowed: a certified map of this version: make it again"
        raise InputError(certified_map.COORDINATES, text, allowed) from None
