"""Many contacts at once: arrays of quantities in, a dataset out."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.motions import unit_of_amplitude
from microslip.si.predict import NOTHING, predict_arguments, without_solution
from microslip.si.prediction import COLUMNS, NoPrediction, Prediction, unit_of
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request, request_of
from microslip.si.tables import LABELS, Table, is_table, table_of
from microslip.si.uncertain import without_uncertainty

if TYPE_CHECKING:
    import xarray as xr

MOST_CASES = 100_000
NAMES = {name: False for name in NOTHING if name != "power"}
"""Columns of a file: arguments of predict, none of which needs a unit in its heading."""
TEXTS = ("outcome", "regime", "sought", "contacts", "interval_method")
"""Columns of texts that no case may have; what no case has besides is a number."""


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
        As for `microslip.predict`.
    cases : mapping, pandas DataFrame or path of a CSV file
        Sequences of one length by the names of predict's arguments: {"load": ["1 N", "10 N"]}, or
        {"load [N]": [1, 10]}; None or NaN is what a case does not have.  Columns named label, name,
        id, sample or comment are carried through.
    decimal, encoding : str
        The decimal mark of the file, "." or ",", and its encoding, such as "cp1252".
    shared
        What all cases have in common, as for `microslip.predict`.

    Returns
    -------
    xarray.Dataset
        Every column of a Prediction over `case`, NaN for what a case does not have, with units;
        texts joined by semicolons.  `case_` and a name in front is what was given; `error` says
        what is wrong with a case that has no prediction, and is empty for the others.

    Raises
    ------
    InputError
        For what is no table, and where no case can be answered: as predict does for the first one,
        with its number in front of what is allowed.
    """
    table = Table({}, [], {})
    if is_table(cases):
        argument = "table" if isinstance(cases, str | os.PathLike) else "cases"
        table = table_of(argument, cases, NAMES, decimal=decimal, encoding=encoding)
    if not table.columns:
        allowed = "allowed is a path, a DataFrame of pandas, or a mapping of names to sequences, "
        raise InputError(
            "cases", {} if is_table(cases) else cases, f"{allowed}with one column at least"
        )
    return as_dataset(motion, table, list(predictions(motion, table, shared)))


def predictions(
    motion: str, table: Table, shared: Mapping[str, object]
) -> Iterator[Prediction | NoPrediction]:
    """The prediction of each case in turn.

    All cases are read before the first one is solved.  A case that nothing has the wanted reduction
    of is not converged, and says so.  The arguments and errors are those of predict_table.
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
    if len(wrong) == count:
        for case, one in wrong.items():
            if isinstance(one, InputError):
                where = f"line {table.lines[case]}" if table.lines else f"case {case}"
                raise InputError(one.argument, one.value, f"in {where}: {one.allowed}")
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
    """The checked request; raises the errors that predict raises before it solves anything."""
    for name, value in arguments.items():
        if name not in NOTHING:
            raise InputError(name, value, f"allowed are {', '.join(['motion', *NOTHING])}")
    plain, _ = without_uncertainty(motion, arguments)
    return request_of(motion, NOTHING | plain)


def _count(columns: Mapping[str, Any], shared: Mapping[str, object]) -> int:
    """How many cases there are; raises InputError for a table that is none."""
    for name, values in columns.items():
        if name in shared:
            raise InputError(name, shared[name], "allowed once: it is in the table, too")
        if isinstance(values, str) or not hasattr(values, "__len__"):
            raise InputError(name, values, "allowed is a sequence with a value for each case")
    counts = sorted({len(values) for values in columns.values()})
    if len(counts) > 1:
        lengths = " and ".join(map(str, counts))
        allowed = f"columns of {lengths} values; allowed are columns of one length"
        raise InputError("cases", list(columns), allowed)
    if not 0 < counts[0] <= MOST_CASES:
        raise InputError("cases", counts[0], f"allowed are 1 to {MOST_CASES} cases")
    return counts[0]


def as_dataset(motion: str, table: Table, found: Sequence[Prediction | NoPrediction]) -> xr.Dataset:
    """The Dataset that predict_table returns, from the predictions of all cases."""
    import xarray as xr

    rows = [one.to_dict() if isinstance(one, Prediction) else vars(one) for one in found]
    variables = {
        name: _variable(name, [row.get(name) for row in rows])
        for name in COLUMNS
        if name not in ("motion", "understood")
    }
    for name, values in table.columns.items():
        texts = ["" if one is None else str(one) for one in values]
        variables[name if name in LABELS else f"case_{name}"] = "case", texts, {}
    errors = [str(row.get("error", "")) for row in rows]
    variables["error"] = "case", errors, {"long_name": "what is wrong with the case"}
    amplitude = variables["amplitude_si"][2]["units"] = unit_of_amplitude(motion) or "m"
    units = {"amplitude": amplitude, "speed": "m s-1", "load": "N"}
    sought = {row["sought"] for row in rows if row.get("sought")}
    if sought:  # one for all cases, or another for some, which `sought` tells
        unit = units[sought.pop()] if len(sought) == 1 else "SI unit of what is sought"
        for name in ("sought_error", "sought_spread"):
            variables[name][2]["units"] = unit
    return xr.Dataset(variables, {"case": np.arange(len(found))}, {"motion": motion})


def _variable(name: str, values: list[Any]) -> tuple[str, list, dict[str, str]]:
    """A column over the cases, with its unit where it is one of numbers."""
    if name in ("warnings", "not_checked"):
        return "case", ["; ".join(texts) for texts in values], {}
    if any(isinstance(value, bool) for value in values):
        return "case", values, {}
    arguments = [value for value in values if value is not None]
    if all(isinstance(value, str) for value in arguments) and (arguments or name in TEXTS):
        return "case", ["" if value is None else value for value in values], {}
    numbers = [np.nan if value is None else float(value) for value in values]
    return "case", numbers, {"units": unit_of(name)}
