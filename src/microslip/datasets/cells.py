"""Interpolation in the cells of a certified map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from microslip.datasets import certified_map
from microslip.datasets.interpolation import lagrange
from microslip.foundation.errors import InputError
from microslip.sweeps.map_coordinates import MapCoordinates

LOST = "microslip.at needs it, and the dataset has lost it: keep it"


def is_certified(dataset: xr.Dataset) -> bool:
    """Return True for the dataset of a certified map."""
    return certified_map.COORDINATES in dataset.attrs


@dataclass(frozen=True, eq=False)
class CellTable:
    """Friction in the cells of a certified map.

    Attributes
    ----------
    coordinates : MapCoordinates
        Scaled coordinates of the map.
    borders : numpy.ndarray, shape (k, directions, 2)
        Lower and upper ends of the cells, in scaled coordinates.
    nodes : numpy.ndarray, shape (k, 5, 5) or (k, 5, 5, 3)
        Friction at the nodes of each cell.  The axes are the cells, and the directions of the map.
    bounds : numpy.ndarray, shape (k,)
        Error bound for each cell.
    """

    coordinates: MapCoordinates
    borders: np.ndarray
    nodes: np.ndarray
    bounds: np.ndarray

    def at(self, *place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at points inside the map, shape (n,) each.

        In a cell with an unknown node, the values are NaN and the error bounds are infinite.

        place: coordinates of the points, one array of shape (n,) for each direction.
        """
        scaled = self.coordinates.scaled(*place)
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


def cells_of(dataset: xr.Dataset) -> CellTable:
    """Read the cells of a certified map.

    Raises InputError with the name of a missing variable.
    """
    try:
        coordinates = certified_map.coordinates_in(dataset)
    except (KeyError, TypeError, ValueError):
        text = dataset.attrs[certified_map.COORDINATES]
        allowed = "is of another version; allowed: a certified map of this version: make it again"
        raise InputError(certified_map.COORDINATES, text, allowed) from None
    names = [certified_map.BORDERS[direction] for direction in coordinates.directions]
    for name in ("mu_macro", "mu_macro_error", "cell_node", "cell_error", *sum(names, ())):
        if name not in dataset.variables:
            raise InputError(name, None, LOST)
    values, cell_nodes = dataset["mu_macro"].values, dataset["cell_node"].values.astype(int)
    if cell_nodes.max() >= len(values):
        raise InputError("point", len(values), "allowed are all points of the dataset")
    borders = np.stack([[dataset[name].values for name in pair] for pair in names])
    nodes = values[cell_nodes].reshape(-1, *(n + 1 for n in coordinates.degrees))
    return CellTable(coordinates, borders.transpose(2, 0, 1), nodes, dataset["cell_error"].values)
