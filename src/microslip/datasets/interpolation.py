"""Interpolate a map by local polynomials, and estimate an error bound.

On a regular grid, values are interpolated along each axis by the cubic through the four nearest
nodes.  To estimate the error, the value at each node is also predicted from the neighbouring nodes,
by a cubic with twice the spacing.  The error bound of a cell is the largest difference between the
predicted and the computed values at the nodes of the cell's cubic polynomial.  For a smooth
function, the true error is a sixteenth of this bound.  At a kink, the true error and the bound are
about equal.  Near an unknown value, the interpolation is linear.  The difference between the values
at the two nodes then serves as the error.

In a certified map, each cell has its own polynomial and its own error bound.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from microslip.config.quantities import AXES
from microslip.foundation.errors import InputError
from microslip.sweeps.map_coordinates import MapCoordinates

NODES = 4
"""Number of nodes of a local cubic."""
COORDINATES = "map_coordinates"
"""Name of the attribute that contains the scaled coordinates of a certified map as JSON."""
CHECKSUM = "checksum"
"""Name of the variable that contains the checksums of the points of a regular map."""
CHECKSUMS = "checksums"
"""Name of the attribute that contains the checksums of the parts of a certified map."""
BORDERS = {
    "velocity": ("cell_left", "cell_right"),
    "amplitude": ("cell_low", "cell_high"),
    "poisson": ("cell_poisson_low", "cell_poisson_high"),
}
"""Names of the variables that contain the lower and the upper ends of the cells, keyed by
direction."""
NUMBERS = ("cell", "node", "point")
"""Dimensions of a certified map.  The coordinates along these dimensions are the indices of the
cells, nodes and points."""
PARTS = (*NUMBERS, "mu_macro", "cell_error", "cell_node", *sum(BORDERS.values(), ()), *AXES)
"""Variables of a certified map that have a checksum."""
SAME = 1e-12
"""Difference below which two coordinates count as equal."""
CHANGED = (
    "allowed is the computed map, a certified map as a whole: open it again with open_map, and "
    "apply operations other than a selection to the result of `at` (if the file itself has "
    "changed, delete it in results/data, and run the sweep again)"
)
ANY = "microslip.solve computes any"

Points = dict[str, np.ndarray]
"""Coordinates of n points, as one array of shape (n,) for each axis."""


@dataclass(frozen=True, eq=False)
class Axis:
    """One axis of a grid, with ascending coordinates.

    The axis is logarithmic if the ratios of neighbouring coordinates vary less than the differences
    of neighbouring coordinates.

    Attributes
    ----------
    values : numpy.ndarray
        Coordinates.
    static : int
        1 if the first coordinate is the velocity 0, else 0.  No values are interpolated between the
        static limit and the smallest velocity, because friction rises steeply there, as
        velocity^(2/3).
    """

    values: np.ndarray
    static: int = 0

    @cached_property
    def logarithmic(self) -> bool:
        values = self.values[self.static :]
        if len(values) < 3 or values[0] <= 0.0:
            return len(values) == 2 and 0.0 < 10.0 * values[0] < values[1]
        return _unevenness(np.log(values)) < _unevenness(values)

    @cached_property
    def nodes(self) -> np.ndarray:
        """Scaled coordinates of the values, except the value at the static limit."""
        return self.scaled(self.values[self.static :])

    def scaled(self, points: np.ndarray) -> np.ndarray:
        """Return the points, or their logarithms if the axis is logarithmic."""
        return np.log(points) if self.logarithmic else np.asarray(points, float)

    def cubics(self, points: np.ndarray, width: int = NODES) -> tuple[np.ndarray, ...]:
        """Return the weights of the local cubics at points.

        Parameters
        ----------
        points : numpy.ndarray, shape (n,)
            Points between the ends of the axis, or at the static limit.
        width : int
            Number of nodes, if there are so many; 2 for linear interpolation.

        Returns
        -------
        cell : numpy.ndarray, shape (n,)
            Index of the node below each point.
        share : numpy.ndarray, shape (n,)
            Position of each point in its cell, from 0 to 1.
        index, weights : numpy.ndarray, shape (n, k)
            Indices and weights of the k nodes of the cubic, with k at most `width`.
        """
        x, q = self.nodes, self.scaled(np.maximum(points, self.values[self.static]))
        count = len(x)
        width = min(width, count)
        cell = np.clip(np.searchsorted(x, q, side="right") - 1, 0, max(count - 2, 0))
        share = (q - x[cell]) / (x[cell + 1] - x[cell]) if count > 1 else np.zeros(len(q))
        first = np.clip(cell - (width // 2 - 1), 0, count - width)
        index = first[:, None] + np.arange(width)
        weights = lagrange(x[index], q)
        if self.static:
            rests = points == 0.0
            cell, index, share = cell + 1, index + 1, np.where(rests, 0.0, share)
            index[rests], weights[rests] = 0, np.arange(width) == 0
        if width == 2:  # at a node, its neighbour may be unknown
            index = np.where(weights == 0.0, index[:, ::-1], index)
        return cell, share, index, weights

    def misses(self, table: np.ndarray) -> np.ndarray:
        """For each node, return the absolute error of the cubic through the neighbouring nodes.

        The nodes are along the first axis of the table.  An end node is assigned the error of its
        neighbour.  If there are only two nodes, the error of both is the difference between their
        values.  At the static limit, the error is 0.
        """
        if self.static:
            moving = Axis(self.values[1:]).misses(table[1:])
            return np.concatenate((np.zeros_like(table[:1]), moving))
        x = self.nodes
        count = len(x)
        if count < 3:
            return np.broadcast_to(np.abs(table[-1] - table[0]), table.shape)
        out = np.empty(table.shape)
        for i in range(1, count - 1):
            others = np.delete(np.arange(count), i)
            near = np.sort(others[np.argsort(np.abs(others - i), kind="stable")[:NODES]])
            weights = lagrange(x[None, near], x[i : i + 1])[0]
            out[i] = np.abs(table[i] - np.tensordot(weights, table[near], 1))
        out[0], out[-1] = out[1], out[-2]
        return out


def _unevenness(values: np.ndarray) -> float:
    steps = np.diff(values)
    return steps.max() / steps.min()


def lagrange(nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the Lagrange weights for n points and k nodes, as an array of shape (n, k).

    nodes: array of shape (n, k), or (1, k) if all points have the same nodes.  points: array of
    shape (n,).
    """
    weights = np.ones((len(points), nodes.shape[1]))
    for own in range(nodes.shape[1]):
        for other in range(nodes.shape[1]):
            if other != own:
                gap = nodes[:, own] - nodes[:, other]
                weights[:, own] *= (points - nodes[:, other]) / gap
    return weights


def polynomial(nodes: np.ndarray, weights: Iterable[np.ndarray]) -> np.ndarray:
    """Return the weighted sum of the values at nodes, with weights along each axis.

    Terms are added one by one, so that the rounding error at a point does not depend on other
    points.

    nodes: values, as an array of shape (k, l, ..., n).  weights: arrays of shapes (n, k), (n, l),
    ...  The result has the shape (n,).
    """
    for one in weights:
        nodes = sum(weight * part for weight, part in zip(one.T, nodes, strict=True))
    return nodes


@dataclass(frozen=True, eq=False)
class Grid:
    """A regular grid with one or more axes, and the values and errors at its nodes.

    Attributes
    ----------
    axes : dict of str to Axis
        Axes of the grid by name.
    values, errors : np.ndarray, shape (n, m, ...)
        Values and error estimates, with one dimension for each axis.  Unknown values are NaN.
    """

    axes: dict[str, Axis]
    values: np.ndarray
    errors: np.ndarray

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each axis."""
        return {name: (float(x.values[0]), float(x.values[-1])) for name, x in self.axes.items()}

    @cached_property
    def _misses(self) -> list[np.ndarray]:
        """Errors of the cubics through neighbouring nodes along each axis (see Axis.misses)."""
        return [
            np.moveaxis(axis.misses(np.moveaxis(self.values, k, 0)), 0, k)
            for k, axis in enumerate(self.axes.values())
        ]

    def at(self, points: Points) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at n points inside the grid, as two arrays of shape (n,).

        Along an axis, the interpolation error is assumed to be proportional to the product of the
        distances to the two neighbouring nodes.  The bound is the sum of these errors over all
        axes, plus the largest error at the nodes.  If a value at one of the nodes is unknown, the
        interpolation between the neighbouring nodes is linear, with a larger bound.  If the value
        at a neighbouring node is unknown, the result is NaN and the bound is infinite.

        Raises InputError for a velocity between the static limit and the smallest velocity.
        """
        for name, axis in self.axes.items():
            slowest, own = axis.values[axis.static], points[name]
            if axis.static and (between := own[(own > 0.0) & (own < slowest)]).size:
                allowed = f"allowed is 0, or {slowest:g} to {axis.values[-1]:g}; {ANY}"
                raise InputError(name, float(between[0]), allowed)
        value, error = self._interpolated(points, NODES)
        if (gap := np.isnan(value + error)).any():
            beside = {name: own[gap] for name, own in points.items()}
            value[gap], error[gap] = self._interpolated(beside, 2)
        return value, np.where(np.isnan(value + error), np.inf, error)

    def _interpolated(self, points: Points, width: int) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate between `width` nodes along each axis.  If a value or an error is unknown,
        the result is NaN.

        For linear interpolation, the error halfway between two nodes is at most the difference
        between the values at the nodes, unless the function has an extremum between the nodes.
        """
        stencils = [axis.cubics(points[name], width) for name, axis in self.axes.items()]
        around = tuple(range(len(stencils)))
        near = tuple(  # indices of the nodes, shape (k, l, ..., n)
            np.expand_dims(index.T, [other for other in around if other != k])
            for k, (_, _, index, _) in enumerate(stencils)
        )
        values = self.values[near]
        value = polynomial(values, [weights for *_, weights in stencils])
        error = self.errors[near].max(axis=around)
        for k, (_, share, *_) in enumerate(stencils):
            missed = self._misses[k][near] if width > 2 else np.ptp(values, axis=k, keepdims=True)
            error = error + 4.0 * share * (1.0 - share) * missed.max(axis=around)
        return value, error


@dataclass(frozen=True, eq=False)
class Cells:
    """Friction in the cells of a certified map.

    Attributes
    ----------
    coordinates : MapCoordinates
        Scaled coordinates of the map.
    borders : numpy.ndarray, shape (k, directions, 2)
        Lower and upper ends of the cells, in scaled coordinates.
    nodes : numpy.ndarray, shape (k, 5, 5) or (k, 5, 5, 3)
        Friction at the nodes of each cell.  The first axis is the cell, and the other axes are the
        directions of the map.
    bounds : numpy.ndarray, shape (k,)
        Error bound for each cell.
    """

    coordinates: MapCoordinates
    borders: np.ndarray
    nodes: np.ndarray
    bounds: np.ndarray

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:
        """Smallest and largest value of each direction."""
        directions = [axis for axis in AXES if axis in self.coordinates.directions]
        return {axis: tuple(getattr(self.coordinates, axis)) for axis in directions}

    def at(self, points: Points) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at n points inside the map, as two arrays of shape (n,).

        In a cell with an unknown node, the values are NaN and the error bounds are infinite.
        """
        directions = self.coordinates.directions
        scaled = self.coordinates.scaled(*(points[direction] for direction in directions))
        begin, end = self.borders.transpose(2, 0, 1)
        inside = ((scaled[:, None] >= begin) & (scaled[:, None] <= end)).all(axis=2)
        cell = inside.shape[1] - 1 - inside[:, ::-1].argmax(axis=1)  # the last one on a border
        counts = self.nodes.shape[1:]
        shares = np.subtract(counts, 1) * ((scaled - begin[cell]) / (end[cell] - begin[cell]))
        weights = [lagrange(np.arange(n)[None], x) for n, x in zip(counts, shares.T, strict=True)]
        value = polynomial(np.moveaxis(self.nodes[cell], 0, -1), weights)
        return value, np.where(np.isnan(value), np.inf, self.bounds[cell])


def of_map(dataset: xr.Dataset, name: str) -> Grid | Cells:
    """Return the interpolation of a variable in a certified or regular map."""
    is_certified = COORDINATES in dataset.attrs or not dataset.sizes.keys().isdisjoint(NUMBERS)
    return cells_of(dataset) if is_certified else grid_of(dataset, name)


def parts_of(dataset: xr.Dataset) -> tuple[dict[str, np.ndarray], dict[str, str]]:
    """Return the parts of a certified map, and the checksums of the parts and of the scaled
    coordinates.  The parts are flat arrays, ordered by the indices of cells, nodes and points.

    A checksum is computed from the values in single precision, so the type of the numbers has no
    effect.
    """
    names = [name for name in PARTS if name in dataset.variables]
    numbers = [name for name in NUMBERS if name in dataset.dims]
    ordered = dataset[names].sortby(numbers).transpose(*numbers, ...)
    parts = {name: ordered[name].values.ravel() for name in names}
    contents = {COORDINATES: str(dataset.attrs.get(COORDINATES)).encode()}
    for name, part in parts.items():
        contents[name] = part.astype("<f4").tobytes() if part.dtype.kind in "iuf" else b""
    return parts, {name: f"{zlib.crc32(content):08x}" for name, content in contents.items()}


def cells_of(dataset: xr.Dataset) -> Cells:
    """Read the cells of a certified map.

    If a part is missing or has changed, raises InputError with the name of the part.
    """
    parts, checksums = parts_of(dataset)
    # without the attribute, the word CHECKSUMS stands for the missing part
    words = str(dataset.attrs.get(CHECKSUMS, CHECKSUMS)).split()
    original = {name: checksum for name, _, checksum in (word.partition(":") for word in words)}
    for name, checksum in (original | checksums).items():
        is_lost = name not in checksums and name not in AXES
        if is_lost or original.get(name) != checksum:
            raise InputError(name, None if is_lost else "changed", CHANGED)
    coordinates = MapCoordinates.from_json(dataset.attrs[COORDINATES])
    borders = np.array([[parts[n] for n in BORDERS[d]] for d in coordinates.directions], float)
    nodes = parts["mu_macro"].astype(float)[parts["cell_node"].astype(int)]
    nodes = nodes.reshape(-1, *np.array(coordinates.degrees) + 1)
    return Cells(coordinates, borders.transpose(2, 0, 1), nodes, parts["cell_error"].astype(float))


def checksums(
    axes: Iterable[ArrayLike], value: np.ndarray, error: np.ndarray, scene: str
) -> np.ndarray:
    """Return the checksums of the points of a regular map, as a flat array.

    The checksum of a point is the CRC-32 of the scene and of numbers: the coordinates, the value
    and the error of the value.  The numbers are little-endian and have double precision.

    Parameters
    ----------
    axes : iterable of array_like
        Coordinates along each dimension, and constant coordinates, in the order of AXES.
    value, error : numpy.ndarray
        Values and errors at the points.  The last coordinate changes fastest.
    scene : str
        Motion and pressure.
    """
    places = np.meshgrid(*axes, indexing="ij")
    table = np.column_stack([one.ravel() for one in (*places, value, error)]).astype("<f8")
    first = zlib.crc32(scene.encode())
    codes = [zlib.crc32(row.tobytes(), first) for row in table]
    return np.array(codes, np.uint32).view(np.int32)


def scene_of(attributes: Mapping[str, Any]) -> str:
    """Return the motion and the pressure of a map, for `checksums`."""
    return " ".join(str(attributes.get(one)) for one in ("motion", "pressure"))


def grid_of(dataset: xr.Dataset, name: str) -> Grid:
    """Read a variable of a regular map as a `Grid`.  Points that did not converge, whose checksum
    is 0, count as unknown.

    Raises InputError with the name of the variable or coordinate that is missing or not allowed, or
    if a known value is not that of a computed point.
    """
    names = [name, f"{name}_error", CHECKSUM]
    nodes = dataset[[one for one in names if one in dataset.variables]]
    dims = [dim for dim in AXES if dim in nodes.dims]
    for one in (*dims, *names, "poisson", "velocity" if name == "mu_macro" else "force"):
        if one not in nodes.variables or not nodes[one].size:
            needed = f"needed: select {', '.join(names)} and keep all coordinates of the map"
            raise InputError(one, None, needed)
        if nodes[one].dtype.kind not in "iuf":
            raise InputError(one, f"of type {nodes[one].dtype}", "allowed are numbers")
    for dim in nodes.dims:
        if dim not in dims:
            allowed = (
                "allowed is one entry of a dimension that is no coordinate of a map: select it"
            )
            raise InputError(str(dim), nodes.sizes[dim], allowed)
        index = nodes[dim].to_index()
        for one in index[index.duplicated()]:
            raise InputError(dim, one, "occurs twice; allowed: once")
    for one in nodes.coords.keys() & set(AXES) - {*dims, name}:
        if nodes[one].ndim:
            raise InputError(one, "several", f"allowed along {nodes[one].dims[0]} is one value")
    if not dims:  # a single point
        dims = ["force" if name == "velocity" else "velocity"]
        nodes = nodes.expand_dims(dims)
    nodes = nodes.compute().sortby(dims).transpose(*dims)
    value, error, original = (nodes[one].values for one in names)
    value = np.where(original == 0, np.nan, value)
    coordinates = [nodes[one] for one in AXES if one in nodes.coords and one != name]
    has_changed = checksums(coordinates, value, error, scene_of(nodes.attrs)) != original.ravel()
    for one in value.ravel()[has_changed & ~np.isnan(value.ravel())]:
        raise InputError(
            name, float(one), f"not computed for this motion at its coordinates; {CHANGED}"
        )
    axes = {}
    for dim in dims:
        values = nodes[dim].values.astype(float)
        axes[dim] = Axis(values, int(dim == "velocity" and len(values) > 1 and values[0] == 0.0))
    return Grid(axes, value.astype(float), error.astype(float))
