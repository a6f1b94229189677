"""Check the types and ranges of numbers that Python callers pass."""

from __future__ import annotations

import math
import sys
from inspect import signature
from numbers import Integral
from typing import Any, TypeGuard

from microslip.foundation.errors import InputError

LARGEST = {"velocity": 1e6, "amplitude": 1e6, "cells": 1000, "steps": 1_000_000}
"""Largest allowed values.  A larger value is probably a typing error, or the calculation would
exceed the memory or the range of floats."""
SMALLEST_TOLERANCE = 1e-6
"""Smallest allowed absolute tolerance of mu_macro."""
LARGEST_BODY = 1e6
"""Largest allowed stiffness, mass and damping of a drive, in working units."""
SMALLEST_STIFFNESS = 1e-9
"""Smallest stiffness of a spring, in working units.  A softer spring would stretch by more than 1e9
u_lim, and the rounding error of this length is 1e-7 u_lim.  Such a spring is equivalent to a
constant force."""


def without_array(value: Any) -> Any:
    """Extract the number from a NumPy array with one value, or from a DataArray with one value and
    no unit.  Return every other value unchanged.

    Arrays of other libraries, masked arrays and arrays with a unit are also returned unchanged.
    """
    xarray, numpy = sys.modules.get("xarray"), sys.modules.get("numpy")
    if xarray is not None and isinstance(value, xarray.DataArray):
        inside = without_array(value.data)
        is_plain = is_real(inside) and value.attrs.get("units", "1") in ("", "1")
        return inside if is_plain else value
    # subclasses can carry a mask or a unit
    if numpy is not None and type(value) is numpy.ndarray and value.size == 1:
        return value.reshape(())[()]
    return value


def refuse_progress(value: Any, count: int) -> None:
    """Raise InputError unless a value is None or a function that accepts `count` arguments."""
    if value is None:
        return
    try:
        signature(value).bind(*range(count))
    except ValueError:  # some built-in functions have no signature
        return
    except TypeError:
        allowed = f"allowed is a function of {count} argument{'s' * (count > 1)}"
        raise InputError("progress", value, allowed) from None


def is_real(value: object) -> TypeGuard[float]:
    """Return True for real numbers, except booleans and NumPy time spans."""
    if isinstance(value, int | float):
        return not isinstance(value, bool)
    import numpy as np  # late, since configurations do not need NumPy

    return isinstance(value, np.integer | np.floating) and not isinstance(value, np.timedelta64)


def real(name: str, value: object, low: float, high: float = math.inf) -> float:
    """Return the value as a float if it is a finite number between `low` and `high`.  Otherwise,
    raise InputError."""
    if type(value) is not float:
        value = without_array(value)
        if not is_real(value):
            raise InputError(name, value, "allowed is a number")
    try:
        number = float(value)
    except OverflowError:  # a whole number of more than 308 digits
        number = math.inf
    if not (math.isfinite(number) and low <= number <= high):
        upper = f" and at most {high:g}" if high < math.inf else ""
        raise InputError(name, value, f"allowed is a finite number of at least {low:g}{upper}")
    return number


def count(name: str, value: object, low: int, *, most: float, even: bool = False) -> int:
    """Return the value as an int if it is an integer between `low` and `most`.  Otherwise, raise
    InputError."""
    value = without_array(value)
    if not (is_real(value) and isinstance(value, Integral) and low <= value <= most):
        kind = "an even whole number" if even else "a whole number"
        raise InputError(name, value, f"allowed is {kind} of at least {low} and at most {most:g}")
    if even and value % 2:
        raise InputError(name, value, "allowed is an even number (half of it is run, too)")
    return int(value)


def numbers(name: str, values: Any, si: str = "") -> Any:
    """Convert an argument to an array of floats in the unit `si`.

    Numbers without a unit are not converted.  Raises InputError for masked values, for a wrong
    unit, and for values that are no numbers, such as times and booleans.
    """
    import numpy as np  # late, since configurations do not need NumPy

    from microslip.foundation.units import plain_number, read  # late: it takes a while to load

    unit = str(getattr(values, "units", getattr(values, "unit", "")))  # pint, xarray, astropy
    try:
        array = np.asanyarray(getattr(values, "magnitude", values))
        if array.dtype.kind == "O":  # such as Decimal
            array = np.vectorize(plain_number, [float])(array)
        if array.dtype.kind in "iuf" and not np.ma.is_masked(array):
            factor = 1.0 if unit in ("", "1", "dimensionless") else read(f"1 {unit}", si).si
            return np.array(array, float, order="C") * factor
    except (TypeError, ValueError, OverflowError):
        pass
    allowed = f" in {si}, or without a unit" if si else " without a unit" if unit else ""
    raise InputError(name, values, f"allowed is an array of numbers{allowed}, none of them masked")
