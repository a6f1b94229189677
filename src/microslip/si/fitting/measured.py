"""Read a table of measured friction, and the values that all rows share.

speed [mm/s],amplitude [um],friction [N]
1,0.5,1.93
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from microslip.foundation.csv_table import LABELS, Table, table_of
from microslip.foundation.errors import InputError
from microslip.si.inputs import QUANTITIES, Range, read_argument, unit_of
from microslip.si.quantities import read

CONDITIONS = ("speed", "amplitude", "frequency", "load")
"""Names of the conditions in each row."""
COLUMNS = {name: QUANTITIES[name] for name in CONDITIONS} | {
    "friction": Range("N", low=-math.inf),
    "friction_error": Range("N"),
    "mu": Range("", low=-math.inf),
    "mu_error": Range(""),
}
"""SI units of the allowed columns."""
MOST_ROWS = 10_000
"""Largest number of rows."""


@dataclass(frozen=True, eq=False)
class Measured:
    """Measured friction, shape (n,) each.

    Attributes
    ----------
    speed, amplitude, frequency, load : np.ndarray
        Conditions of each row, in m/s, m, Hz and N.
    value, error : np.ndarray
        Measured friction and its standard error, N or dimensionless.  An unknown error is NaN.
    quantity : str
        "friction", a force in N, or "mu", a coefficient.
    texts : dict of str
        Conditions that all rows share, as text.
    labels : dict of list
        Text columns, by name.
    left_out : tuple of str
        Unreadable lines, with the reasons.
    name : str or list
        Name of the table for messages; see `named`.
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
    name: str | list = ""

    @property
    def has_errors(self) -> bool:
        return bool(np.isfinite(self.error).all())

    @property
    def weight(self) -> np.ndarray:
        """Factor that converts a coefficient of friction to the measured quantity, shape (n,)."""
        return self.load if self.quantity == "friction" else np.ones_like(self.load)

    @property
    def omega(self) -> np.ndarray:
        """Angular frequency, rad/s, shape (n,)."""
        return 2.0 * math.pi * self.frequency

    @property
    def distinct(self) -> int:
        """Number of distinct conditions."""
        return len(np.unique(np.stack([getattr(self, name) for name in CONDITIONS]), axis=1).T)


def read_measured(
    motion: str, source: object, *, decimal: str = ".", encoding: str = "utf-8", **shared: object
) -> Measured:
    """Read and check the rows of a CSV file or of a table of columns; raises InputError.

    Parameters
    ----------
    motion : str
        One of motions.FIT_MOTIONS.
    source : path, mapping or pandas DataFrame
        The file, or columns by name.  A heading can have a unit, as in "speed [mm/s]".  A column
        without one is in SI units.
    decimal, encoding : str
        The decimal mark and the encoding of the file.
    shared : quantity or None
        Values of speed, amplitude, frequency and load that replace columns.
    """
    units = {name: column.unit for name, column in COLUMNS.items()}
    units["amplitude"] = unit_of("amplitude", motion)
    form: dict = {"decimal": decimal, "encoding": encoding, "need_units": True}
    table = table_of("measured", source, units, **form)
    title = named(source)
    columns, labels, left_out = _numbers(table, title, units)
    count = len(next(iter(columns.values())))
    texts: dict[str, str] = {}
    conditions: dict[str, Any] = {}
    for name in CONDITIONS:
        if (name in columns) == (shared[name] is not None):
            where = "both a column and an argument" if name in columns else "missing"
            allowed = f"it is {where}; allowed is a column, or one value for all rows"
            raise InputError(name, shared[name], allowed)
        if name in columns:
            conditions[name] = columns[name]
        else:
            one = read_argument(name, shared[name], motion)
            conditions[name], texts[name] = np.full(count, one.si), one.text
    if not (conditions["amplitude"] > 0.0).any():
        allowed = "no row with an amplitude above 0, so that nothing vibrates"
        raise InputError("measured", title, allowed)
    quantity = _quantity(columns, title)
    return Measured(
        **conditions,
        value=columns[quantity],
        error=columns.get(f"{quantity}_error", np.full(count, np.nan)),
        quantity=quantity,
        texts=texts,
        labels=labels,
        left_out=left_out,
        name=title,
    )


def _numbers(
    table: Table, title: str | list, units: Mapping[str, str]
) -> tuple[dict[str, np.ndarray], dict[str, list], tuple[str, ...]]:
    """Numeric columns in SI units, label columns, and messages about the unreadable lines of a
    file.

    Empty rows, and unreadable lines of a file, are omitted.  In a table that is not a file, an
    unreadable value raises InputError.
    """
    names = [name for name in table.columns if name not in LABELS]
    unknown = [name for name in names if name not in COLUMNS]
    if unknown or not names:
        which = repr(unknown[0]) if unknown else "nothing"
        allowed = f"a column {which}; allowed are some of {', '.join(COLUMNS)}"
        raise InputError("measured", title, allowed)
    if len({len(column) for column in table.columns.values()}) > 1:
        raise InputError("measured", title, "columns of several lengths; allowed is one length")
    rows, indices, left_out = [], [], []
    for index, row in enumerate(zip(*(table.columns[name] for name in names), strict=True)):
        if index in table.errors:
            left_out.append(table.errors[index])
        elif any(value is not None for value in row):
            try:
                rows.append([_number(*pair, units) for pair in zip(names, row, strict=True)])
                indices.append(index)
            except InputError as error:
                if not table.lines:
                    allowed = f"{error.allowed}, in row {index + 1}"
                    raise InputError(error.argument, error.value, allowed) from None
                problem = f"{error.argument} is {error.allowed}" if error.value is None else error
                left_out.append(f"line {table.lines[index]}: {problem}")
    if not rows:
        problem = left_out[0] if left_out else "no rows; allowed is a row for each measurement"
        raise InputError("measured", title, problem)
    if len(rows) > MOST_ROWS:
        raise InputError("measured", len(rows), f"allowed are at most {MOST_ROWS} rows")
    columns = dict(zip(names, np.array(rows).T, strict=True))
    labels = {name: [texts[index] for index in indices] for name, texts in table.labels.items()}
    return columns, labels, tuple(left_out)


def _number(name: str, value: object, units: Mapping[str, str]) -> float:
    """Read a value in SI units; raises InputError."""
    if value is None:
        allowed = "empty; allowed: a number in every row; leave out the row, or fill the cell"
        raise InputError(name, None, allowed)
    return read(name, value, **COLUMNS[name]._replace(unit=units[name])._asdict()).si


def _quantity(table: Mapping[str, np.ndarray], title: str | list) -> str:
    """The measured quantity, friction or mu."""
    columns = [name for name in ("friction", "mu") if name in table]
    if len(columns) != 1:
        many = "both friction and mu" if columns else "neither friction nor mu"
        raise InputError("measured", title, f"has {many}; allowed is one of them")
    for name in ("friction", "mu"):
        if f"{name}_error" in table and name not in columns:
            raise InputError("measured", title, f"has {name}_error without {name}")
    return columns[0]


def named(source: Any) -> str | list:
    """Name of a table for messages: the path, or the names of the columns."""
    return str(source) if isinstance(source, str | os.PathLike) else list(source)
