"""A table of contacts as CSV: one contact a line, under a heading with names and units.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Collection

from microslip.foundation import csv_text
from microslip.foundation.errors import InputError
from microslip.foundation.user_files import content_of

NUMBER = re.compile(r"[+−-]?[\d.,]+([eE][+−-]?\d+)?", re.A)
"""What is meant to be a number; whether it is one is decided where it is read."""


def cases_of_file(
    path: str | os.PathLike, names: Collection[str]
) -> tuple[dict[str, list[str | None]], list[int]]:
    """The columns of a file, as microslip.predict_table takes them, and the numbers of the lines
    that they come from; raises InputError."""
    try:
        return read_cases(content_of(path), names)
    except OSError as error:
        problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        raise InputError("table", str(path), problem) from None
    except ValueError as error:
        raise InputError("table", str(path), str(error)) from None


def read_cases(
    content: bytes, names: Collection[str]
) -> tuple[dict[str, list[str | None]], list[int]]:
    """Columns of a table by their names: texts with their units, None for an empty cell; and the
    numbers of the lines, the first one of the file being 1.

    Columns are parted by commas, semicolons or tabs, and a cell that has one of these in it is in
    double quotes.  Cells under a heading with a unit are numbers in that unit, others are texts as
    microslip.predict reads them.  Lines that are empty or begin with # do not count.

    Parameters
    ----------
    content : bytes
        The file.
    names : collection of str
        Columns that there may be.

    Raises
    ------
    ValueError
        For anything else; the message begins with the line.
    """
    lines = csv_text.lines(content)
    where, heading = next(lines, (1, ""))
    allowed = f"allowed: some of {', '.join(names)}, with a unit or without, as in speed [mm/s]"
    separator, columns = csv_text.columns(where, heading, names, allowed)
    table, numbers = {name: [] for name, _ in columns}, []
    thousands = csv_text.Thousands(separator, tuple(table))
    for where, line in lines:
        cells = _cells(where, line, separator)
        numbers.append(where)
        if len(cells) != len(columns):
            parted = f"parted by a {csv_text.SEPARATORS[separator]} as in the heading"
            problem = f"{len(cells)} cells; allowed: {len(columns)}, {parted}"
            raise ValueError(f"line {where}: {problem}, one with such a sign in double quotes")
        for (name, unit), cell in zip(columns, cells, strict=True):
            table[name].append(_text(where, name, cell, unit))
        thousands.see(where, cells)
    thousands.refuse()
    if not numbers:
        raise ValueError(f"line {where}: no line follows the heading; allowed: one for a contact")
    return table, numbers


def _cells(where, line, separator):
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, strict=True))]
    except csv.Error as error:
        allowed = "allowed are cells in whole pairs of double quotes, within one line"
        raise ValueError(f"line {where}: {error}; {allowed}") from None


def _text(where, name, cell, unit):
    """A cell as predict takes it."""
    if not cell:
        return None
    if unit is None:
        return cell
    if not NUMBER.fullmatch(cell):
        allowed = f"allowed is a number, or a heading without a unit: {name}"
        raise ValueError(f"line {where}: {name} is {cell!r} in a column in {unit}; {allowed}")
    return cell if unit in csv_text.PURE else f"{cell} {unit}"
