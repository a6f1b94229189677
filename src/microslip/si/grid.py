"""Predictions over ranges of quantities, such as a curve over the amplitude.

A range is a text such as "0..2 um".  The number of values, and `log` for equal ratios, can follow
after commas: "0.1..10 mm/s, 21, log".
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.foundation import spec
from microslip.foundation.csv_table import Table
from microslip.foundation.errors import InputError
from microslip.si.inputs import QUANTITIES, unit_of
from microslip.si.prediction import NoPrediction, Prediction
from microslip.si.quantities import read
from microslip.si.table import MOST_CASES, as_dataset, predictions
from microslip.si.units import UnitError, split_number

if TYPE_CHECKING:
    import xarray as xr

VALUES = 11
"""Default number of values of a range."""
DOTS, LOG = "..", "log"
ALLOWED = (
    "allowed is a range from a smaller to a larger number, such as '0..0.5 um' (11 values), "
    f"'0..2 um, 21' (21 values; from 2 to {MOST_CASES} are allowed) or '0.1..10 mm/s, 21, log' (21 "
    "values in equal ratios, from a number above 0); a number begins with a digit"
)


def is_range(name: str, value: object) -> bool:
    """Return True if the value of a quantity is a text with a range."""
    return name in QUANTITIES and isinstance(value, str) and DOTS in value


def values_of(name: str, text: str) -> list[str]:
    """Return the values of a range as texts with the unit of the range.  Raises InputError."""
    ends, *options = (part.strip() for part in text.split(","))
    first, _, last = ends.partition(DOTS)
    log, counts = LOG in options, [one for one in options if one != LOG]
    try:
        digits, unit = split_number(last)
        low, high = spec.read(name, first), float(digits)
        (count,) = [spec.read(name, one, whole=True) for one in counts] or [VALUES]
    except (UnitError, ValueError):
        raise InputError(name, text, ALLOWED) from None
    fits = -math.inf < low < high < math.inf and 2 <= count <= MOST_CASES
    words = not last.startswith(".") and DOTS not in last and len(options) == len(counts) + log
    if not (fits and words) or log and low <= 0.0:
        raise InputError(name, text, ALLOWED)
    values = (np.geomspace if log else np.linspace)(low, high, int(count))
    return [f"{value:.12g} {unit}".strip() for value in values]


class Axis(NamedTuple):
    """An axis of a grid.

    Attributes
    ----------
    name : str
        Name of the argument.
    texts : list
        Values as the user wrote them.
    values : list of float
        Values in the SI unit.
    unit : str
        SI unit.
    """

    name: str
    texts: list[Any]
    values: list[float]
    unit: str


class _Points(Table):
    """Combinations of values.  Messages name a combination by its values."""

    def place(self, case: int) -> str:
        """Phrase for a combination in messages, such as "at load 1 N, speed 1 mm/s"."""
        return f"at {', '.join(f'{name} {one[case]}' for name, one in self.columns.items())}"


@dataclass(frozen=True)
class Grid:
    """All combinations of values for some arguments of `predict`.

    Attributes
    ----------
    motion : str
        Motion of all contacts.
    axes : dict of Axis
        Axes by the name of the coordinate, such as speed_m_s.
    table : Table
        The combinations; the last axis changes fastest.
    shared : dict
        The other arguments.
    """

    motion: str
    axes: dict[str, Axis]
    table: Table
    shared: dict[str, Any]

    @property
    def combinations(self) -> list[tuple[float, ...]]:
        """Values of the axes in each combination, in SI units."""
        return list(product(*(axis.values for axis in self.axes.values())))

    def dataset(self, answers: Sequence[Prediction | NoPrediction]) -> xr.Dataset:
        """Return the predictions as a dataset over the axes; see `predict_grid`."""
        import xarray as xr

        flat = as_dataset(self.motion, self.table, answers)
        shape, dims = [len(axis.values) for axis in self.axes.values()], tuple(self.axes)
        inputs = {f"case_{name}" for name in self.table.columns}
        variables = {
            name: (dims, one.values.reshape(shape), one.attrs)
            for name, one in flat.data_vars.items()
            if name not in inputs and name not in dims
        }
        coordinates = {
            name: (
                name,
                axis.values,
                {"long_name": axis.name.replace("_", " "), "units": axis.unit or "1"},
            )
            for name, axis in self.axes.items()
        }
        return xr.Dataset(variables, coordinates, flat.attrs)


def grid_of(motion: str, arguments: Mapping[str, Any]) -> Grid:
    """Return the grid for arguments of `predict`.  Ranges and sequences become axes.

    Raises InputError if a range is invalid, if no argument is a range or a sequence, or if there
    are too many combinations.
    """
    axes, shared = {}, dict(arguments)
    for name in [name for name in arguments if name in QUANTITIES]:
        values = shared[name]
        if is_range(name, values):
            values = values_of(name, values)
        if isinstance(values, str) or np.ndim(values) != 1:
            continue
        unit = unit_of(name, motion)
        si = [read(name, value, unit, low=-math.inf).si for value in values]
        axes[_coordinate(name, unit)] = Axis(name, list(values), si, unit)
        del shared[name]
    count = math.prod(len(axis.values) for axis in axes.values())
    if not axes or not 1 <= count <= MOST_CASES:
        allowed = f"the ranges have {count} combinations; allowed are 1 to {MOST_CASES}"
        name = max(axes.values(), key=lambda axis: len(axis.values)).name if axes else "amplitude"
        raise InputError(name, arguments.get(name), allowed if axes else ALLOWED)
    cases = zip(*product(*(axis.texts for axis in axes.values())), strict=True)
    columns = {axis.name: list(texts) for axis, texts in zip(axes.values(), cases, strict=True)}
    return Grid(motion, axes, _Points(columns, dict.fromkeys(columns), [], {}), shared)


def predict_grid(motion: str, **arguments: Any) -> xr.Dataset:
    """Predictions over ranges of quantities: a curve, a map, or a table of more dimensions.

    Parameters
    ----------
    motion : str
        Motion of all contacts, as for `microslip.predict`.
    **arguments
        Arguments of `microslip.predict`.  A quantity can be a range: "0..2 um" has 11 values in
        equal steps, "0..2 um, 21" has 21, and "0.1..10 mm/s, 21, log" has 21 in equal ratios.  It
        can also be a sequence of quantities.

    Returns
    -------
    xarray.Dataset
        Every column of a Prediction, with units.  Each range is a dimension, in the order of the
        arguments.  The name of a dimension is the argument with its SI unit, such as speed_m_s,
        load_N or frequency_Hz; for the amplitude it is amplitude_si.  Missing values are NaN.
        `error` is the error message of a point without a prediction, and empty for other points.

    Raises
    ------
    InputError
        If an argument is invalid for all points, or if there is no range.
    """
    grid = grid_of(motion, arguments)
    return grid.dataset(list(predictions(motion, grid.table, grid.shared)))


def interpolation_errors(values: xr.DataArray) -> dict[str, float | None]:
    """Largest difference between a value and the linear interpolation of its neighbours, by axis.

    The difference is None for an axis with fewer than three values.  If the values are smooth,
    linear interpolation between them has an error of a quarter of the sum over the axes.
    """
    errors: dict[str, float | None] = {}
    for name in map(str, values.dims):
        if values.sizes[name] < 3:
            errors[name] = None
            continue
        f = np.moveaxis(values.values, values.get_axis_num(name), -1)
        left, right = np.diff(values[name].values)[:-1], np.diff(values[name].values)[1:]
        between = (right * f[..., :-2] + left * f[..., 2:]) / (left + right)
        errors[name] = float(np.abs(f[..., 1:-1] - between).max())
    return errors


def _coordinate(name: str, unit: str) -> str:
    """Return the name of a coordinate, in the same form as a Prediction's column names."""
    return "amplitude_si" if name == "amplitude" else "_".join([name, *re.findall(r"\w+", unit)])
