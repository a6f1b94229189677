"""Predict many contacts, and return a dataset or text.  The contacts form a table, a curve or a
grid."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product, repeat
from typing import TYPE_CHECKING, Any

import numpy as np

from microslip.foundation.csv_table import LABELS, SOURCES, table_of
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import SEPARATOR, number_text
from microslip.si.contact import Contact
from microslip.si.inputs import INPUTS, is_range, kind_of, read_quantity
from microslip.si.output import Prediction, Value, input_column
from microslip.si.predict import checked_contact, predict_contact, unsolved
from microslip.si.solve import RUNS_AWAY, NoSolutionError

if TYPE_CHECKING:
    import xarray as xr

MOST_CASES = 100_000
VALUES = 11
"""Default number of values of a range."""
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
OPTION = r"(?:\s*,\s*(\d+))?"
RANGE = re.compile(
    rf"(?!.*\.\.\.)({NUMBER})\s*\.\.\s*({NUMBER})\s*([^,.]*?){OPTION}(\s*,\s*log)?{OPTION}\s*", re.A
)
"""Pattern of a range: both ends, the unit, the number of values, and the word `log`.  The number
can be before or after `log`."""
RANGES = (
    "allowed is a range from a smaller to a larger number, such as '0..0.5 um' (11 values), "
    f"'0..2 um, 21' (21 values; from 2 to {MOST_CASES} are allowed) or '0.1..10 mm/s, 21, log' (21 "
    "values in equal ratios, from a number above 0); a number begins with a digit"
)
PRINTED = {"mu_apparent": "mu_apparent", "friction_force": "force N", "speed": "speed m/s"}
PRINTED |= {"force_threshold": "threshold N"}
PRINTED |= {f"probability_{one}": one for one in ("stays", "moves", "runs_away")}
"""Headings of the outputs in a printed table."""
WIDTH = 13
MISSING: tuple[dict[str, Any], dict[str, dict[str, str]]] = {"converged": False}, {}
"""Columns of a contact that has no prediction, and the attributes of these columns."""


@dataclass(frozen=True)
class Cases:
    """A table or a grid of contacts.

    Attributes
    ----------
    motion : str
        Motion of all contacts.
    columns : dict of list
        Inputs and labels that differ between the contacts, keyed by name.
    shared : dict
        Inputs that all contacts share.
    names : list of str
        Name of each contact in messages, such as "line 3".
    starts : dict of list
        First columns of the printed table, keyed by their headings.
    errors : dict of str
        Error messages about contacts that cannot be read, keyed by the index of the contact.
    axes : dict of tuple
        For each axis of a grid, keyed by the name of the coordinate: the name of the input, its SI
        unit, and its values in this unit.  Empty for a table.
    """

    motion: str
    columns: dict[str, list[Any]]
    shared: dict[str, Any]
    names: list[str]
    starts: dict[str, list[Any]]
    errors: dict[int, str] = field(default_factory=dict)
    axes: dict[str, tuple[str, str, list[float]]] = field(default_factory=dict)

    def contact(self, case: int) -> Contact:
        """Return a contact.  Raises InputError."""
        own = {n: values[case] for n, values in self.columns.items() if n not in LABELS}
        return checked_contact(self.motion, **self.shared | own)


Answers = Sequence[Prediction | InputError | str]
"""For each contact, its prediction or the reason why there is no prediction."""


def predict_table(
    motion: str,
    cases: Mapping[str, object] | str | os.PathLike,
    *,
    decimal: str = ".",
    encoding: str = "utf-8",
    **shared: object,
) -> xr.Dataset:
    """Predict the friction of each contact in a table.

    Parameters
    ----------
    motion : str
        Motion of all contacts; see `microslip.predict`.
    cases : mapping, pandas DataFrame or path of a CSV file
        Sequences of equal length, keyed by the names of the inputs of `predict`, as in {"load": ["1
        N", "10 N"]} or {"load [N]": [1, 10]}.  None and NaN are missing values.  Columns named
        label, name, id, sample or comment are copied to the dataset.
    decimal, encoding : str
        Decimal mark of the file, "." or ",", and its encoding, such as "cp1252".
    shared
        Inputs of `microslip.predict` that all cases share.

    Returns
    -------
    xarray.Dataset
        Every column of a Prediction, with units, along the dimension `case`.  Missing values are
        NaN.  Lists of strings are joined with semicolons.  `case_NAME` contains the input column
        NAME.  `error` contains the error message of a case without a prediction, and is empty for
        the other cases.

    Raises
    ------
    InputError
        If the table is invalid or has no valid case.  If no case is valid, the error of the first
        case is raised.  The message of an error in the table contains the number of the case.
    """
    table = read_cases(motion, cases, shared, decimal=decimal, encoding=encoding)
    return dataset_of(table, list(predictions(table)))


def predict_grid(motion: str, **given: Any) -> xr.Dataset:
    """Predict friction over ranges of one or more quantities.

    One range gives a curve, two ranges give a map, and more ranges give a grid.

    Parameters
    ----------
    motion : str
        Motion of all contacts, as for `microslip.predict`.
    **given
        Inputs of `microslip.predict`.  A quantity can be a range: "0..2 um" gives 11 equally spaced
        values, "0..2 um, 21" gives 21, and "0.1..10 mm/s, 21, log" gives 21 logarithmically spaced
        values.  It can also be a sequence of quantities.

    Returns
    -------
    xarray.Dataset
        Every column of a Prediction, with units.  Each range is a dimension, in the order of the
        arguments.  The name of a dimension is the input with its SI unit, such as speed_m_s.
        `error` contains the error message of a point without a prediction, and is empty for the
        other points.

    Raises
    ------
    InputError
        If an argument is invalid for all points, or if there is no range.
    """
    grid = grid_of(motion, given)
    return dataset_of(grid, list(predictions(grid)))


def read_cases(motion: str, source: Any, shared: Mapping[str, Any], **form: Any) -> Cases:
    """Read the contacts of a table.  The arguments in `form` are passed to `table_of`.  Raises
    InputError."""
    units = {name: one.unit for name, one in INPUTS.items() if name != "map"}
    argument = "table" if isinstance(source, str | os.PathLike) else "cases"
    table = table_of(argument, source, units, **form)
    if not table.columns:
        raise InputError("cases", {}, f"{SOURCES}, with one column at least")
    for name in table.columns:
        if name in shared and shared[name] is not None:
            raise InputError(name, shared[name], "not allowed: the table has it")
    count = len(next(iter(table.cells.values())))
    if not 0 < count <= MOST_CASES:
        raise InputError("cases", count, f"allowed are 1 to {MOST_CASES} cases")
    names = [f"line {line}" for line in table.lines] or [f"case {k}" for k in range(count)]
    starts = {"line": table.lines} if table.lines else {"case": list(range(count))}
    labels = {name: [x or "" for x in texts] for name, texts in table.labels.items()}
    return Cases(motion, table.columns, dict(shared), names, starts | labels, table.errors)


def values_of(name: str, text: str) -> list[str]:
    """Return the values in a range as strings, each with the unit of the range.  Raises
    InputError."""
    match = RANGE.fullmatch(text.strip())
    counts = [] if match is None else [int(one) for one in (match[4], match[6]) if one]
    if match is None or len(counts) > 1:
        raise InputError(name, text, RANGES)
    low, high, count, log = float(match[1]), float(match[2]), (counts or [VALUES])[0], match[5]
    if not (low < high < math.inf and 2 <= count <= MOST_CASES) or log and low <= 0.0:
        raise InputError(name, text, RANGES)
    values = (np.geomspace if log else np.linspace)(low, high, count)
    return [f"{value:.12g} {match[3]}".strip() for value in values]


def grid_of(motion: str, given: Mapping[str, Any]) -> Cases:
    """Return the contacts for all combinations of the values in ranges and sequences.  The values
    of the last axis change fastest.

    Raises InputError if a range is invalid, if there is no range, or if there are too many
    combinations.
    """
    kind, axes, texts = kind_of(motion), {}, {}
    for name in [name for name in given if name in INPUTS and INPUTS[name].unit is not None]:
        values = given[name]
        if is_range(name, values):
            values = values_of(name, values)
        if isinstance(values, str) or np.ndim(values) != 1:
            continue
        one = kind.input(name)._replace(low=-math.inf, high=math.inf)  # see `predictions`
        si = [read_quantity(name, value, one).si for value in values]
        axes[input_column(name, one.unit or "")] = name, one.unit or "", si
        texts[name] = list(values)
    count = math.prod(map(len, texts.values()))
    if not axes or not 1 <= count <= MOST_CASES:
        allowed = f"the ranges have {count} combinations; allowed are 1 to {MOST_CASES}"
        name = max(texts, key=lambda one: len(texts[one])) if axes else "amplitude"
        raise InputError(name, given.get(name), allowed if axes else RANGES)
    cases = zip(*product(*texts.values()), strict=True)
    columns = {name: list(values) for name, values in zip(texts, cases, strict=True)}
    starts = {name: [_short(text) for text in values] for name, values in columns.items()}
    places = ([f"{name} {text}" for text in texts] for name, texts in starts.items())
    names = [", ".join(one) for one in zip(*places, strict=True)]
    shared = {name: value for name, value in given.items() if name not in texts}
    return Cases(motion, columns, shared, names, starts, {}, axes)


def _short(text: Any) -> str:
    """Format a quantity with at most four digits."""
    number, _, unit = str(text).partition(" ")
    try:
        return f"{float(number):.4g} {unit}".strip()
    except ValueError:
        return str(text)


def predictions(cases: Cases, *, need_all: bool = False) -> Iterator[Prediction | InputError | str]:
    """Yield the prediction for each contact in turn, or the reason why there is no prediction.

    All contacts are checked before the first one is solved.  A search without a solution gives a
    Prediction that is not converged.

    need_all: if True, raise InputError if any contact is invalid.
    """
    cells = range(len(cases.names))
    checked = [cases.errors.get(case) or _attempt(cases.contact, case) for case in cells]
    errors = [(k, one) for k, one in enumerate(checked) if isinstance(one, InputError)]
    if errors and (need_all or not any(isinstance(one, Contact) for one in checked)):
        first, problem = errors[0]
        if problem.argument not in cases.columns and len(set(map(str, checked))) == 1:
            raise problem
        place = f"{'at' if cases.axes else 'in'} {cases.names[first]}"
        count = sum(not isinstance(one, Contact) for one in checked)
        place += f" (the first of {count} refused, of {len(checked)})" * (count > 1)
        raise InputError(problem.argument, problem.value, f"{place}: {problem.allowed}")
    return (_attempt(predict_contact, c) if isinstance(c, Contact) else c for c in checked)


def _attempt(function: Callable, argument: Any) -> Any:
    """Return the result of a function, or the InputError that it raises."""
    try:
        return function(argument)
    except NoSolutionError as error:
        return unsolved(argument, error.allowed)
    except InputError as error:
        return error


def dataset_of(cases: Cases, answers: Answers) -> xr.Dataset:
    """Return the predictions as a dataset with the dimension `case`, or with the dimensions of a
    grid."""
    import xarray as xr

    axes: dict[str, Any] = {
        key: (key, values, {"long_name": name.replace("_", " "), "units": unit or "1"})
        for key, (name, unit, values) in cases.axes.items()
    }
    axes = axes or {"case": np.arange(len(answers))}
    shape = [len(values) for _, _, values in cases.axes.values()] or [len(answers)]
    pairs = [one.columns() if isinstance(one, Prediction) else MISSING for one in answers]
    about = {name: one for _, attributes in pairs for name, one in attributes.items()}
    columns: dict[str, list[Any]] = {
        name: [_cell(row.get(name), name in about) for row, _ in pairs]
        for name in dict.fromkeys(name for row, _ in pairs for name in row)
        if name not in ("motion", "inputs", *axes)
    }
    for name, values in cases.columns.items() if not cases.axes else ():
        texts = ["" if one is None else str(one) for one in values]
        columns[name if name in LABELS else f"case_{name}"] = texts
    columns["error"] = ["" if isinstance(one, Prediction) else str(one) for one in answers]
    about["error"] = {"long_name": "error message of the case"}
    variables = {
        name: (list(axes), np.array(values).reshape(shape), about.get(name, {}))
        for name, values in columns.items()
    }
    return xr.Dataset(variables, axes, {"motion": str(cases.motion)})


def _cell(value: Any, is_number: bool) -> Any:
    """Convert the value of a column for a dataset: None becomes NaN or an empty string, and a list
    of strings becomes one string."""
    if value is None:
        return math.nan if is_number else ""
    return "; ".join(value) if isinstance(value, list) else value


def table_text(cases: Cases, answers: Answers) -> str:
    """Return the table to print: one row for each contact, and remarks below the rows."""
    predicted = [one for one in answers if isinstance(one, Prediction)]
    rows = [one.input_values | one.values for one in predicted]  # speed: input or output
    columns = {title: [row.get(name) for row in rows] for name, title in PRINTED.items()}
    for name in dict.fromkeys(one.search for one in predicted if one.search not in (None, "speed")):
        roots = [one.input_values[name] if one.search == name else None for one in predicted]
        columns[f"{name} {next(filter(None, roots)).unit}"] = roots
    texts: list[Any] = []
    for title, values in columns.items():
        numbers = [one for one in values if one is not None]
        spread = any(one.spread is not None for one in numbers)
        used = bool(numbers), spread or any(one.error for one in numbers), spread
        parts = zip(*map(_digits, values), strict=True)
        titles = (title, "+-", "uncertainty")
        texts += [part for *part, use in zip(titles, parts, used, strict=False) if use]
    if any(one.outcome for one in predicted):
        texts.append(("outcome", [one.outcome or "" for one in predicted]))
    cells = iter(zip(*(one for _, one in texts), strict=True)) if texts else repeat(())
    lines = ["".join(f"{title:>{WIDTH}}" for title in (*cases.starts, *(one for one, _ in texts)))]
    remarks: dict[str, list[str]] = {}
    starts = zip(*cases.starts.values(), strict=True)
    for name, start, one in zip(cases.names, starts, answers, strict=True):
        lines.append("".join(f" {text:>{WIDTH - 1}}" for text in start))
        if not isinstance(one, Prediction):
            lines[-1] += "  no prediction"
            continue
        lines[-1] += "".join(f"{text:>{WIDTH}}" for text in next(cells))
        away = [f"it {one.reason}"] if one.outcome == RUNS_AWAY else []
        for text in (*away, *one.remarks, *one.problems):
            remarks.setdefault(text, []).append(name)
    for text, names in remarks.items():
        more = f" and {len(names) - 1} more" if len(names) > 1 else ""
        lines.append(f"{names[0]}{more}: {text}")
    return "\n".join(lines)


def _digits(one: Value | None) -> tuple[str, str, str]:
    """Format a value, its error and its standard uncertainty."""
    if one is None or math.isnan(one.value):
        return "", "", ""
    number, _, error = number_text(one.value, one.error or 0.0).partition(SEPARATOR)
    if number.startswith("("):  # a common power of 10, as in "(2.820 +- 0.016)e-05"
        error, _, power = error.partition(")")
        number, error = f"{number[1:]}{power}", f"{float(error + power):g}"
    spread = "" if one.spread is None else number_text(one.spread, digits=2)
    return number, error or "0", spread


def interpolation_errors(values: xr.DataArray) -> dict[str, float | None]:
    """Return the largest deviation from linear interpolation along each axis.  The deviation is the
    difference between a value and the linear interpolation between the two neighbouring values.

    The deviation is None for an axis with fewer than three values.  To estimate the error of linear
    interpolation between smooth values, add the deviations of all axes, and divide by 4.
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
