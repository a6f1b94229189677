"""The accessor `dataset.microslip`: friction between the points of a map, with an error bound."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from functools import partial
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from microslip.datasets.cells import cells_of, is_certified
from microslip.datasets.interpolation import Axis, Grid
from microslip.datasets.variables import variable
from microslip.foundation.errors import InputError

AXES = ("mass", "damping", "stiffness", "poisson", "amplitude", "velocity", "force")
"""Coordinates of maps, in the order of the dimensions of a result."""
SAME = 1e-12
"""Difference below which two coordinates count as equal."""
ALLOWED = "allowed is a finite number, or several"
LOST = "microslip.at needs it, and the dataset has lost it: keep it"

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
        requests = {name: value for name, value in requests.items() if value is not None}
        name = "velocity" if "force" in self._dataset.coords else "mu_macro"
        for needed in (name, f"{name}_error"):
            if needed not in self._dataset.variables:
                raise InputError(needed, None, LOST)
        certified = is_certified(self._dataset)
        axes, function = (_of_cells if certified else _of_grid)(self._dataset, name)
        scalars = {n: float(c) for n, c in self._dataset.coords.items() if not c.ndim and n in AXES}
        for one in requests:
            if one not in {**axes, **scalars}:
                allowed = f"allowed are {', '.join([*axes, *scalars])}"
                raise InputError(one, requests[one], f"no coordinate of the map; {allowed}")
        for one, number in scalars.items():
            asked = _coordinate(one, requests.pop(one, number))
            if asked.chunks is None and np.abs(asked.values - number).max(initial=0.0) > SAME:
                allowed = f"allowed is {number:g}, the only one of the map; microslip.solve"
                raise InputError(one, float(asked.values.flat[0]), f"{allowed} computes any")
        arrays = []
        for one, (low, high) in axes.items():
            if one not in requests:
                raise InputError(one, None, f"needed; the map has {low:g} to {high:g}")
            arrays.append(_coordinate(one, requests[one]))
        value, error = xr.apply_ufunc(
            partial(_block, axes, function),
            *arrays,
            join="outer",
            dask="parallelized",
            keep_attrs=True,
            output_core_dims=[[], []],
            output_dtypes=[float, float],
        )
        if name == "mu_macro":
            value = value.clip(-1.0, 1.0)  # a polynomial can leave the range of friction
        about = {key: self._dataset[name].attrs.get(key) for key in ("long_name", "units")}
        value.attrs = {key: text for key, text in about.items() if text}
        error.attrs = {"long_name": f"bound of the error of {name}", "units": "1"}
        answer = xr.Dataset({name: value, f"{name}_error": error})
        answer[name].attrs["ancillary_variables"] = f"{name}_error"
        answer = answer.assign_coords(
            {n: variable((), number, n) for n, number in scalars.items() if n not in answer.coords}
        )
        kept = self._dataset.attrs.keys() & {"motion", "pressure"}
        return answer.assign_attrs({key: self._dataset.attrs[key] for key in sorted(kept)})


def _of_cells(
    dataset: xr.Dataset, name: str
) -> tuple[dict[str, tuple[float, float]], Interpolation]:
    """Ranges of the axes of a certified map, and its interpolation."""
    table = cells_of(dataset)
    directions = table.coordinates.directions
    ranges = {axis: tuple(getattr(table.coordinates, axis)) for axis in AXES if axis in directions}

    def at(*points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place = dict(zip(ranges, points, strict=True))
        return table.at(*(place[direction] for direction in directions))

    return ranges, at


def _of_grid(
    dataset: xr.Dataset, name: str
) -> tuple[dict[str, tuple[float, float]], Interpolation]:
    """Ranges of the axes of a regular map, and its interpolation."""
    for one in (name, f"{name}_error"):
        if dataset[one].dtype.kind not in "iuf":
            raise InputError(one, f"of type {dataset[one].dtype}", "allowed are numbers")
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
        if nodes[dim].dtype.kind not in "iuf":
            raise InputError(dim, f"of type {nodes[dim].dtype}", "allowed are numbers")
        wrong = nodes[dim].values[~(np.isfinite(nodes[dim].values) & (nodes[dim].values >= 0.0))]
        if wrong.size:
            raise InputError(dim, float(wrong[0]), "in the dataset; allowed are numbers >= 0")
        if nodes.indexes[dim].has_duplicates:
            raise InputError(dim, "is there twice", "in the dataset; allowed is each value once")
    nodes = nodes.sortby(dims).transpose(*dims)
    least = float(nodes[f"{name}_error"].min())
    if least < 0.0:
        raise InputError(f"{name}_error", least, "in the dataset; allowed is 0 or more")
    if name == "mu_macro":
        values = nodes[name].values
        wrong = values[np.abs(values) > 1.0 + nodes[f"{name}_error"].values + SAME]
        if wrong.size:
            raise InputError(name, float(wrong[0]), "in the dataset; allowed is -1 to 1")

    def grid(part: xr.Dataset) -> Grid:
        axes = tuple(Axis(part[dim].values.astype(float)) for dim in dims)
        return Grid(axes, part[name].values.astype(float), part[f"{name}_error"].values)

    ranges = {dim: (float(nodes[dim][0]), float(nodes[dim][-1])) for dim in dims}
    if "velocity" not in dims or float(nodes["velocity"][0]) != 0.0 or nodes.sizes["velocity"] < 2:
        return ranges, grid(nodes).at
    # The static limit is not interpolated: between it and the smallest velocity, friction rises
    # with the power 2/3 of the velocity.
    still, moving = grid(nodes.isel(velocity=[0])), grid(nodes.isel(velocity=slice(1, None)))
    place, slowest = dims.index("velocity"), float(nodes["velocity"][1])

    def at(*points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rests = points[place] == 0.0
        between = ~rests & (points[place] < slowest)
        if between.any():
            allowed = f"allowed is 0, or {slowest:g} to {ranges['velocity'][1]:g}"
            slow = float(points[place][between][0])
            raise InputError("velocity", slow, f"{allowed}; microslip.solve computes any")
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
    axes: dict[str, tuple[float, float]], function: Interpolation, *parts: np.ndarray
) -> tuple[np.ndarray, ...]:
    """Evaluate an interpolation at broadcast coordinates, after a check of their ranges."""
    arrays = np.broadcast_arrays(*parts)
    for (name, (low, high)), array in zip(axes.items(), arrays, strict=True):
        outside = array[~((array >= low - SAME) & (array <= high + SAME))]
        if outside.size:
            allowed = f"allowed is {low:g} to {high:g}, the range of the map; microslip.solve"
            raise InputError(name, float(outside.flat[0]), f"{allowed} computes any")
    points = [
        np.clip(array.ravel().astype(float), low, high)
        for array, (low, high) in zip(arrays, axes.values(), strict=True)
    ]
    value, error = function(*points)
    return value.reshape(arrays[0].shape), error.reshape(arrays[0].shape)
