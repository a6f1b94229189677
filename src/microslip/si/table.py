"""Many contacts at once: arrays of quantities in, a dataset out."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from inspect import signature
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation import csv_text
from microslip.foundation.errors import InputError
from microslip.si.motions import unit_of_amplitude
from microslip.si.predict import predict, unattained
from microslip.si.prediction import NoPrediction, Prediction
from microslip.si.question import Question, asked
from microslip.si.reduction import NotAttainedError
from microslip.si.table_csv import cases_of_file
from microslip.si.uncertain import without_spreads

if TYPE_CHECKING:
    import xarray as xr

MOST_CASES = 100_000
UNITS: tuple[tuple[str, str], ...] = (
    ("_N_m", "N m"),
    ("_N_s_m", "N s m-1"),
    ("_m_s", "m s-1"),
    ("_rad_s", "rad s-1"),
)
UNITS += (("_Pa", "Pa"), ("_Hz", "Hz"), ("_kg", "kg"), ("_rad", "rad"), ("_W", "W"), ("_J", "J"))
UNITS += (("_N", "N"), ("_m", "m"), ("_s", "s"))
"""Ends of names of fields, and the units that they stand for; the first that fits counts."""
OTHER_UNITS = {"drive_stiffness_N_m": "N m-1", "time_to_1_mm_s": "s"}
TEXTS = ("warnings", "not_checked")
NAMES = ("outcome", "regime", "sought", "contacts", "interval_method")
"""Texts that no case may have; what no case has besides is a number."""


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
        Every field of Prediction over `case`, NaN for what a case does not have, with units; texts
        joined by semicolons.  `case_` and a name in front is what was given; `error` says what is
        wrong with a case that has no prediction, and is empty for the others.

    Raises
    ------
    InputError
        For what is no table, and where no case can be answered: as predict does for the first one,
        with its number in front of what is allowed.
    """
    names, errors = None, {}
    if isinstance(cases, str | os.PathLike):
        every = [name for name in signature(predict).parameters if name not in ("motion", "power")]
        found = cases_of_file(cases, every, decimal=decimal, encoding=encoding)
        cases, errors = found.columns, found.errors
        names = [f"line {line}" for line in found.lines]
    elif csv_text.is_table(cases):
        cases = csv_text.by_names(cases)
    return as_dataset(motion, cases, list(predictions(motion, cases, shared, names, errors)))


def predictions(
    motion: str,
    cases: Mapping[str, Any],
    shared: Mapping[str, object],
    names: Sequence[str] | None = None,
    errors: Mapping[int, str] | None = None,
) -> Iterator[Prediction | NoPrediction]:
    """The prediction of each case in turn.

    All cases are read before the first one is solved.  A case that nothing has the wanted reduction
    of is not converged, and says so.

    Parameters
    ----------
    motion, cases, shared
        As for predict_table, the cases as lists.
    names : sequence of str, optional
        Names of the cases, for messages.
    errors : mapping, optional
        Errors already found in cases, by the numbers of the cases.

    Raises
    ------
    InputError
        As predict_table does.
    """
    count = number_of(cases, shared)
    wrong: dict[int, str | InputError] = dict(errors or {})
    names = names or [f"case {case}" for case in range(count)]
    arguments = {name: values for name, values in cases.items() if name not in csv_text.LABELS}
    several = [
        {**shared, **{name: values[case] for name, values in arguments.items()}}
        for case in range(count)
    ]
    for case, given in enumerate(several):
        if case not in wrong:
            try:
                _question(motion, **given)
            except InputError as error:
                wrong[case] = error
    if len(wrong) == count:
        first = next((one for one in wrong.values() if isinstance(one, InputError)), None)
        if first is None:
            raise InputError("cases", None, str(wrong[0]))
        where = names[next(case for case, one in wrong.items() if one is first)]
        raise InputError(first.argument, first.value, f"in {where}: {first.allowed}")
    return (
        NoPrediction(wrong[case]) if case in wrong else _prediction(motion, given)
        for case, given in enumerate(several)
    )


def _prediction(motion: str, given: Mapping[str, object]) -> Prediction | NoPrediction:
    try:
        return predict(motion, **given)
    except NotAttainedError as error:
        return unattained(_question(motion, **given), error.allowed)
    except InputError as error:
        return NoPrediction(error)


def _question(motion: str, **given: Any) -> Question:
    """The checked request; raises the errors that predict raises before it solves anything."""
    plain, _ = without_spreads(motion, given)
    every = dict.fromkeys(signature(predict).parameters) | {"power": False}
    strange = [name for name in plain if name not in every]
    if strange:
        raise InputError(strange[0], plain[strange[0]], f"allowed are {', '.join(every)}")
    del every["motion"]
    return asked(motion, every | plain)


def number_of(cases: Mapping[str, Any], shared: Mapping[str, object]) -> int:
    """How many cases there are; raises InputError for a table that is none."""
    if not isinstance(cases, Mapping) or not cases:
        allowed = "allowed is a path, a DataFrame of pandas, or a mapping of names to sequences, "
        allowed += "with one column at least"
        raise InputError("cases", cases, allowed)
    for name, values in cases.items():
        if name in shared:
            raise InputError(name, shared[name], "allowed once: it is in the table, too")
        if isinstance(values, str) or not hasattr(values, "__len__"):
            raise InputError(name, values, "allowed is a sequence with a value for each case")
    counts = {len(values) for values in cases.values()}
    if len(counts) > 1:
        lengths = " and ".join(map(str, sorted(counts)))
        allowed = f"columns of {lengths} values; allowed are columns of one length"
        raise InputError("cases", list(cases), allowed)
    (count,) = counts
    if not 0 < count <= MOST_CASES:
        raise InputError("cases", count, f"allowed are 1 to {MOST_CASES} cases")
    return count


def as_dataset(
    motion: str, cases: Mapping[str, Any], found: Sequence[Prediction | NoPrediction]
) -> xr.Dataset:
    """The Dataset that predict_table returns, from the predictions of all cases."""
    import xarray as xr

    variables: dict[str, tuple] = {}
    column: Any
    about: dict[str, str]
    for field in fields(Prediction):
        values: list[Any] = [getattr(one, field.name, None) for one in found]
        if field.name in ("motion", "understood"):
            continue
        if field.name in TEXTS:
            column, about = ["; ".join(texts) for texts in values], {}
        elif all(isinstance(value, str | None) for value in values):
            column, about = ["" if value is None else value for value in values], {}
            if field.name not in NAMES and all(value is None for value in values):
                column, about = np.full(len(found), np.nan), {"units": _unit(field.name)}
        elif any(isinstance(value, bool) for value in values):
            column, about = values, {}
        else:
            column = [np.nan if value is None else float(value) for value in values]
            about = {"units": _unit(field.name)}
        variables[field.name] = "case", column, about
    variables |= {
        name if name in csv_text.LABELS else f"case_{name}": (
            *("case", ["" if one is None else str(one) for one in values]),
        )
        for name, values in cases.items()
    }
    amplitude = variables["amplitude_si"][2]["units"] = unit_of_amplitude(motion) or "m"
    units = {"amplitude": amplitude, "speed": "m s-1", "load": "N"}
    errors = [str(getattr(one, "error", "")) for one in found]
    variables["error"] = "case", errors, {"long_name": "what is wrong with the case"}
    sought: set[Any] = {getattr(one, "sought", None) for one in found} - {None}
    if sought:  # one for all cases, or another for some, which `sought` tells
        for name in ("sought_error", "sought_spread"):
            unit = units[next(iter(sought))] if len(sought) == 1 else "SI unit of what is sought"
            variables[name][2]["units"] = unit
    return xr.Dataset(variables, {"case": np.arange(len(found))}, {"motion": motion})


def _unit(name: str) -> str:
    """SI unit of a field, "1" without one; an error has the unit of its quantity."""
    if name in OTHER_UNITS:
        return OTHER_UNITS[name]
    return next((unit for end, unit in UNITS if name.endswith(end)), "1")
