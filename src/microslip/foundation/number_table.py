"""Tables of numbers in CSV files: a heading with the names and units of the columns, then lines of
numbers.

Commas, semicolons or tabs separate the columns.  Empty lines and lines that begin with # are
ignored.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from microslip.foundation import csv_text

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.I | re.A)


@dataclass(frozen=True, eq=False)
class NumberTable:
    """A table of finite numbers.

    Attributes
    ----------
    columns : dict of str to np.ndarray, shape (rows,)
        Numbers in each column; the keys are the column names in the file.
    units : dict of str to str
        Unit of each column, as in the heading; empty for a column without brackets.
    lines : list of int
        Line number of each row, starting at 1.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str]
    lines: list[int]


def read_numbers(
    content: bytes,
    names: Sequence[str],
    allowed: str,
    *,
    complete: bool = False,
    least: Mapping[str, float] = MappingProxyType({}),
    decimal: str = ".",
    encoding: str = "utf-8",
    most: int = 1_000_000,
) -> NumberTable:
    """Read the table in the content of a CSV file.

    Parameters
    ----------
    content : bytes
        Content of the file.
    names : sequence of str
        Allowed columns.
    allowed : str
        Description of the allowed heading, for messages.
    complete : bool
        True if all columns are required.
    least : mapping of float
        Smallest allowed number in each column; the keys are the column names.
    decimal, encoding : str
        Decimal mark and encoding of the file.
    most : int
        Largest number of rows.

    Raises
    ------
    ValueError
        If the content has another format.  The message begins with the line number.
    """

    def is_heading(text: str) -> bool:
        try:
            return bool(_headings(0, text, names, allowed, complete, decimal))
        except ValueError:
            return False

    lines = csv_text.lines(content, encoding, is_heading)
    where, heading = next(lines, (1, ""))
    separator, units = _headings(where, heading, names, allowed, complete, decimal)
    rows: list[list[float]] = []
    places, thousands = [], csv_text.Thousands(separator, decimal, list(units))
    for where, line in lines:
        cells = csv_text.cells(where, line, separator, len(units))
        pairs = list(zip(units, cells, strict=True))
        words = [csv_text.with_point(where, name, cell, decimal) for name, cell in pairs]
        if not rows and not any(map(str.isdigit, "".join(words))):
            csv_text.refuse_units(where, pairs)
        rows.append(
            [
                number(where, n, word, least.get(n, -math.inf))
                for n, word in zip(units, words, strict=True)
            ]
        )
        places.append(where)
        thousands.see(where, words)
        if len(rows) > most:
            raise ValueError(f"line {where}: more than {most} points; allowed: at most that")
    thousands.refuse()
    columns = np.array(rows, float).reshape(-1, len(units)).T
    return NumberTable(dict(zip(units, columns, strict=True)), units, places)


def _headings(
    where: int, heading: str, names: Sequence[str], allowed: str, complete: bool, decimal: str
) -> tuple[str, dict[str, str]]:
    """Return the separator and the unit of each column."""
    for separator, matches in csv_text.headings(heading, decimal):
        units = {match[1].lower(): (match[2] or match[3] or "").strip() for match in matches}
        fits = units.keys() == set(names) if complete else units.keys() <= set(names)
        if fits and len(units) == len(matches):
            return separator, units
    hint = csv_text.heading_hint(heading)
    raise ValueError(f"line {where}: the heading is {heading[:80]!r}; allowed: {allowed}{hint}")


def number(where: int, name: str, word: str, least: float = -math.inf) -> float:
    """Convert a word to a number.  Raises ValueError with the line number unless the value is
    finite and at least `least`."""
    if not NUMBER.fullmatch(word):
        raise ValueError(f"line {where}: {name} is {word[:40]!r}; allowed: a number")
    value = float(word)
    if not math.isfinite(value) or value < least:
        allowed = "a finite number" + (f", {least:g} or above" if math.isfinite(least) else "")
        raise ValueError(f"line {where}: {name} is {word.lower()}; allowed: {allowed}")
    return value
