"""Convert single results, such as points, histories, periods and predictions, to datasets."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

from microslip.answer.along import History, Response
from microslip.answer.answer import Result
from microslip.answer.period import Period
from microslip.foundation.errors import InputError
from microslip.si.output import Prediction
from microslip.si.response import RealResponse

RECORDS = (Result, Prediction, History, Period, Response, RealResponse)
"""Classes of results that can be converted."""
OF_POINTS = ("forward_position", "lateral_position", "area", "bound", "dissipated_energy_density")
"""Arrays of a Period that have the single axis `point`."""

ROW_ERRORS = {
    "force_forward": "force_error",
    "force_lateral": "force_error",
    "torque": "torque_error",
}
"""Name of the column with the error estimate, for each force and for the torque of a response."""
ROUNDING = 1e-9
"""A force is printed as 0 if the ratio of its absolute value to its error estimate is at most this
number."""


def to_xarray(record: Any) -> xr.Dataset:
    """Convert a result to a dataset.  Numbers and arrays are stored as variables, and strings as
    attributes.

    Parameters
    ----------
    record : Result, Prediction, History, Period, Response or RealResponse
        Value returned by solve, predict, history, period, response or predict_response.

    Returns
    -------
    xarray.Dataset
        Dataset with the dimension `phase` for a History, `row` for a response, and `phase` and
        `point` for a Period.  Datasets of other results have no dimension.  Fields that are None
        are omitted.

    Raises
    ------
    InputError
        If the record has another type.
    """
    if not isinstance(record, RECORDS):
        names = ", ".join(one.__name__ for one in RECORDS)
        allowed = f"allowed is one of {names}, not {type(record).__name__}"
        raise InputError("record", record, allowed)
    if isinstance(record, Prediction):
        return record.to_xarray()
    if isinstance(record, Response | RealResponse):
        columns = {n: ("row", one, {"units": unit}) for n, (unit, one) in record.columns.items()}
        return xr.Dataset(columns, attrs=record.attributes)
    variables: dict[str, tuple] = {}
    about = {"record": type(record).__name__}
    plain = record.values if isinstance(record, History) else record.to_dict()
    for name, value in plain.items():
        if isinstance(value, np.ndarray):
            dims = ("point",) if name in OF_POINTS else ("phase", "point")[: value.ndim]
            variables[name] = dims, value
        elif isinstance(value, bool | int | float | np.number):
            variables[name] = (), value
        elif isinstance(value, Mapping):
            about[name] = "; ".join(f"{key}: {text}" for key, text in value.items())
        elif isinstance(value, str | list | tuple):
            about[name] = value if isinstance(value, str) else "; ".join(value)
    return xr.Dataset(variables, attrs=about)


def response_text(record: Response | RealResponse) -> str:
    """Return the lines that `microslip response` prints: a CSV table with six digits.

    A force or a torque that is only a rounding error is printed as 0.
    """
    dataset = to_xarray(record)
    for name, error in ROW_ERRORS.items():
        least = ROUNDING * np.abs(dataset[error])
        dataset[name] = dataset[name].where(np.abs(dataset[name]) > least, 0.0)
    lines = [] if record.converged else [f"# NOT CONVERGED: {record.reason}"]
    units = {name: one.attrs["units"] for name, one in dataset.items()}
    headings = {name: name if unit == "1" else f"{name} [{unit}]" for name, unit in units.items()}
    table = dataset.to_dataframe().rename(columns=headings)
    rows = table.to_csv(index=False, float_format="%.6g", lineterminator="\n")
    return "\n".join([*lines, rows.rstrip("\n")])
