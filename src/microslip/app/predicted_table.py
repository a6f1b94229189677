"""Predictions of many contacts, from the lines of a --table file or from ranges."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.app.option_parser import format_as_options, option
from microslip.app.question import (
    FILE_FORMAT,
    Answer,
    refuse_figure,
    refuse_output,
    write_files,
)
from microslip.app.terminal import complain
from microslip.foundation.csv_table import Table
from microslip.foundation.errors import InputError, shown
from microslip.foundation.number_text import SEPARATOR, error_text, number_text
from microslip.si.motions import kind_of
from microslip.si.prediction import EMPTY, NoPrediction, Prediction
from microslip.si.printed_lines import not_converged, probability_text, runs_away

if TYPE_CHECKING:
    import xarray as xr

WIDTH = 13
MOST_COMPLAINTS = 10
"""Largest number of error messages about contacts without a prediction."""
MOST_LINES = 8
"""Largest number of lines in a figure."""
STEADY = "mu_apparent", "friction_force_N", "speed_m_s"
"""Columns that are empty for a contact that runs away, because it has no periodic state."""
PROBABILITIES = {
    "stays %": "probability_stays",
    "moves %": "probability_moves",
    "runs away %": "probability_runs_away",
}
"""Columns with the probability of each outcome, by heading."""


class _Cases(NamedTuple):
    """The contacts from a table or from ranges, and their names in the output.

    Attributes
    ----------
    table : Table
        Arguments of predict that differ between the contacts.
    shared : dict
        Arguments of predict that all contacts share.
    dataset : callable
        dataset(answers) -> xarray.Dataset with all columns of the predictions.
    names : list of str
        Name of each contact in messages.
    cells : dict of list of str
        First columns of the printed table, by heading.
    starts : list of dict
        First values of each contact in JSON, by name.
    """

    table: Table
    shared: dict[str, Any]
    dataset: Callable[[Sequence[Prediction | NoPrediction]], xr.Dataset]
    names: list[str]
    cells: dict[str, list[str]]
    starts: list[dict[str, Any]]


def answer(options: argparse.Namespace, arguments: Mapping[str, Any]) -> Answer:
    """Predict all contacts in a table, or all combinations of the values in ranges.

    The answer is complete if all predictions converged.  Error messages of contacts without a
    prediction are written to standard error.

    Parameters
    ----------
    options : argparse.Namespace
        Options of predict.
    arguments : mapping
        Values of the options on the command line, including the opened map of --map.

    Raises
    ------
    InputError
        If an option is invalid, or no contact is valid.
    """
    from tqdm import tqdm

    from microslip.si.table import predictions

    refuse_output(options.output, options.table)
    refuse_figure(options.figure)
    cases = _lines_of_file(options, arguments) if options.table else _points(options, arguments)
    try:
        lazy = predictions(options.motion, cases.table, cases.shared)
    except InputError as error:
        from_table = error.argument in cases.table.columns and error.argument not in cases.shared
        if not (options.table and from_table):
            raise
        problem = problem_text(error, cases.table.columns)
        raise InputError("table", options.table, problem) from None
    answers = list(tqdm(lazy, "contacts", len(cases.names), leave=False, disable=None))
    headings = cases.table.columns if options.table else ()  # not shown as options
    rows = [
        start | {"error": problem_text(one.error, headings, options.map)}
        if isinstance(one, NoPrediction)
        else start | {"error": None} | one.to_dict()
        for start, one in zip(cases.starts, answers, strict=True)
    ]
    if options.output is not None or options.figure is not None:
        dataset = cases.dataset(answers)
        errors = np.reshape([row["error"] or "" for row in rows], dataset["error"].shape)
        dataset["error"] = dataset["error"].copy(data=errors)
        write_files(options, "curve", dataset)
    missing = [
        f"{name}: {row['error']}" if isinstance(one.error, InputError) else row["error"]
        for name, row, one in zip(cases.names, rows, answers, strict=True)
        if isinstance(one, NoPrediction)
    ]
    more = len(missing) - MOST_COMPLAINTS
    for text in missing[:MOST_COMPLAINTS] + [f"{more} more without a prediction"] * (more > 0):
        complain(f"microslip predict: {text}")
    return Answer(rows, _as_text(cases, answers), all(one.converged for one in answers))


def _lines_of_file(options: argparse.Namespace, arguments: Mapping[str, Any]) -> _Cases:
    """Read contacts from a file with one contact per line."""
    from microslip.foundation.csv_table import table_of
    from microslip.si.table import NAMES, as_dataset

    format: dict[str, Any] = {name: arguments[name] for name in FILE_FORMAT if name in arguments}
    shared = {name: value for name, value in arguments.items() if name not in FILE_FORMAT}
    table = table_of("table", options.table, NAMES, **format)

    def dataset(answers: Sequence[Prediction | NoPrediction]) -> xr.Dataset:
        lines = "case", table.lines, {"long_name": "line of the file"}
        return as_dataset(options.motion, table, answers).assign_coords(line=lines)

    labels = {name: [text or "" for text in texts] for name, texts in table.labels.items()}
    cells = {"line": list(map(str, table.lines))} | labels
    columns = {"line": table.lines} | table.labels
    starts = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    names = [f"line {line}" for line in table.lines]
    return _Cases(table, shared, dataset, names, cells, starts)


def _points(options: argparse.Namespace, arguments: Mapping[str, Any]) -> _Cases:
    """Return one contact for each combination of values from the ranges."""
    from microslip.si.grid import grid_of

    grid = grid_of(options.motion, arguments)
    sizes = sorted(len(axis.values) for axis in grid.axes.values())
    if options.figure is not None and (len(sizes) > 2 or sizes[:-1] > [MOST_LINES]):
        allowed = f"allowed with one range, or with a second one of at most {MOST_LINES} values"
        raise InputError("figure", options.figure, allowed)
    starts = [dict(zip(grid.axes, case, strict=True)) for case in grid.combinations]
    texts = {name: list(map(_short, one)) for name, one in grid.table.columns.items()}
    names = [
        ", ".join(f"{name} {text}" for name, text in zip(texts, case, strict=True))
        for case in zip(*texts.values(), strict=True)
    ]
    return _Cases(grid.table, grid.shared, grid.dataset, names, texts, starts)


def _short(text: str) -> str:
    """Format a quantity with at most four digits."""
    number, _, unit = text.partition(" ")
    return f"{float(number):.4g} {unit}".strip()


def problem_text(
    error: InputError | str, columns: Collection[str] = (), map_: str | None = None
) -> str:
    """Format a contact's error message, with columns and options in place of Python arguments.

    For an empty cell or a missing column, the message contains no value.  map_: value of --map.
    """
    from microslip.si.predict import NOTHING

    if not isinstance(error, InputError):
        return format_as_options(error)
    others = [name for name in NOTHING if name not in columns]
    name = error.argument if error.argument in columns else option(error.argument)
    wrong = map_ if error.argument == "map" else error.value
    value = "" if wrong is None else f" = {shown(wrong)}"
    allowed = format_as_options(error.allowed, others)
    return " ".join(f"{name}{value}: {allowed}".split())


Column = tuple[str, Callable[[Mapping[str, Any]], str]]
"""Heading of a printed column, and the function that formats its cell in a row."""


def _as_text(cases: _Cases, answers: Sequence[Prediction | NoPrediction]) -> str:
    """Return the printed table, with a row for each case and remarks below."""
    columns = _columns([one for one in answers if isinstance(one, Prediction)])
    headings = (*cases.cells, *(heading for heading, _ in columns))
    lines = ["".join(f"{heading:>{WIDTH}}" for heading in headings)]
    remarks: dict[str, list[str]] = {}
    starts = zip(*cases.cells.values(), strict=True)
    for name, texts, one in zip(cases.names, starts, answers, strict=True):
        start = "".join(f" {text:>{WIDTH - 1}}" for text in texts)
        if isinstance(one, NoPrediction):
            lines.append(f"{start}  no prediction")
            continue
        row = EMPTY | {"sought_value": getattr(one, "sought_value", None)} | one.to_dict()
        lines.append(start + "".join(f"{cell(row):>{WIDTH}}" for _, cell in columns))
        own = [runs_away(one)] if row["outcome"] == "runs away" else []
        own += [*not_converged(one), *(f"warning: {text}" for text in one.warnings)]
        for text in own:
            remarks.setdefault(text, []).append(name)
    for text, names in remarks.items():
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        lines.append(f"{names[0]}{more}: {text}")
    return "\n".join(lines)


def _columns(answers: Sequence[Prediction]) -> list[Column]:
    """Return the columns of the printed table for these predictions."""
    forced = any(one.force_N is not None for one in answers)
    uncertain = {name for one in answers for name in one.uncertainty}
    friction = ("mu_apparent", "mu_apparent_error", "mu_apparent_spread")
    spread = ["spread"] * ("mu_apparent_spread" in uncertain)
    columns = _numbers(friction, ["mu_apparent", "+-", *spread])
    columns += _numbers(("friction_force_N", "friction_force_error_N", ""), ["force N", "+- N"])
    speed = ["speed m/s", *["+- m/s"] * forced]
    columns += _numbers(("speed_m_s", "speed_error_m_s", ""), speed)
    if forced:
        threshold = ("force_threshold_N", "force_threshold_error_N", "")
        columns += _numbers(threshold, ["threshold N", "+- N"])
    for sought in dict.fromkeys(one.sought for one in answers):
        if sought is not None:  # each line can search for a different quantity
            results = [one for one in answers if one.sought == sought]
            amplitude = kind_of(results[0].motion).unit
            unit = {"amplitude": amplitude, "speed": "m/s", "load": "N"}[sought]
            has_spread = any(one.sought_spread is not None for one in results)
            headings = [f"{sought} {unit}", f"+- {unit}", *[f"spread {unit}"] * has_spread]
            columns += _numbers(("sought_value", "sought_error", "sought_spread"), headings, sought)
    if forced:
        columns.append(("outcome", lambda row: row["outcome"] or ""))
    if forced and "probability_error" in uncertain:
        columns += [(title, partial(_percent, name=name)) for title, name in PROBABILITIES.items()]
        columns.append(("+- %", _percent_error))
    return columns


def _numbers(
    names: tuple[str, str, str], headings: Sequence[str], sought: str | None = None
) -> list[Column]:
    """Return columns with a value, its error estimate and its standard uncertainty.

    names: fields of a prediction that contain the three numbers; headings: headings of the numbers
    that are printed, in the same order; sought: name of the quantity, if it is the result of a
    search.
    """
    return [
        (heading, partial(_number, names=names, place=place, sought=sought))
        for place, heading in enumerate(headings)
    ]


def _number(
    row: Mapping[str, Any], names: tuple[str, str, str], place: int, sought: str | None
) -> str:
    """Format a number with the digits that its error estimate allows.  place: index in `names`."""
    value, error, spread = (row.get(name) for name in names)
    accelerates = row["outcome"] == "runs away" and names[0] in STEADY
    if value is None or accelerates or sought not in (None, row["sought"]):
        return ""
    number, _, error = number_text(value, error or 0.0).partition(SEPARATOR)
    if number.startswith("("):  # a common power of 10, as in "(2.820 +- 0.016)e-05"
        error, _, power = error.partition(")")
        number, error = f"{number[1:]}{power}", f"{float(error + power):g}"
    return [number, error or "0", "" if spread is None else number_text(spread, digits=2)][place]


def _percent(row: Mapping[str, Any], name: str) -> str:
    """Format the probability of an outcome."""
    if row[name] is None:
        return ""
    text = probability_text(row[name], row["probability_error"] or 0.0)
    text = text.removesuffix(" %").partition(SEPARATOR)[0]
    return text.replace("below", "<").replace("above", ">")


def _percent_error(row: Mapping[str, Any]) -> str:
    """Format the error of the probabilities."""
    error = row["probability_error"]
    return "" if error is None else error_text(100.0 * error)
