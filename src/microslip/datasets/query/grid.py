"""Axes of a regular grid over the range of a map."""

from __future__ import annotations

from numbers import Integral
from typing import Any

import numpy as np
import xarray as xr

from microslip.foundation.errors import InputError

DIGITS = 6
"""Significant digits of coordinates that are spaced evenly, as in a configuration."""


def axes_of_grid(dataset: xr.Dataset, wanted: dict[str, Any]) -> dict[str, Any]:
    """Coordinates by name; wanted: by name how many of them, or which ones.

    Raises InputError for less than two of them.
    """
    return {
        name: _spaced(dataset, name, given) if _is_count(name, given) else given
        for name, given in wanted.items()
    }


def _is_count(name: str, given: object) -> bool:
    if not isinstance(given, Integral) or isinstance(given, bool):
        return False
    if given < 2:
        raise InputError(name, given, "allowed is how many, 2 or more, or a sequence of which ones")
    return True


def _spaced(dataset: xr.Dataset, name: str, count: int) -> np.ndarray:
    if name not in dataset.variables:
        raise InputError(name, None, "friction.on_grid needs it, and the dataset has lost it")
    values = dataset[name].values
    positive = values[values > 0.0] if name == "velocity" else values
    low, high = float(positive.min()), float(positive.max())
    even = np.geomspace if name == "velocity" else np.linspace
    inner = [float(f"{value:.{DIGITS}g}") for value in even(low, high, count)[1:-1]]
    return np.array([low, *inner, high])
