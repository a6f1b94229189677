"""The command `microslip predict --table`: one contact for each line of a CSV file."""

from __future__ import annotations

import argparse
from collections.abc import Collection, Mapping, Sequence
from typing import Any, NamedTuple

from microslip.app.option_parser import format_as_options, option
from microslip.app.question import Answer, refuse_output, write_output
from microslip.app.terminal import complain
from microslip.foundation.errors import InputError, shown
from microslip.foundation.number_text import SEPARATOR, error_text, number_text
from microslip.si.motions import unit_of_amplitude
from microslip.si.prediction import EMPTY, NoPrediction, Prediction
from microslip.si.printed_lines import not_converged, probability_text, runs_away
from microslip.si.tables import Table

FORMAT = ("decimal", "encoding")
"""Options that describe the format of the file."""
WIDTH = 13
STEADY = "mu_apparent", "friction_force_N", "speed_m_s"
"""Columns of a periodic motion.  They are empty for a contact that runs away."""
PROBABILITIES = {
    "stays %": "probability_stays",
    "moves %": "probability_moves",
    "runs away %": "probability_runs_away",
}
"""Columns of the probabilities of the outcomes, by heading."""


def answer(options: argparse.Namespace, arguments: Mapping[str, Any]) -> Answer:
    """The predictions of a table, as an Answer.  It is complete if all predictions converged.

    Error messages of lines without a prediction are written to standard error.

    Parameters
    ----------
    options : argparse.Namespace
        Options of predict.
    arguments : mapping
        Values of the options on the command line.

    Raises
    ------
    InputError
        If an option is invalid, or the table has no valid line.
    """
    from tqdm import tqdm

    from microslip.si.table import NAMES, predictions
    from microslip.si.tables import table_of

    if options.propulsion or "points" in arguments:
        raise InputError("table", options.table, "allowed without --propulsion")
    refuse_output(options.output, options.table)
    format: dict[str, Any] = {name: arguments[name] for name in FORMAT if name in arguments}
    shared = {name: value for name, value in arguments.items() if name not in FORMAT}
    table = table_of("table", options.table, NAMES, **format)
    try:
        cases = predictions(options.motion, table, shared)
    except InputError as error:
        if error.argument not in table.columns or error.argument in shared:
            raise
        raise InputError("table", options.table, _problem(error, table.columns)) from None
    answers = list(tqdm(cases, "contacts", len(table.lines), leave=False, disable=None))
    rows = _rows(table, answers)
    if options.output is not None:
        _write(options.output, options.motion, table, answers, rows)
    for row, one in zip(rows, answers, strict=True):
        if isinstance(one, NoPrediction):
            where = f"line {row['line']}: " if isinstance(one.error, InputError) else ""
            complain(f"microslip predict: {where}{row['error']}")
    return Answer(rows, _as_text(table, answers), all(one.converged for one in answers))


def _rows(table: Table, answers: Sequence[Prediction | NoPrediction]) -> list[dict[str, Any]]:
    """A dict for each line, with its number, its labels, its error message or None, and its
    columns."""
    rows = []
    for index, (line, one) in enumerate(zip(table.lines, answers, strict=True)):
        labels = {name: texts[index] for name, texts in table.labels.items()}
        row: dict[str, Any] = {"line": line, **labels, "error": None}
        if isinstance(one, NoPrediction):
            row["error"] = _problem(one.error, table.columns)
        else:
            row |= one.to_dict()
        rows.append(row)
    return rows


def _problem(error: InputError | str, columns: Collection[str]) -> str:
    """The error message of a line, in which names of columns and options replace arguments.

    An InputError about an empty cell or a missing column has no value.
    """
    from microslip.si.predict import NOTHING

    if not isinstance(error, InputError):
        return format_as_options(error)
    others = [name for name in NOTHING if name not in columns]
    name = error.argument if error.argument in columns else option(error.argument)
    value = "" if error.value is None else f" = {shown(error.value)}"
    allowed = format_as_options(error.allowed, others)
    return " ".join(f"{name}{value}: {allowed}".split())


def _write(
    path: str,
    motion: str,
    table: Table,
    answers: Sequence[Prediction | NoPrediction],
    rows: Sequence[Mapping[str, Any]],
) -> None:
    """Write all columns of all cases to a .csv or .nc file atomically.  Raises InputError."""
    from microslip.si.table import as_dataset

    dataset = as_dataset(motion, table, answers)
    dataset["error"] = dataset["error"].copy(data=[row["error"] or "" for row in rows])
    lines = "case", table.lines, {"long_name": "line of the file"}
    dataset = dataset.assign_coords(line=lines)
    write_output(path, dataset, lambda file: dataset.to_dataframe().to_csv(file))


class _Quantity(NamedTuple):
    """A quantity of the printed table.

    Attributes
    ----------
    columns : tuple of str
        Columns of the value, of the error estimate and of the standard uncertainty.
    headings : tuple of str
        Headings of these columns.  A column that is not printed has an empty heading.
    sought : str or None
        Name of the quantity, if it is the result of a search.
    """

    columns: tuple[str, str, str]
    headings: tuple[str, str, str]
    sought: str | None = None


def _as_text(table: Table, answers: Sequence[Prediction | NoPrediction]) -> str:
    """The printed table, with a row for each case and remarks below."""
    some = [one for one in answers if isinstance(one, Prediction)]
    quantities, verdict = _quantities(some), _verdict_headings(some)
    headings = [text for one in quantities for text in one.headings if text] + verdict
    lines = ["".join(f"{title:>{WIDTH}}" for title in ("line", *table.labels, *headings))]
    remarks: list[str] = []
    for index, (line, one) in enumerate(zip(table.lines, answers, strict=True)):
        labels = (f" {texts[index] or '':>{WIDTH - 1}}" for texts in table.labels.values())
        start = f"{line:>{WIDTH}}{''.join(labels)}"
        if isinstance(one, NoPrediction):
            lines.append(f"{start}  no prediction")
            continue
        row = EMPTY | {"sought_value": getattr(one, "sought_value", None)} | one.to_dict()
        cells = [cell for quantity in quantities for cell in _cells(row, quantity)]
        cells += _verdict_cells(row)[: len(verdict)]
        lines.append(start + "".join(f"{cell:>{WIDTH}}" for cell in cells))
        if row["outcome"] == "runs away":
            remarks.append(f"line {line}: {runs_away(one)}")
        remarks += [f"line {line}: {text}" for text in not_converged(one)]
        remarks += [f"line {line}: warning: {text}" for text in one.warnings]
    return "\n".join(lines + remarks)


def _quantities(answers: Sequence[Prediction]) -> list[_Quantity]:
    """The quantities in the printed table of some predictions."""
    forced = any(one.force_N is not None for one in answers)
    spread = "spread" if any("mu_apparent_spread" in one.uncertainty for one in answers) else ""
    friction = ("mu_apparent", "mu_apparent_error", "mu_apparent_spread")
    shown = [
        _Quantity(friction, ("mu_apparent", "+-", spread)),
        _Quantity(("friction_force_N", "friction_force_error_N", ""), ("force N", "+- N", "")),
        _Quantity(
            ("speed_m_s", "speed_error_m_s", ""), ("speed m/s", "+- m/s" if forced else "", "")
        ),
    ]
    if forced:
        threshold = ("force_threshold_N", "force_threshold_error_N", "")
        shown.append(_Quantity(threshold, ("threshold N", "+- N", "")))
    for sought in dict.fromkeys(one.sought for one in answers):
        if sought is not None:  # each line can search for another quantity
            results = [one for one in answers if one.sought == sought]
            amplitude = unit_of_amplitude(results[0].motion)
            unit = {"amplitude": amplitude, "speed": "m/s", "load": "N"}[sought]
            spread = (
                f"spread {unit}" if any(one.sought_spread is not None for one in results) else ""
            )
            headings = (f"{sought} {unit}", f"+- {unit}", spread)
            columns = ("sought_value", "sought_error", "sought_spread")
            shown.append(_Quantity(columns, headings, sought))
    return shown


def _cells(row: Mapping[str, Any], quantity: _Quantity) -> list[str]:
    """Texts of the columns of one quantity, with the digits that its error estimate allows."""
    value, error, spread = (row.get(name) for name in quantity.columns)
    accelerates = row["outcome"] == "runs away" and quantity.columns[0] in STEADY
    texts = ["", "", ""]
    if not (value is None or accelerates or quantity.sought not in (None, row["sought"])):
        number, _, error = number_text(value, error or 0.0).partition(SEPARATOR)
        if number.startswith("("):  # a common power of 10, as in "(2.820 +- 0.016)e-05"
            error, _, power = error.partition(")")
            number, error = f"{number[1:]}{power}", f"{float(error + power):g}"
        texts = [number, error or "0", "" if spread is None else number_text(spread, digits=2)]
    return [text for text, heading in zip(texts, quantity.headings, strict=True) if heading]


def _verdict_headings(answers: Sequence[Prediction]) -> list[str]:
    """Headings of the outcome under a force, and of the probabilities of the outcomes."""
    if all(one.force_N is None for one in answers):
        return []
    uncertain = any("probability_error" in one.uncertainty for one in answers)
    return ["outcome", *PROBABILITIES, "+- %"] if uncertain else ["outcome"]


def _verdict_cells(row: Mapping[str, Any]) -> list[str]:
    """Texts of the outcome, of the probability of each outcome, and of the error of the
    probabilities."""
    error = row["probability_error"]
    chances = [row[column] for column in PROBABILITIES.values()]
    texts = ["" if chance is None else _percent(chance, error or 0.0) for chance in chances]
    return [row["outcome"] or "", *texts, "" if error is None else error_text(100.0 * error)]


def _percent(chance: float, error: float) -> str:
    text = probability_text(chance, error).removesuffix(" %").partition(SEPARATOR)[0]
    return text.replace("below", "<").replace("above", ">")
