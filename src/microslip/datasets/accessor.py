"""The accessor `dataset.microslip`: friction between the points of a map, with an error bound."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from functools import partial
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from microslip.datasets.interpolation import COORDINATES, LOST, Axis, Grid, cells_of
from microslip.datasets.variables import ANCILLARY, variable
from microslip.foundation.errors import InputError

AXES = ("mass", "damping", "stiffness", "poisson", "amplitude", "velocity", "force")
"""Coordinates of maps, in the order of the dimensions of a result."""
SAME = 1e-12
"""Difference below which two coordinates count as equal."""
ALLOWED = "allowed is a finite number, or several"
ANY = "microslip.solve computes any"

Ranges = dict[str, tuple[float, float]]
"""Smallest and largest value of each axis."""
Interpolation = Callable[..., tuple[np.ndarray, np.ndarray]]
"""Function of points, one array of shape (n,) for each axis, that returns values and error bounds
of shape (n,)."""


class Map:
    """Friction, or the velocity under a force, between the points of a sweep's dataset.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep, or a selection or join of such datasets, in memory or in dask chunks.
    """

    def __init__(self, dataset: xr.Dataset):
        self._dataset = dataset

    def at(self, velocity: Any = None, amplitude: Any = None, **others: Any) -> xr.Dataset:
        """Interpolate friction and its error bound at any point of the map.

        On a regular map, the bound is the interpolation error plus the errors of the points, see
        datasets/interpolation.py.  In a certified map, each cell has its own bound.  Next to a
        point that did not converge, mu_macro is NaN and its bound is infinite.

        Parameters
        ----------
        velocity, amplitude, **others : number, sequence or DataArray
            Coordinates: one for each dimension of the map, such as `poisson` or `stiffness`.  A
            sequence becomes a dimension of the result; DataArrays broadcast by their dimensions.
            If an argument is in dask chunks, so is the result.

        Returns
        -------
        xarray.Dataset
            Variables mu_macro and mu_macro_error; velocity and velocity_error for a map over
            forces.

        Raises
        ------
        InputError
            If a coordinate is missing, is not a coordinate of the map or is outside its range, or
            if the dataset lacks a variable.  The message names the coordinate or the variable.
            Outside the range, `microslip.solve` computes any point.
        """
        requests = {"velocity": velocity, "amplitude": amplitude} | others
        requests = {one: value for one, value in requests.items() if value is not None}
        data = self._dataset
        name = "velocity" if "force" in data.coords else "mu_macro"
        for needed in (name, f"{name}_error"):
            if needed not in data.variables:
                raise InputError(needed, None, LOST)
        axes, function = (_of_cells if COORDINATES in data.attrs else _of_grid)(data, name)
        numbers = {n: float(c) for n, c in data.coords.items() if not c.ndim and n in AXES}
        ranges = axes | {one: (number, number) for one, number in numbers.items()}
        for one, value in requests.items():
            if one not in ranges:
                allowed = f"no coordinate of the map; allowed are {', '.join(ranges)}"
                raise InputError(one, value, allowed)
        for one, (low, high) in axes.items():
            if one not in requests:
                raise InputError(one, None, f"needed; the map has {low:g} to {high:g}")
        chosen = {one: _coordinate(one, requests[one]) for one in ranges if one in requests}
        value, error = xr.apply_ufunc(
            partial(_block, {one: ranges[one] for one in chosen}, len(axes), function),
            *chosen.values(),
            join="outer",
            dask="parallelized",
            keep_attrs=True,
            output_core_dims=[[], []],
            output_dtypes=[float, float],
        )
        if name == "mu_macro":
            value = value.clip(-1.0, 1.0)  # a polynomial can leave the range of friction
        about = {key: data[name].attrs.get(key) for key in ("long_name", "units")}
        value.attrs = {key: text for key, text in about.items() if text}
        value.attrs[ANCILLARY] = f"{name}_error"
        error.attrs = {"long_name": f"bound of the error of {name}", "units": "1"}
        answer = xr.Dataset({name: value, f"{name}_error": error})
        answer = answer.assign_coords(
            {n: variable((), number, n) for n, number in numbers.items() if n not in answer.coords}
        )
        kept = data.attrs.keys() & {"motion", "pressure"}
        return answer.assign_attrs({key: data.attrs[key] for key in sorted(kept)})


def _of_cells(dataset: xr.Dataset, name: str) -> tuple[Ranges, Interpolation]:
    """Ranges of the axes of a certified map, and its interpolation."""
    cells = cells_of(dataset)
    directions = cells.coordinates.directions
    axes = [axis for axis in AXES if axis in directions]

    def at(*points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return cells.at(*(points[axes.index(direction)] for direction in directions))

    return {axis: tuple(getattr(cells.coordinates, axis)) for axis in axes}, at


def _of_grid(dataset: xr.Dataset, name: str) -> tuple[Ranges, Interpolation]:
    """Ranges of the axes of a regular map, and its interpolation."""
    nodes = dataset[[name, f"{name}_error"]]
    if "converged" in dataset:
        nodes = nodes.where(dataset["converged"] == 1)  # a join fills gaps with NaN
    nodes = nodes.compute()
    dims = [dim for dim in AXES if dim in nodes.dims]
    for extra in nodes.dims:
        if extra not in dims:
            raise InputError(str(extra), nodes.sizes[extra], "entries; allowed is one: select it")
    for dim in dims:
        if dim not in nodes.coords or not nodes.sizes[dim]:
            raise InputError(dim, None, LOST)
    for one in (name, f"{name}_error", *dims):
        if dataset[one].dtype.kind not in "iuf":
            raise InputError(one, f"of type {dataset[one].dtype}", "allowed are numbers")
    for dim in dims:
        wrong = nodes[dim].values[~(np.isfinite(nodes[dim].values) & (nodes[dim].values >= 0.0))]
        if wrong.size:
            raise InputError(dim, float(wrong[0]), "in the dataset; allowed are numbers >= 0")
        if nodes.indexes[dim].has_duplicates:
            raise InputError(dim, "is there twice", "in the dataset; allowed is each value once")
    nodes = nodes.sortby(dims).transpose(*dims)
    values, errors = (nodes[one].values.astype(float) for one in (name, f"{name}_error"))
    if (wrong := errors[errors < 0.0]).size:
        raise InputError(
            f"{name}_error", float(wrong.min()), "in the dataset; allowed is 0 or more"
        )
    if name == "mu_macro" and (wrong := values[np.abs(values) > 1.0 + errors + SAME]).size:
        raise InputError(name, float(wrong[0]), "in the dataset; allowed is -1 to 1")
    axes = [nodes[dim].values.astype(float) for dim in dims]
    ranges = {dim: (float(axis[0]), float(axis[-1])) for dim, axis in zip(dims, axes, strict=True)}

    def grid(rows: slice = slice(None)) -> Grid:
        """Grid of some of the velocities."""
        parts = tuple(rows if dim == "velocity" else slice(None) for dim in dims)
        kept = (Axis(axis[part]) for axis, part in zip(axes, parts, strict=True))
        return Grid(tuple(kept), values[parts], errors[parts])

    place = dims.index("velocity") if "velocity" in dims else -1
    if place < 0 or axes[place][0] != 0.0 or len(axes[place]) < 2:
        return ranges, grid().at
    # The static limit is not interpolated: between it and the smallest velocity, friction rises
    # with the power 2/3 of the velocity.
    still, moving, slowest = grid(slice(1)), grid(slice(1, None)), axes[place][1]

    def at(*points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rests = points[place] == 0.0
        between = points[place][~rests & (points[place] < slowest)]
        if between.size:
            allowed = f"allowed is 0, or {slowest:g} to {ranges['velocity'][1]:g}"
            raise InputError("velocity", float(between[0]), f"{allowed}; {ANY}")
        value, error = np.empty(len(rests)), np.empty(len(rests))
        for part, chosen in ((still, rests), (moving, ~rests)):
            value[chosen], error[chosen] = part.at(*(one[chosen] for one in points))
        return value, error

    return ranges, at


def _coordinate(name: str, value: Any) -> xr.DataArray:
    """Convert an argument to a DataArray of finite numbers.  A sequence becomes the dimension
    `name`.  Values in dask chunks are checked when they are computed."""
    if isinstance(value, xr.DataArray) and value.chunks is not None:
        return value
    if hasattr(value, "units") and not isinstance(value, xr.DataArray):
        raise InputError(name, value, f"{ALLOWED}, without a unit")
    if np.ma.is_masked(value):
        raise InputError(name, value, f"{ALLOWED}, none of them masked")
    try:
        array = np.asarray(value)
        if array.dtype.kind == "O" and all(isinstance(one, Real | Decimal) for one in array.flat):
            array = array.astype(float)
        good = array.dtype.kind in "iuf" and bool(np.isfinite(array).all())
    except (TypeError, ValueError, OverflowError):
        good = False
    if not good:
        raise InputError(name, value, ALLOWED)
    if isinstance(value, xr.DataArray):
        return value.astype(float)
    if array.ndim > 1:
        raise InputError(name, value, f"allowed are {array.ndim} dimensions with names (DataArray)")
    array = array.astype(float)
    dims = (name,) * array.ndim
    return xr.DataArray(array, dims=dims, coords={name: (dims, array)})


def _block(
    ranges: Ranges, count: int, function: Interpolation, *parts: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Evaluate an interpolation at broadcast coordinates, after a check of their ranges.

    The first `count` coordinates belong to the axes of the map.
    """
    arrays = np.broadcast_arrays(*parts)
    points = []
    for (name, (low, high)), array in zip(ranges.items(), arrays, strict=True):
        outside = array[~((array >= low - SAME) & (array <= high + SAME))]
        if outside.size:
            allowed = f"allowed is {low:g} to {high:g}, the range of the map"
            allowed = allowed if high > low else f"allowed is {low:g}, the only one of the map"
            raise InputError(name, float(outside.flat[0]), f"{allowed}; {ANY}")
        points.append(np.clip(array.ravel().astype(float), low, high))
    value, error = function(*points[:count])
    return value.reshape(arrays[0].shape), error.reshape(arrays[0].shape)
