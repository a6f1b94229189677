"""Input and output of `microslip predict --table`: one contact for each line of a CSV file."""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from inspect import signature
from pathlib import Path
from typing import Any

from microslip.app.option_parser import format_as_options, option
from microslip.app.terminal import complain
from microslip.foundation.csv_text import LABELS
from microslip.foundation.errors import CacheError, InputError, shown
from microslip.foundation.number_text import SEPARATOR, error_text, number_text
from microslip.si.prediction import NoPrediction, Prediction
from microslip.si.printed_lines import not_converged, probability_text, runs_away, unit_of_sought

FORMAT = ("decimal", "encoding")
"""Options that say how the file is written."""
ENDINGS = (".csv", ".nc")
WIDTH = 13
STEADY = "mu_apparent", "friction_force_N", "speed_m_s"
"""Quantities of a periodic motion, which a contact that runs away does not have."""
PROBABILITIES = {
    "stays %": "probability_stays",
    "moves %": "probability_moves",
    "runs away %": "probability_runs_away",
}
"""Headings of the probabilities of each outcome, and their fields."""


@dataclass(frozen=True)
class Answered:
    """A table and its answer.

    Attributes
    ----------
    motion : str
        The motion.
    cases : dict of list of str
        Columns of the file.
    lines : list of int
        Numbers of the lines of the file that they come from.
    found : list of Prediction or NoPrediction
        Prediction of each line.
    """

    motion: str
    cases: dict[str, list[str | None]]
    lines: list[int]
    found: list[Prediction | NoPrediction]

    @property
    def labels(self) -> dict[str, list[str | None]]:
        """Columns of texts that are carried through."""
        return {name: texts for name, texts in self.cases.items() if name in LABELS}

    @property
    def errors(self) -> list[str]:
        """Error messages of the lines without a prediction."""
        pairs = zip(self.lines, self.found, strict=True)
        texts = ((line, one.error) for line, one in pairs if isinstance(one, NoPrediction))
        return [
            f"line {line}: {_problem(text, self.cases)}" if isinstance(text, InputError) else text
            for line, text in texts
        ]

    def to_dicts(self) -> list[dict]:
        """A dict for each line with its number, its labels and an error, which may be None."""
        dicts = []
        for row, (line, one) in enumerate(zip(self.lines, self.found, strict=True)):
            labels = {name: texts[row] for name, texts in self.labels.items()}
            if isinstance(one, NoPrediction):
                dicts.append({"line": line} | labels | {"error": _problem(one.error, self.cases)})
            else:
                dicts.append({"line": line} | labels | {"error": None} | one.to_dict())
        return dicts


def answer(
    options: argparse.Namespace, given: Mapping[str, object], columns: Collection[str]
) -> tuple[str, bool]:
    """The answer to a table as text, and whether all of it converged.

    What is wrong with lines that have no prediction goes to standard error.  options: those of
    predict; given: the ones that were typed; columns: names of all.  Raises InputError.
    """
    from microslip.sweeps.evaluate import plain

    if options.propulsion or "points" in given:
        raise InputError("table", options.table, "allowed without --propulsion")
    refuse_output(options.output, options.table)
    names = [name.replace("-", "_") for name in columns]
    shared = {name: value for name, value in given.items() if name not in FORMAT}
    format: dict[str, Any] = {name: given[name] for name in FORMAT if name in given}
    names = [name for name in names if name not in ("points", *FORMAT)]
    answered = ask(
        options.motion, options.table, shared | {"power": options.power}, names, **format
    )
    if options.output is not None:
        write(options.output, answered)
    for text in answered.errors:
        complain(f"microslip predict: {format_as_options(text)}")
    text = json.dumps(plain(answered.to_dicts())) if options.json else as_text(answered)
    return text, all(one.converged for one in answered.found)


def ask(
    motion: str,
    path: str,
    given: Mapping[str, object],
    columns: Collection[str],
    **format: str,
) -> Answered:
    """The cases of a file and their predictions, with a line of progress; raises InputError.

    given: options by name that all cases share; columns: of predict's arguments; format: decimal
    and encoding of the file.
    """
    from tqdm import tqdm

    from microslip.si.table import predictions
    from microslip.si.table_csv import cases_of_file

    read = cases_of_file(path, [name for name in columns if name != "power"], **format)
    names = [f"line {line}" for line in read.lines]
    try:
        found = predictions(motion, read.columns, given, names, read.errors)
    except InputError as error:
        if error.argument not in read.columns or error.argument in given:
            raise
        raise InputError("table", path, _problem(error, read.columns)) from None
    answers = list(tqdm(found, "contacts", len(names), leave=False, disable=None))
    return Answered(motion, read.columns, read.lines, answers)


def _problem(error: InputError | str, columns: Collection[str]) -> str:
    """Error message of a line, with the names of columns and options in place of arguments.

    error: InputError, without a value where the cell is empty or has no column; or a text.
    """
    from microslip.si.predict import predict  # only now: it takes a while

    if not isinstance(error, InputError):
        return format_as_options(error)
    others = [name for name in signature(predict).parameters if name not in columns]
    name = error.argument if error.argument in columns else option(error.argument)
    given = "" if error.value is None else f" = {shown(error.value)}"
    allowed = format_as_options(error.allowed, others)
    return " ".join(f"{name}{given}: {allowed}".split())


def refuse_output(path: str | None, table: str) -> None:
    """Raise InputError for an output that cannot be, before anything is computed; table: the file
    that is read."""
    if path is None:
        return
    file = Path(path)
    if file.suffix.lower() not in ENDINGS:
        allowed = f"allowed is a name that ends in {' or '.join(ENDINGS)}"
        raise InputError("output", path, allowed)
    if file.is_dir() or not file.parent.is_dir() or not os.access(file.parent, os.W_OK):
        raise InputError("output", path, "allowed is a file in a folder that can be written to")
    if file.resolve() == Path(table).resolve():
        raise InputError("output", path, "allowed is another file than the table that is read")


def write(path: str, answered: Answered) -> None:
    """All fields of all cases into a .csv or a .nc, whole or not at all; raises InputError."""
    from microslip.foundation.files import writing_beside
    from microslip.si.table import as_dataset

    dataset = as_dataset(answered.motion, answered.cases, answered.found)
    problems = [one["error"] or "" for one in answered.to_dicts()]
    dataset["error"] = dataset["error"].copy(data=problems)
    lines = "case", answered.lines, {"long_name": "line of the file"}
    dataset = dataset.assign_coords(line=lines)
    try:
        with writing_beside(Path(path)) as beside:
            if Path(path).suffix.lower() == ".csv":
                dataset.to_dataframe().to_csv(beside)
            else:
                dataset.to_netcdf(beside, engine="netcdf4")
    except (OSError, CacheError) as error:
        raise InputError("output", path, f"cannot be written: {error}") from None


def as_text(answered: Answered) -> str:
    """A row for each case, and what is said against it below the table."""
    predicted = [one for one in answered.found if isinstance(one, Prediction)]
    columns, verdict = _columns(predicted), _verdict_headings(predicted)
    labels = answered.labels
    headings = [heading for titles in columns.values() for heading in titles if heading] + verdict
    rows = ["".join(f"{title:>{WIDTH}}" for title in ("line", *labels, *headings))]
    remarks = []
    for row, (line, one) in enumerate(zip(answered.lines, answered.found, strict=True)):
        texts = "".join(f" {column[row] or '':>{WIDTH - 1}}" for column in labels.values())
        if isinstance(one, NoPrediction):
            rows.append(f"{line:>{WIDTH}}{texts}  no prediction")
            continue
        cells = [cell for about, titles in columns.items() for cell in _cells(one, about, titles)]
        cells += _verdict_cells(one)[: len(verdict)]
        rows.append(f"{line:>{WIDTH}}{texts}{''.join(f'{cell:>{WIDTH}}' for cell in cells)}")
        if one.outcome == "runs away":
            remarks.append(f"line {line}: {runs_away(one)}")
        remarks += [f"line {line}: {text}" for text in not_converged(one)]
        remarks += [f"line {line}: warning: {text}" for text in one.warnings]
    return "\n".join(rows + remarks)


@dataclass(frozen=True)
class _Quantity:
    """Names of a field of a Prediction, of its error and of its standard uncertainty, empty where
    it has none; sought: what has to be looked for if it is to be shown, None for anything."""

    value: str
    error: str = ""
    spread: str = ""
    sought: str | None = None


def _columns(found: Sequence[Prediction]) -> dict[_Quantity, tuple[str, str, str]]:
    """Headings of the columns of value, error and spread, empty where there is no column, by the
    quantity in them."""
    spread = any(one.mu_apparent_spread is not None for one in found)
    forced = any(one.force_N is not None for one in found)
    columns = {
        _Quantity("mu_apparent", "mu_apparent_error", "mu_apparent_spread"): (
            *("mu_apparent", "+-"),
            "spread" if spread else "",
        ),
        _Quantity("friction_force_N", "friction_force_error_N"): ("force N", "+- N", ""),
        _Quantity("speed_m_s", "speed_error_m_s"): ("speed m/s", "+- m/s" if forced else "", ""),
    }
    if forced:
        threshold = _Quantity("force_threshold_N", "force_threshold_error_N")
        columns[threshold] = "threshold N", "+- N", ""
    for one in found:  # an empty cell may be what is looked for, another one in each line
        if one.sought is not None:
            unit = unit_of_sought(one)
            quantity = _Quantity("sought_value", "sought_error", "sought_spread", one.sought)
            *_, before = columns.get(quantity, ("",))
            known = before if one.sought_spread is None else f"spread {unit}"
            columns[quantity] = f"{one.sought} {unit}", f"+- {unit}", known
    return columns


def _cells(one: Prediction, quantity: _Quantity, headings: tuple[str, str, str]) -> list[str]:
    """Texts of the columns of one quantity: to the digits that its error allows."""
    value = getattr(one, quantity.value)
    accelerates = one.outcome == "runs away" and quantity.value in STEADY
    if value is None or accelerates or quantity.sought not in (None, one.sought):
        return ["" for heading in headings if heading]
    error = getattr(one, quantity.error) or 0.0
    number, _, shown = number_text(value, error).partition(SEPARATOR)
    if number.startswith("("):  # a common power of 10, as in "(2.820 +- 0.016)e-05"
        shown, _, power = shown.partition(")")
        number, shown = f"{number[1:]}{power}", f"{float(shown + power):g}"
    spread = getattr(one, quantity.spread) if quantity.spread else None
    texts = number, shown or "0", "" if spread is None else number_text(spread, digits=2)
    return [text for text, heading in zip(texts, headings, strict=True) if heading]


def _verdict_headings(found: Sequence[Prediction]) -> list[str]:
    """Headings of the outcome under a force and of its probabilities, which follow it."""
    if all(one.force_N is None for one in found):
        return []
    uncertain = any(one.probability_error is not None for one in found)
    return ["outcome", *PROBABILITIES, "+- %"] if uncertain else ["outcome"]


def _verdict_cells(one: Prediction) -> list[str]:
    """Outcome, the probability of each outcome, and the error of these probabilities."""
    error = one.probability_error
    chances = [getattr(one, field) for field in PROBABILITIES.values()]
    texts = ["" if chance is None else _percent(chance, error or 0.0) for chance in chances]
    return [one.outcome or "", *texts, "" if error is None else error_text(100.0 * error)]


def _percent(chance: float, error: float) -> str:
    text = probability_text(chance, error).removesuffix(" %").partition(SEPARATOR)[0]
    return text.replace("below", "<").replace("above", ">")
