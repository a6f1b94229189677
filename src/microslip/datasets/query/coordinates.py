"""Points of a request: velocities and amplitudes as labelled arrays of floats."""

from __future__ import annotations

from decimal import Decimal
from numbers import Real
from typing import Any

import numpy as np
import xarray as xr

from microslip.foundation.errors import InputError
from microslip.theory import hertz

ALLOWED = "allowed is a finite number >= 0, or several"


def labelled(name: str, given: object) -> xr.DataArray:
    """A DataArray of numbers >= 0; sequences get a dimension of their name."""
    array = given if isinstance(given, xr.DataArray) else _array(name, given)
    if array.dtype.kind not in "iuf":
        raise InputError(name, given, f"{ALLOWED}, not of type {array.dtype}")
    if isinstance(array, xr.DataArray) and array.chunks is not None:
        return array  # its numbers are looked at when they are there
    try:
        hertz.checked(name, np.asarray(array, float))
    except ValueError:
        raise InputError(name, given, ALLOWED) from None
    if isinstance(array, xr.DataArray):
        return array
    if array.ndim > 1:
        allowed = f"allowed are {array.ndim} dimensions only with names (DataArray)"
        raise InputError(name, given, allowed)
    return xr.DataArray(
        array, dims=(name,) * array.ndim, coords={name: array} if array.ndim else {}
    )


def _array(name: str, given: Any) -> np.ndarray:
    """An argument as an array, of floats if all of its values are plain numbers.

    NumPy also converts texts, times, masked values and quantities to floats without a warning.
    """
    if hasattr(given, "units"):
        raise InputError(name, given, f"{ALLOWED}, dimensionless, without a unit")
    if np.ma.is_masked(given):
        raise InputError(name, given, f"{ALLOWED}, none of them masked")
    try:
        array = np.asarray(given)
        if array.dtype.kind in "iuf" or all(_is_plain(one) for one in array.flat):
            return array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise InputError(name, given, ALLOWED) from None
    return array


def _is_plain(value: object) -> bool:
    return isinstance(value, Real | Decimal) and not isinstance(value, bool | np.generic)
