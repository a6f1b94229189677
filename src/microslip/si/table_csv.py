"""A table of contacts as CSV: one contact a line, under a heading with names and units.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"
"""

from __future__ import annotations

import os
import re
from collections.abc import Collection
from dataclasses import dataclass

from microslip.foundation import csv_text
from microslip.foundation.csv_text import LABELS
from microslip.foundation.errors import InputError
from microslip.foundation.user_files import content_of

NUMBER = re.compile(r"[+−-]?[\d.,]+([eE][+−-]?\d+)?", re.A)
"""Text that looks like a number; whether it is valid is decided when it is read."""
TEXTS = ("material", "pressure", "contacts", *LABELS)
"""Columns whose cells are no quantities."""


@dataclass(frozen=True)
class Cases:
    """Contacts of a file.

    Attributes
    ----------
    columns : dict of list
        Texts with their units by the names of predict's arguments and of labels, None for an empty
        cell.
    lines : list of int
        Numbers of the lines that they come from, the first one of the file being 1.
    errors : dict of str
        Messages about cells that cannot be read, by the place of their line in `lines`.
    """

    columns: dict[str, list[str | None]]
    lines: list[int]
    errors: dict[int, str]


def cases_of_file(
    path: str | os.PathLike,
    names: Collection[str],
    *,
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Cases:
    """The contacts of a file; raises InputError."""
    csv_text.check_format(decimal, encoding)
    try:
        return read_cases(content_of(path), names, decimal=decimal, encoding=encoding)
    except OSError as error:
        problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        raise InputError("table", str(path), problem) from None
    except ValueError as error:
        raise InputError("table", str(path), str(error)) from None


def read_cases(
    content: bytes, names: Collection[str], *, decimal: str = ".", encoding: str = "utf-8"
) -> Cases:
    """Contacts of the content of a file.

    Columns are parted by commas, semicolons or tabs, and a cell that has one of these in it is in
    double quotes.  Cells under a heading with a unit are numbers in that unit, others are texts as
    microslip.predict reads them.  Lines that are empty or begin with # do not count, and empty
    columns at the end neither.

    Parameters
    ----------
    content : bytes
        The file.
    names : collection of str
        Columns that there may be besides labels.
    decimal, encoding : str
        The decimal mark, and the encoding of the file.

    Raises
    ------
    ValueError
        For what is no table, and where no line can be read; the message begins with the line.
    """
    lines = csv_text.lines(content, encoding)
    where, heading = next(lines, (1, ""))
    allowed = f"allowed: some of {', '.join(names)}, with a unit or without, as in speed [mm/s]"
    separator, columns = csv_text.columns(where, heading, names, allowed)
    cases = Cases({name: [] for name, _ in columns}, [], {})
    quantities = [name for name, _ in columns if name not in TEXTS]
    thousands = csv_text.Thousands(separator if decimal == "." else ",", quantities)
    for where, line in lines:
        texts = dict.fromkeys(cases.columns)
        try:
            cells = csv_text.cells(where, line, separator, len(columns))
            pairs = zip(columns, cells, strict=True)
            for (name, unit), cell in sorted(pairs, key=lambda pair: pair[0][0] not in LABELS):
                texts[name] = _text(where, name, cell, unit, decimal)
            given = dict(zip(cases.columns, cells, strict=True))
            thousands.see(where, [given[name] for name in quantities])
        except ValueError as error:
            cases.errors[len(cases.lines)] = str(error)
        cases.lines.append(where)
        for name, text in texts.items():
            cases.columns[name].append(text)
    thousands.refuse()
    if not cases.lines:
        raise ValueError(f"line {where}: no line follows the heading; allowed: one for a contact")
    if len(cases.errors) == len(cases.lines):
        raise ValueError(cases.errors[0])
    return cases


def _text(where: int, name: str, cell: str, unit: str | None, decimal: str) -> str | None:
    """A cell as predict takes it."""
    if not cell:
        return None
    if name not in TEXTS:
        cell = csv_text.with_point(where, name, cell, decimal)
    if unit is None or name in LABELS:
        return cell
    if not NUMBER.fullmatch(cell):
        allowed = f"allowed is a number, or a heading without a unit: {name}"
        raise ValueError(f"line {where}: {name} is {cell!r} in a column in {unit}; {allowed}")
    return cell if unit in csv_text.PURE else f"{cell} {unit}"
