"""Predictions for a table of contacts, returned as a dataset."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.csv_table import LABELS, SOURCES, Table, table_of
from microslip.foundation.errors import InputError
from microslip.si.inputs import QUANTITIES, unit_of
from microslip.si.predict import NOTHING, predict_arguments, without_solution
from microslip.si.prediction import COLUMNS, NoPrediction, Prediction, column_unit
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request, request_of

if TYPE_CHECKING:
    import xarray as xr

MOST_CASES = 100_000
NAMES = {
    name: QUANTITIES[name].unit if name in QUANTITIES else None for name in NOTHING if name != "map"
}
"""SI unit of each allowed column of a file, None for a text.  A column is an argument of
`predict`."""
TEXTS = ("outcome", "sought", "interval_method")
"""Text columns.  Every other column without values is numeric."""


def predict_table(
    motion: str,
    cases: Mapping[str, object] | str | os.PathLike,
    *,
    decimal: str = ".",
    encoding: str = "utf-8",
    **shared: object,
) -> xr.Dataset:
    """Predictions for a table of contacts.

    Parameters
    ----------
    motion : str
        Motion of all contacts; see `microslip.predict`.
    cases : mapping, pandas DataFrame or path of a CSV file
        Sequences of equal length, keyed by argument of `predict`, as in {"load": ["1 N", "10 N"]}
        or {"load [N]": [1, 10]}.  None and NaN are missing values.  Columns named label, name, id,
        sample or comment are copied to the dataset.
    decimal, encoding : str
        Decimal mark of the file, "." or ",", and its encoding, such as "cp1252".
    shared
        Arguments of `microslip.predict` that all cases share.

    Returns
    -------
    xarray.Dataset
        Every column of a Prediction, over the dimension `case`, with units.  Missing values are
        NaN.  Lists of strings are joined with semicolons.  `case_NAME` contains the input column
        NAME.  `error` is the error message of a case without a prediction, else empty.

    Raises
    ------
    InputError
        If the table is invalid or has no valid case.  If no case is valid, the error of the first
        case is raised.  An error due to the table contains the number of the case.
    """
    argument = "table" if isinstance(cases, str | os.PathLike) else "cases"
    table = table_of(argument, cases, NAMES, decimal=decimal, encoding=encoding)
    if not table.columns:
        raise InputError("cases", {}, f"{SOURCES}, with one column at least")
    return as_dataset(motion, table, list(predictions(motion, table, shared)))


def predictions(
    motion: str, table: Table, shared: Mapping[str, object], *, need_all: bool = False
) -> Iterator[Prediction | NoPrediction]:
    """Yield the prediction of each case in turn.

    All cases are checked before the first one is solved.  A search without a solution gives a
    Prediction that is not converged.  The arguments and errors are the same as for predict_table.

    need_all: True to raise InputError if any case is invalid.
    """
    count = _count(table.columns, shared)
    wrong: dict[int, str | InputError] = dict(table.errors)
    arguments = {name: values for name, values in table.columns.items() if name not in LABELS}
    cases = [
        {**shared, **{name: values[case] for name, values in arguments.items()}}
        for case in range(count)
    ]
    for case, arguments in enumerate(cases):
        if case not in wrong:
            try:
                _request(motion, arguments)
            except InputError as error:
                wrong[case] = error
    if len(wrong) == count or need_all:
        problems = {case: one for case, one in wrong.items() if isinstance(one, InputError)}
        same = len(wrong) == count and len({str(one) for one in wrong.values()}) == 1
        for case, one in problems.items():
            if same and one.argument not in table.columns:
                raise one
            raise InputError(one.argument, one.value, f"{table.place(case)}: {one.allowed}")
    return (
        NoPrediction(wrong[case]) if case in wrong else _prediction(motion, arguments)
        for case, arguments in enumerate(cases)
    )


def _prediction(motion: str, arguments: Mapping[str, object]) -> Prediction | NoPrediction:
    try:
        return predict_arguments(motion, arguments)
    except NotAttainedError as error:
        return without_solution(_request(motion, arguments), error.allowed)
    except InputError as error:
        return NoPrediction(error)


def _request(motion: str, arguments: Mapping[str, object]) -> Request:
    """The checked Request of a case.  Raises all errors that can be detected without a solve."""
    for name, value in arguments.items():
        if name not in NOTHING:
            raise InputError(name, value, f"allowed are {', '.join(['motion', *NOTHING])}")
    return request_of(motion, NOTHING | dict(arguments))


def _count(columns: Mapping[str, Any], shared: Mapping[str, object]) -> int:
    """Number of cases.  Raises InputError for an invalid table."""
    for name in columns:
        if name in shared:
            raise InputError(name, shared[name], "not allowed: the table has it")
    counts = sorted({len(values) for values in columns.values()})
    if len(counts) > 1:
        lengths = " and ".join(map(str, counts))
        allowed = f"columns of {lengths} values; allowed are columns of one length"
        raise InputError("cases", list(columns), allowed)
    if not 0 < counts[0] <= MOST_CASES:
        raise InputError("cases", counts[0], f"allowed are 1 to {MOST_CASES} cases")
    return counts[0]


def as_dataset(motion: str, table: Table, cases: Sequence[Prediction | NoPrediction]) -> xr.Dataset:
    """The Dataset of predict_table.  cases: the predictions."""
    import xarray as xr

    rows = [one.to_dict() if isinstance(one, Prediction) else vars(one) for one in cases]
    variables = {
        name: _variable(name, [row.get(name) for row in rows])
        for name in COLUMNS
        if name not in ("motion", "understood")
    }
    for name, values in table.columns.items():
        texts = ["" if one is None else str(one) for one in values]
        variables[name if name in LABELS else f"case_{name}"] = "case", texts, {}
    errors = [str(row.get("error", "")) for row in rows]
    variables["error"] = "case", errors, {"long_name": "error message of the case"}
    amplitude = variables["amplitude_si"][2]["units"] = unit_of("amplitude", motion) or "m"
    units = {"amplitude": amplitude, "speed": "m s-1", "load": "N"}
    sought = {row["sought"] for row in rows if row.get("sought")}
    if sought:  # the quantity of the search, `sought`, can vary between cases
        unit = units[sought.pop()] if len(sought) == 1 else "SI unit of the quantity in sought"
        for name in ("sought_error", "sought_spread"):
            variables[name][2]["units"] = unit
    return xr.Dataset(variables, {"case": np.arange(len(cases))}, {"motion": motion})


def _variable(name: str, values: list[Any]) -> tuple[str, list, dict[str, str]]:
    """Return a dataset variable along the dimension `case`.  Numbers have a unit."""
    if name in ("warnings", "not_checked"):
        return "case", ["; ".join(texts) for texts in values], {}
    if any(isinstance(value, bool) for value in values):
        return "case", values, {}
    arguments = [value for value in values if value is not None]
    if all(isinstance(value, str) for value in arguments) and (arguments or name in TEXTS):
        return "case", ["" if value is None else value for value in values], {}
    numbers = [np.nan if value is None else float(value) for value in values]
    return "case", numbers, {"units": column_unit(name)}
