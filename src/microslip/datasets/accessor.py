"""The accessor `dataset.microslip`, which interpolates friction on a map and bounds the error."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from microslip.config.quantities import AXES
from microslip.datasets import interpolation
from microslip.datasets.interpolation import ANY, SAME
from microslip.datasets.variables import ANCILLARY, described
from microslip.foundation.arguments import numbers
from microslip.foundation.errors import InputError

ALLOWED = "allowed is a finite number, or several"
UNKNOWN = (
    "NaN beside points that did not converge; reason of the map, or the log of its job, says why"
)
BLOCK = 2**14
"""Number of points that are interpolated at once.  This number limits the memory use."""


class Map:
    """Accessor that interpolates friction between the points of a sweep's dataset.  On a map over
    forces, the accessor interpolates the velocity.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep, a selection from it, or several such datasets joined, in memory or in
        dask chunks.  A selection must contain mu_macro, mu_macro_error (for a map over forces,
        velocity and velocity_error), checksum and all coordinates.  The dataset of a certified map
        must be whole.
    """

    def __init__(self, dataset: xr.Dataset):
        self._dataset = dataset

    def at(self, velocity: Any = None, amplitude: Any = None, **others: Any) -> xr.Dataset:
        """Interpolate friction and its error bound at any point of the map.

        On a regular map, the bound is the sum of the interpolation error and the errors of the
        points (see datasets/interpolation.py).  In a certified map, each cell has its own bound.
        Near a point that did not converge, the interpolation is linear, with a larger bound.  In a
        cell beside such a point, mu_macro is NaN and the bound is infinite.  The attribute
        `comment` of the result then says where to find the cause.

        Parameters
        ----------
        velocity, amplitude, **others : number, sequence or DataArray
            Coordinates, with one argument for each dimension of the map, such as `poisson` or
            `stiffness`.  A sequence adds a dimension to the result; DataArrays broadcast by
            dimension.  If an argument is in dask chunks, the result is as well.

        Returns
        -------
        xarray.Dataset
            Dataset with the variables mu_macro and mu_macro_error, or velocity and velocity_error
            for a map over forces.

        Raises
        ------
        InputError
            If a coordinate is missing, unknown or outside the range of the map, or if the dataset
            lacks a variable.  The message names the coordinate or the variable.  Points outside the
            range can be computed with `microslip.solve`.
        """
        requests = {"velocity": velocity, "amplitude": amplitude} | others
        requests = {one: value for one, value in requests.items() if value is not None}
        data = self._dataset
        name = "velocity" if "force" in data.coords else "mu_macro"
        of_map = interpolation.of_map(data, name)
        numbers = {n: float(c) for n, c in data.coords.items() if not c.ndim and n in AXES}
        ranges = of_map.ranges | {one: (number, number) for one, number in numbers.items()}
        for one, value in requests.items():
            if one not in ranges:
                allowed = f"no coordinate of the map; allowed are {', '.join(ranges)}"
                raise InputError(one, value, allowed)
        for one, (low, high) in of_map.ranges.items():
            if one not in requests:
                raise InputError(one, None, f"needed; the map has {low:g} to {high:g}")
        chosen = {one: _coordinate(one, requests[one]) for one in ranges if one in requests}
        sizes: dict[Any, int] = {}
        for one, array in chosen.items():
            if {**sizes, **array.sizes} != {**array.sizes, **sizes}:
                allowed = f"allowed are the sizes of the other coordinates, {sizes}"
                raise InputError(one, dict(array.sizes), allowed)
            sizes |= array.sizes
        value, error = xr.apply_ufunc(
            partial(_block, of_map, {one: ranges[one] for one in chosen}),
            *chosen.values(),
            join="outer",
            dask="parallelized",
            keep_attrs=True,
            output_core_dims=[[], []],
            output_dtypes=[float, float],
        )
        if name == "mu_macro":
            value = value.clip(-1.0, 1.0)  # a polynomial can leave the range of friction
        about = {"long_name", "units"}
        value.attrs = {key: text for key, text in data[name].attrs.items() if key in about and text}
        value.attrs[ANCILLARY] = f"{name}_error"
        error.attrs = {"long_name": f"bound of the error of {name}", "units": "1"}
        scalars = [n for n in numbers if n not in value.coords]
        coords = {n: described({"long_name": n}, numbers[n], ()) for n in scalars}
        attributes = {key: data.attrs[key] for key in ("motion", "pressure") if key in data.attrs}
        if value.chunks is None and value.isnull().any():
            attributes["comment"] = UNKNOWN
        return xr.Dataset({name: value, f"{name}_error": error}, coords, attributes)


def _coordinate(name: str, value: Any) -> xr.DataArray:
    """Convert an argument to a DataArray of finite numbers.  A sequence is converted to an array
    with the dimension `name`.  Values in dask chunks are checked only when they are computed."""
    if isinstance(value, xr.DataArray) and value.chunks is not None and value.dtype.kind in "iuf":
        return value
    array = numbers(name, value)
    if not np.isfinite(array).all():
        raise InputError(name, value, ALLOWED)
    if isinstance(value, xr.DataArray):
        return value.astype(float)
    if array.ndim > 1:
        raise InputError(name, value, f"allowed are {array.ndim} dimensions with names (DataArray)")
    dims = (name,) * array.ndim
    return xr.DataArray(array, dims=dims, coords={name: (dims, array)})


def _block(
    of_map: interpolation.Grid | interpolation.Cells,
    ranges: dict[str, tuple[float, float]],
    *parts: np.ndarray,
) -> tuple[np.ndarray, ...]:
    """Check the ranges of the coordinates, broadcast them, and evaluate an interpolation at these
    points."""
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
        of_map.at({name: values[k : k + BLOCK] for name, values in points.items()})
        for k in range(0, max(arrays[0].size, 1), BLOCK)
    ]
    return tuple(
        np.concatenate(part).reshape(arrays[0].shape) for part in zip(*blocks, strict=True)
    )
