"""Convert the coordinates of a request to labelled arrays of finite, non-negative numbers."""

from __future__ import annotations

from collections.abc import Callable
from decimal import Decimal
from numbers import Integral, Real
from typing import Any

import numpy as np
import xarray as xr

from microslip.foundation.errors import InputError
from microslip.theory import hertz

ALLOWED = "allowed is a finite number >= 0, or several"
DIGITS = 6
"""Number of significant digits of evenly spaced coordinates."""


def coordinate_array(name: str, value: object) -> xr.DataArray:
    """Convert an argument to a DataArray of non-negative numbers.

    A sequence becomes the dimension `name`.  Values in dask chunks are not checked.
    """
    array = value if isinstance(value, xr.DataArray) else _array(name, value)
    if array.dtype.kind not in "iuf":
        raise InputError(name, value, f"{ALLOWED}, not of type {array.dtype}")
    if isinstance(array, xr.DataArray) and array.chunks is not None:
        return array
    try:
        hertz.checked(name, np.asarray(array, float))
    except ValueError:
        raise InputError(name, value, ALLOWED) from None
    if isinstance(array, xr.DataArray):
        return array
    if array.ndim > 1:
        allowed = f"allowed are {array.ndim} dimensions only with names (DataArray)"
        raise InputError(name, value, allowed)
    dims = (name,) * array.ndim
    return xr.DataArray(array, dims=dims, coords={name: array} if dims else {})


def evaluate(
    function: Callable[..., tuple[np.ndarray, ...]],
    coordinates: dict[str, xr.DataArray],
    types: tuple[type, ...],
) -> tuple[xr.DataArray, ...]:
    """Evaluate a function at labelled coordinates, which broadcast by their dimensions.

    If one of the coordinates is in dask chunks, so are the results.  The results are then computed
    and checked when their values are read.

    Parameters
    ----------
    function : callable
        Function of the coordinates.  Each coordinate is passed by name, as a float array of shape
        (n,).  The function returns arrays of shape (n,).
    coordinates : dict of xarray.DataArray
        Coordinates returned by `coordinate_array`.  The first coordinate is the slowest dimension
        of the results.
    types : tuple of type
        Types of the results.
    """

    def block(*parts: np.ndarray) -> tuple[np.ndarray, ...]:
        arrays = np.broadcast_arrays(*parts)
        flat = {
            name: coordinate_array(name, xr.DataArray(array.ravel().astype(float), dims="n")).values
            for name, array in zip(coordinates, arrays, strict=True)
        }
        results = zip(function(**flat), types, strict=True)
        return tuple(result.astype(type_).reshape(arrays[0].shape) for result, type_ in results)

    return xr.apply_ufunc(
        block,
        *coordinates.values(),
        join="outer",
        dask="parallelized",
        keep_attrs=True,
        output_core_dims=[[]] * len(types),
        output_dtypes=types,
    )


def _array(name: str, value: Any) -> np.ndarray:
    """Convert an argument to an array.  The array has the type float if all values are plain
    numbers.

    NumPy would convert texts, times, masked values and quantities without a warning.
    """
    if hasattr(value, "units"):
        raise InputError(name, value, f"{ALLOWED}, dimensionless, without a unit")
    if np.ma.is_masked(value):
        raise InputError(name, value, f"{ALLOWED}, none of them masked")
    try:
        array = np.asarray(value)
        if array.dtype.kind in "iuf" or all(_is_plain(entry) for entry in array.flat):
            return array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(name, value, ALLOWED) from None
    return array


def _is_plain(value: object) -> bool:
    return isinstance(value, Real | Decimal) and not isinstance(value, bool | np.generic)


def grid_axes(dataset: xr.Dataset, request: dict[str, Any]) -> dict[str, Any]:
    """Return the coordinates of a regular grid over the range of a dataset.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset with the coordinates.
    request : dict
        For each axis, by name: the number of coordinates, or the coordinates themselves.
        Velocities are logarithmically spaced, and other axes are evenly spaced.

    Raises
    ------
    InputError
        If a number of coordinates is below 2.
    """
    return {
        name: _spaced(dataset, name, int(value)) if _is_count(name, value) else value
        for name, value in request.items()
    }


def _is_count(name: str, value: object) -> bool:
    if not isinstance(value, Integral) or isinstance(value, bool):
        return False
    if value < 2:
        raise InputError(
            name,
            value,
            "allowed is a number of 2 or more, or a sequence of coordinates",
        )
    return True


def _spaced(dataset: xr.Dataset, name: str, count: int) -> np.ndarray:
    if name not in dataset.variables:
        raise InputError(name, None, "microslip.on_grid needs it, and the dataset has lost it")
    values = dataset[name].values
    positive = values[values > 0.0] if name == "velocity" else values
    low, high = float(positive.min()), float(positive.max())
    even = np.geomspace if name == "velocity" else np.linspace
    inner = [float(f"{value:.{DIGITS}g}") for value in even(low, high, count)[1:-1]]
    return np.array([low, *inner, high])
