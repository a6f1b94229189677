"""Single answers as datasets: a point, a history, a period, a line, a prediction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import is_dataclass

import numpy as np
import xarray as xr

from microslip.foundation.errors import InputError

AXES = {
    "Result": (),
    "Prediction": (),
    "History": ("phase",),
    "PropulsionLine": ("velocity",),
    "Period": ("phase", "point"),
}
"""Records that have a dataset, by the names of their classes, and their axes."""
OF_POINTS = ("forward_position", "lateral_position", "area", "bound")
"""Arrays of a Period with a value for each point, if they have one axis."""


def to_xarray(record: object) -> xr.Dataset:
    """A record as a dataset: numbers and arrays as variables, texts as attributes.

    Parameters
    ----------
    record : Result, Prediction, History, Period or PropulsionLine
        What solve, predict, history, period and drive return.

    Returns
    -------
    xarray.Dataset
        History over `phase`, PropulsionLine over `velocity`, Period over `phase` and `point`, the
        others without a dimension.  What a record does not have is left out.

    Raises
    ------
    InputError
        For anything else.
    """
    kinds = [base.__name__ for base in type(record).__mro__ if base.__name__ in AXES]
    if not is_dataclass(record) or not kinds:
        allowed = f"allowed is one of {', '.join(AXES)}, not {type(record).__name__}"
        raise InputError("record", record, allowed)
    (kind,) = kinds
    axes = AXES[kind]
    variables: dict[str, tuple] = {}
    about = {"record": kind}
    plain = record.to_dict() if hasattr(record, "to_dict") else vars(record)
    for name, value in plain.items():
        if isinstance(value, np.ndarray):
            variables[name] = _axes_of(name, value, axes), value
        elif isinstance(value, bool | int | float | np.number):
            variables[name] = (), value
        elif isinstance(value, str):
            about[name] = value
        elif isinstance(value, list | tuple):
            about[name] = "; ".join(value)
        elif isinstance(value, Mapping):
            about[name] = "; ".join(f"{key}: {text}" for key, text in value.items())
    return xr.Dataset(variables, attrs=about)


def _axes_of(name: str, value: np.ndarray, axes: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the axes of an array."""
    if value.ndim == 2:
        return axes
    return (axes[1],) if name in OF_POINTS and len(axes) == 2 else (axes[0],)
