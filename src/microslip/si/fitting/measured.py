"""The rows of a table of measured friction, completed by what is the same for all of them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from microslip.foundation import csv_text
from microslip.foundation.errors import InputError
from microslip.foundation.user_files import content_of
from microslip.si.fitting.measured_csv import COLUMNS, MOST_ROWS, read_table
from microslip.si.motions import UNIT_OF_AMPLITUDE
from microslip.si.quantities import read

CONDITIONS = ("speed", "amplitude", "frequency", "load")
"""Conditions that every row needs."""
ABOVE_ZERO = ("amplitude", "frequency", "load")


@dataclass(frozen=True, eq=False)
class Measured:
    """Measured friction, shape (n,) each.

    Attributes
    ----------
    speed, amplitude, frequency, load : np.ndarray
        m/s, m (rad for a bore), Hz and N.
    value, error : np.ndarray
        Measured friction, N or dimensionless, and its standard error; NaN where none was given.
    quantity : str
        "friction", a force in N, or "mu", a coefficient.
    texts : dict of str
        What was understood of what all rows share.
    labels : dict of list
        Columns of texts, by their names.
    left_out : tuple of str
        Lines that cannot be read, and why.
    """

    speed: np.ndarray
    amplitude: np.ndarray
    frequency: np.ndarray
    load: np.ndarray
    value: np.ndarray
    error: np.ndarray
    quantity: str
    texts: dict
    labels: dict = field(default_factory=dict)
    left_out: tuple = ()

    @property
    def has_errors(self) -> bool:
        return bool(np.isfinite(self.error).all())

    @property
    def weight(self) -> np.ndarray:
        """Factor from a coefficient of friction to the measured quantity, (n,)."""
        return self.load if self.quantity == "friction" else np.ones_like(self.load)

    @property
    def distinct(self) -> int:
        """How many different conditions there are."""
        return len(np.unique(np.stack([getattr(self, name) for name in CONDITIONS]), axis=1).T)


def read_measured(
    motion: str, given: object, *, decimal: str = ".", encoding: str = "utf-8", **shared: object
) -> Measured:
    """The rows of a CSV file or of a table of columns, checked; raises InputError.

    Parameters
    ----------
    motion : str
        One of motions.UNIT_OF_AMPLITUDE.
    given : path, mapping or pandas DataFrame
        The file, see `measured_csv`, or columns by their names: in the SI, or with a unit as in
        "speed [mm/s]".
    decimal, encoding : str
        The decimal mark and the encoding of the file.
    shared : quantity or None
        speed, amplitude, frequency and load where they are no columns.
    """
    unit = UNIT_OF_AMPLITUDE[motion]
    table, labels, left_out = _table(given, unit, decimal, encoding)
    count = len(next(iter(table.values())))
    if count == 0:
        raise InputError("measured", given, "no rows; allowed is a row for each measurement")
    texts: dict[str, str] = {}
    columns: dict[str, Any] = {}
    for name in CONDITIONS:
        if (name in table) == (shared[name] is not None):
            where = "both a column and given for all rows" if name in table else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(name, shared[name], allowed)
        if name in table:
            columns[name] = table[name]
        else:
            wanted = unit if name == "amplitude" else COLUMNS[name]
            one = read(name, shared[name], wanted, low_open=name in ABOVE_ZERO)
            columns[name], texts[name] = np.full(count, one.si), one.text
    if not (columns["amplitude"] > 0.0).any():
        raise InputError("measured", given, "no row with an amplitude above 0; nothing vibrates")
    quantity = _quantity(table, given)
    error = table.get(f"{quantity}_error", np.full(count, np.nan))
    values: dict[str, Any] = {
        "value": table[quantity],
        "error": error,
        "labels": labels,
        "left_out": left_out,
    }
    return Measured(**columns, **values, quantity=quantity, texts=texts)


def _table(
    given: object, unit: str, decimal: str, encoding: str
) -> tuple[dict[str, np.ndarray], dict[str, list], tuple[str, ...]]:
    """Columns as arrays of floats, labels as lists, and messages about lines that are left out."""
    csv_text.check_format(decimal, encoding)
    if isinstance(given, str | os.PathLike):
        try:
            content = content_of(given)
            rows = read_table(content, unit, decimal=decimal, encoding=encoding)
            columns = {name: np.array(values) for name, values in rows.columns.items()}
            return columns, rows.labels, tuple(rows.left_out)
        except OSError as error:
            problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
            raise InputError("measured", str(given), problem) from None
        except ValueError as error:
            raise InputError("measured", str(given), str(error)) from None
    if not csv_text.is_table(given):
        raise InputError("measured", given, "allowed is the path of a CSV file, or its columns")
    given = _without_empty_rows(csv_text.by_names(given))
    labels = {name: given.pop(name) for name in csv_text.LABELS if name in given}
    strange = [name for name in given if name not in COLUMNS]
    if strange or not given:
        which = repr(strange[0]) if strange else "nothing"
        allowed = f"a column {which}; allowed are some of {', '.join(COLUMNS)}"
        raise InputError("measured", list(given), allowed)
    table = {name: _column(name, values, unit) for name, values in given.items()}
    if len({len(column) for column in table.values()}) > 1:
        raise InputError("measured", list(given), "columns of several lengths; allowed is one")
    return table, labels, ()


def _without_empty_rows(table: Mapping[str, Any]) -> dict[str, Any]:
    """Columns without rows of missing values alone; of several lengths they stay as they are."""
    lists = [values for values in table.values() if isinstance(values, list)]
    if not lists or len(lists) < len(table) or len({len(values) for values in lists}) > 1:
        return dict(table)
    rows = zip(*lists, strict=True)
    kept = [i for i, row in enumerate(rows) if any(value is not None for value in row)]
    return {name: [values[i] for i in kept] for name, values in table.items()}


def _column(name: str, values: Any, unit_of_amplitude: str) -> np.ndarray:
    if isinstance(values, list) and any(isinstance(value, str) for value in values):
        unit = unit_of_amplitude if name == "amplitude" else COLUMNS[name]
        low = -np.inf if name in ("friction", "mu") else 0.0
        try:
            values = [read(name, value, unit, low=low, low_open=False).si for value in values]
        except InputError as error:
            allowed = f"allowed is a sequence of numbers, in {COLUMNS[name]}"
            raise InputError(name, values, f"{allowed}; {error}") from None
    if isinstance(values, list):
        values = [np.nan if value is None else value for value in values]
    try:
        column = np.array(values)
    except ValueError:
        column = np.empty(0, object)
    if column.ndim != 1 or column.dtype.kind not in "iuf":
        raise InputError(name, values, f"allowed is a sequence of numbers, in {COLUMNS[name]}")
    if len(column) > MOST_ROWS:
        raise InputError(name, len(column), f"allowed are at most {MOST_ROWS} rows")
    column = column.astype(float)
    if np.isnan(column).any():
        row = int(np.flatnonzero(np.isnan(column))[0]) + 1
        allowed = f"empty in row {row}; allowed: a number in every row, leave out the others"
        raise InputError(name, np.nan, allowed)
    least = -np.inf if name in ("friction", "mu") else 0.0
    zero = name in ("speed", "amplitude", "friction", "mu")
    bad = ~np.isfinite(column) | (column < least) | ((column == 0.0) & (not zero))
    if bad.any():
        allowed = "finite numbers" + (
            "" if least < 0.0 else " of at least 0" if zero else " above 0"
        )
        raise InputError(name, float(column[bad][0]), f"allowed are {allowed}")
    return column


def _quantity(table: Mapping[str, np.ndarray], given: object) -> str:
    """Which of both was measured."""
    there = [name for name in ("friction", "mu") if name in table]
    if len(there) != 1:
        many = "both friction and mu" if there else "neither friction nor mu"
        raise InputError("measured", named(given), f"has {many}; allowed is one of them")
    for name in ("friction", "mu"):
        if f"{name}_error" in table and name not in there:
            raise InputError("measured", named(given), f"has {name}_error without {name}")
    return there[0]


def named(given: Any) -> str | list:
    """A table as messages show it: its path, or the names of its columns."""
    return str(given) if isinstance(given, str | os.PathLike) else list(given)
