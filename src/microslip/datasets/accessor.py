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
Points = dict[str, np.ndarray]
"""Coordinates of points, an array of shape (n,) for each axis."""
Interpolation = Callable[[Points], tuple[np.ndarray, np.ndarray]]
"""Function that returns values and error bounds of points, shape (n,) each."""
BLOCK = 2**14
"""Number of points that are interpolated at once.  It limits the memory."""


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
            partial(_block, {one: ranges[one] for one in chosen}, function),
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
    coordinates = cells.coordinates
    axes = [axis for axis in AXES if axis in coordinates.directions]
    ranges = {axis: tuple(getattr(coordinates, axis)) for axis in axes}
    return ranges, lambda points: cells.at(*(points[axis] for axis in coordinates.directions))


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
        if nodes.indexes[dim].has_duplicates:
            raise InputError(dim, "is there twice", "in the dataset; allowed is each value once")
    for one in (name, f"{name}_error", *dims):
        if dataset[one].dtype.kind not in "iuf":
            raise InputError(one, f"of type {dataset[one].dtype}", "allowed are numbers")
    value, error = nodes[name], nodes[f"{name}_error"]
    most = 1.0 + error + SAME if name == "mu_macro" else np.inf
    wrong = {dim: (~(nodes[dim] < np.inf) | (nodes[dim] < 0.0), "are numbers >= 0") for dim in dims}
    wrong |= {error.name: (error < 0.0, "is 0 or more"), name: (abs(value) > most, "is -1 to 1")}
    for one, (bad, allowed) in wrong.items():
        if bad.any():
            first = float(nodes[one].values[bad.values][0])
            raise InputError(one, first, f"in the dataset; allowed {allowed}")
    nodes = nodes.sortby(dims).transpose(*dims)
    ranges = {dim: (float(nodes[dim][0]), float(nodes[dim][-1])) for dim in dims}

    def grid(part: xr.Dataset) -> Callable:
        axes = tuple(Axis(part[dim].values.astype(float)) for dim in dims)
        values, errors = (part[one].values.astype(float) for one in (name, f"{name}_error"))
        at = Grid(axes, values, errors).at
        return lambda points: at(*(points[dim] for dim in dims))

    if ranges.get("velocity", (1.0,))[0] != 0.0 or nodes.sizes["velocity"] < 2:
        return ranges, grid(nodes)
    # The static limit is not interpolated: between it and the smallest velocity, friction rises
    # with the power 2/3 of the velocity.
    still, moving = (grid(nodes.isel(velocity=part)) for part in (slice(1), slice(1, None)))
    slowest = float(nodes["velocity"][1])

    def at(points: Points) -> tuple[np.ndarray, np.ndarray]:
        rests = points["velocity"] == 0.0
        between = points["velocity"][~rests & (points["velocity"] < slowest)]
        if between.size:
            allowed = f"allowed is 0, or {slowest:g} to {ranges['velocity'][1]:g}"
            raise InputError("velocity", float(between[0]), f"{allowed}; {ANY}")
        both = np.empty((2, len(rests)))
        for part, chosen in ((still, rests), (moving, ~rests)):
            both[:, chosen] = part({dim: values[chosen] for dim, values in points.items()})
        return both[0], both[1]

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


def _block(ranges: Ranges, function: Interpolation, *parts: np.ndarray) -> tuple[np.ndarray, ...]:
    """Evaluate an interpolation at broadcast coordinates, after a check of their ranges."""
    arrays = np.broadcast_arrays(*parts)
    points = {}
    for (name, (low, high)), array in zip(ranges.items(), arrays, strict=True):
        outside = array[~((array >= low - SAME) & (array <= high + SAME))]
        if outside.size:
            allowed = f"allowed is {low:g} to {high:g}, the range of the map"
            allowed = allowed if high > low else f"allowed is {low:g}, the only one of the map"
            raise InputError(name, float(outside.flat[0]), f"{allowed}; {ANY}")
        points[name] = np.clip(array.ravel().astype(float), low, high)
    blocks = [
        function({name: values[k : k + BLOCK] for name, values in points.items()})
        for k in range(0, max(arrays[0].size, 1), BLOCK)
    ]
    return tuple(
        np.concatenate(part).reshape(arrays[0].shape) for part in zip(*blocks, strict=True)
    )
