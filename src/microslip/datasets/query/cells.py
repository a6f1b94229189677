"""Answers from the cells of a certified map, in the shape in which a map of nodes gives them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.query.answers import LOST
from microslip.datasets.query.interpolation import Axis, Table, lagrange
from microslip.foundation.errors import InputError
from microslip.sweeps.drift_coordinates import DriftCoordinates
from microslip.sweeps.map_coordinates import MapCoordinates

EDGE = 97
"""Velocities at which the edge of a map is looked at, for what lies beyond it."""


def is_certified(dataset: xr.Dataset) -> bool:
    """Whether a dataset is one of a certified map."""
    return certified_map.COORDINATES in dataset.attrs


def is_static(dataset: xr.Dataset) -> bool:
    """Whether a dataset is a certified map of the static limit."""
    return is_certified(dataset) and "velocity" not in dataset.attrs.get("directions", "").split()


@dataclass(frozen=True, eq=False)
class CellTable:
    """Friction in the cells of a map: what interpolation.Table is for a map of nodes.

    Attributes
    ----------
    coordinates : MapCoordinates or DriftCoordinates
    borders : numpy.ndarray, shape (k, directions, 2)
        Where cells begin and end, scaled.
    nodes : numpy.ndarray, shape (k, 5, 5) or (k, 5, 5, 3)
        Friction at their nodes, over velocity, amplitude and perhaps Poisson's ratio; asinh of the
        velocity of drift.
    bounds : numpy.ndarray, shape (k,)
        Bound of the error in each cell.
    poisson : float, optional
        Poisson's ratio at which a map over Poisson's ratio is evaluated.
    """

    coordinates: MapCoordinates | DriftCoordinates
    borders: np.ndarray
    nodes: np.ndarray
    bounds: np.ndarray
    poisson: float = 0.0

    @cached_property
    def rows(self) -> Axis:
        """The range of the amplitude."""
        return Axis(np.array(self.coordinates.amplitude))

    @property
    def _velocity(self) -> tuple[float, ...]:
        """The range of the velocity; () for a map of the static limit or of drift."""
        coordinates = self.coordinates
        return coordinates.velocity if isinstance(coordinates, MapCoordinates) else ()

    @property
    def is_static(self) -> bool:
        """Whether the map is of the static limit, where the velocity is no direction."""
        return not self._velocity

    @cached_property
    def columns(self) -> Axis:
        """The range of the velocity, in even ratios; 0 alone of the static limit."""
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
        """Values and bounds of their errors at points inside, amplitudes and velocities of shape
        (n,) each; NaN and infinity where a point that counts is not known."""
        place = [column, row] if self._velocity else [row]
        if self.coordinates.poisson:
            place.append(np.full(len(row), self.poisson))
        return self.at_scaled(self.coordinates.scaled(*place))

    def at_scaled(self, scaled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and bounds of their errors at scaled coordinates, shape (n, directions)."""
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
    """Values (n,) of the polynomial through equally spaced nodes at shares (n, directions)."""
    value = nodes[..., None]  # the points run last
    for share in shares.T:
        degree = len(value) - 1
        weights = lagrange(np.arange(degree + 1.0)[None], degree * share)
        # Term by term, so that the bits of a point do not depend on the other points.
        value = sum(w * part for w, part in zip(weights.T, value, strict=True))
    return value


Map = Table | CellTable
"""Friction over velocity and amplitude at one Poisson's ratio."""


@dataclass(frozen=True, eq=False)
class CellNodes:
    """The points of a certified map; what nodes.Nodes is for a map of nodes.

    Attributes
    ----------
    poisson : numpy.ndarray, shape (1,) or (2,)
        The only one, or the smallest and the largest.
    values, errors : numpy.ndarray, shape (n,)
        mu_macro at the points and the bounds of its error; NaN and infinite: not known.
    cells : CellTable
    """

    poisson: np.ndarray
    values: np.ndarray
    errors: np.ndarray
    cells: CellTable

    def table(self, poisson: float, *, still: bool = False) -> CellTable | None:
        """The map for a Poisson's ratio above velocity 0, or of that alone; None: there is none."""
        if still != self.cells.is_static:
            return None
        return replace(self.cells, poisson=poisson)


def cells_of(dataset: xr.Dataset) -> CellNodes:
    """The map in the dataset of a certified map; raises InputError for what it has lost."""
    coordinates = _coordinates_in(dataset)
    names = [certified_map.BORDERS[direction] for direction in coordinates.directions]
    drifts = certified_map.is_of_drift(dataset)
    solved = ("velocity", "velocity_error") if drifts else ("mu_macro", "mu_macro_error")
    wanted = (*solved, "poisson", "cell_node", "cell_error")
    for name in (*wanted, *sum(names, ())):
        if name not in dataset.variables:
            raise InputError(name, None, LOST)
    values, errors = (dataset[name].values for name in solved)
    picked = dataset["cell_node"].values.astype(int)
    if picked.max() >= len(values):
        raise InputError("point", len(values), "an answer needs all points of the dataset")
    borders = np.stack([[dataset[name].values for name in pair] for pair in names])
    interpolated = np.arcsinh(values) if drifts else values
    nodes = interpolated[picked].reshape(-1, *(n + 1 for n in coordinates.degrees))
    bounds = dataset["cell_error"].values
    cells = CellTable(coordinates, borders.transpose(2, 0, 1), nodes, bounds)
    poisson = coordinates.poisson or np.atleast_1d(dataset["poisson"].values)
    return CellNodes(np.array(poisson), values, errors, cells)


def _coordinates_in(dataset: xr.Dataset) -> MapCoordinates | DriftCoordinates:
    try:
        return certified_map.coordinates_in(dataset)
    except (KeyError, TypeError, ValueError):
        given = dataset.attrs[certified_map.COORDINATES]
        allowed = "is none of this version's; allowed: a certified map that it made: make it again"
        raise InputError(certified_map.COORDINATES, given, allowed) from None
