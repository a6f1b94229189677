"""Tables of quantities from a CSV file, a mapping or a DataFrame: columns of texts with units.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"

`pandas.read_csv` does not serve here.  Under the heading "load [N],mu" it reads the line "1" as a
load with an empty mu, and the line "1,5,0.3" as a load of 5; an unclosed quote refuses the whole
file, a column that is there twice gets another name, and no message has the line of its cell.
"""

from __future__ import annotations

import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from microslip.foundation import csv_text
from microslip.foundation.csv_text import HEADING
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import content_of

NUMBER = re.compile(r"[+−-]?[\d.,]+([eE][+−-]?\d+)?", re.A)
"""Text that looks like a number; whether it is valid is decided when it is read."""
LABELS = ("label", "name", "id", "sample", "comment")
"""Columns of texts that are carried through to the output."""
TEXTS = ("material", "pressure", "contacts", *LABELS)
"""Columns whose cells are no quantities."""
PURE = {"", "1", "-"}
"""Units that say that there is none."""


@dataclass(frozen=True)
class Table:
    """Columns by their names, and where their rows come from.

    Attributes
    ----------
    columns : dict of list
        Texts with their units, or values of other types; None for an empty cell.
    lines : list of int
        Numbers of the lines of the file, the first one being 1; empty without a file.
    errors : dict of str
        Messages about rows that cannot be read, by the index of the row.
    """

    columns: dict[str, list[Any]]
    lines: list[int]
    errors: dict[int, str]

    @property
    def labels(self) -> dict[str, list[Any]]:
        """Columns of texts that are carried through."""
        return {name: texts for name, texts in self.columns.items() if name in LABELS}


def is_table(value: object) -> bool:
    """Whether a value is a path, a mapping of columns or a pandas DataFrame."""
    frame = hasattr(value, "columns") and hasattr(value, "iloc")
    return isinstance(value, str | os.PathLike | Mapping) or frame


def table_of(
    argument: str,
    source: Any,
    names: Mapping[str, bool],
    *,
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Table:
    """The table of a file or of columns.

    Parameters
    ----------
    argument : str
        Name of the table in messages.
    source : path, mapping or pandas DataFrame
        A file, or columns under such headings as "load [N]".
    names : mapping of bool
        Columns that a file may have besides labels, and whether they need a unit.
    decimal, encoding : str
        The decimal mark and the encoding of the file.

    Raises
    ------
    InputError
        For what is no table, and for a file of which no line can be read.
    """
    csv_text.check_format(decimal, encoding)
    if not isinstance(source, str | os.PathLike):
        return Table(_by_names(argument, source), [], {})
    try:
        return read_table(content_of(source), names, decimal=decimal, encoding=encoding)
    except OSError as error:
        problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        raise InputError(argument, str(source), problem) from None
    except ValueError as error:
        raise InputError(argument, str(source), str(error)) from None


def read_table(
    content: bytes, names: Mapping[str, bool], *, decimal: str = ".", encoding: str = "utf-8"
) -> Table:
    """The table of the content of a file.

    Columns are parted by commas, semicolons or tabs, and a cell that has one of these in it is in
    double quotes.  Cells under a heading with a unit are numbers in that unit, others are texts
    with their units.  Lines that are empty or begin with # do not count, and empty columns at the
    end neither.  The arguments are those of `table_of`.

    Raises
    ------
    ValueError
        For what is no table, and where no line can be read; the message begins with the line.
    """
    lines = csv_text.lines(content, encoding)
    where, heading = next(lines, (1, ""))
    separator, units = _headings(where, heading, names)
    table = Table({name: [] for name in units}, [], {})
    quantities = [name for name in units if name not in TEXTS]
    thousands = csv_text.Thousands(separator if decimal == "." else ",", quantities)
    for where, line in lines:
        row: dict[str, str | None] = dict.fromkeys(units)
        try:
            cells = csv_text.cells(where, line, separator, len(units))
            raw = dict(zip(units, cells, strict=True))
            row |= {name: raw[name] or None for name in units if name in LABELS}
            row |= {
                name: _text(where, name, cell, units[name], decimal, names[name])
                for name, cell in raw.items()
                if name not in LABELS
            }
            thousands.see(where, [raw[name] for name in quantities])
        except ValueError as error:
            table.errors[len(table.lines)] = str(error)
        table.lines.append(where)
        for name, text in row.items():
            table.columns[name].append(text)
    thousands.refuse()
    if not table.lines:
        raise ValueError(f"line {where}: no line follows the heading; allowed: one for each row")
    if len(table.errors) == len(table.lines):
        raise ValueError(table.errors[0])
    return table


def _headings(
    where: int, heading: str, names: Mapping[str, bool]
) -> tuple[str, dict[str, str | None]]:
    """The separator of a table, and the unit of each of its columns, None without brackets."""
    units_are = "each with its unit" if any(names.values()) else "with a unit or without"
    allowed = f"allowed: some of {', '.join(names)}, {units_are}, as in speed [mm/s]"
    for separator in csv_text.SEPARATORS:
        parts = csv_text.words(heading, separator)
        matches = [match for match in map(HEADING.fullmatch, parts) if match]
        if len(matches) == len(parts) and (len(parts) > 1 or separator == ","):
            break
    else:
        raise ValueError(f"line {where}: the heading is {heading[:80]!r}; {allowed}")
    units: dict[str, str | None] = {}
    for match in matches:
        name, unit = match[1].lower(), _unit(match)
        if name not in names and name not in LABELS:
            carried = f"a column of texts to carry through is named one of {', '.join(LABELS)}"
            raise ValueError(f"line {where}: a column {name!r}; {allowed}; {carried}")
        if name in units:
            raise ValueError(f"line {where}: {name} is there twice; allowed: once")
        if names.get(name) and not unit:
            raise ValueError(f"line {where}: {name} has no unit; {allowed}")
        units[name] = unit
    return separator, units


def _unit(heading: re.Match) -> str | None:
    """The unit in a match of HEADING: empty for a pure number, None without brackets."""
    unit = heading[2] if heading[3] is None else heading[3]
    if unit is None:
        return None
    return "" if unit.strip() in PURE else unit.strip()


def _text(
    where: int, name: str, cell: str, unit: str | None, decimal: str, needed: bool
) -> str | None:
    """A cell with its unit, None where it is empty; needed: whether the heading needs a unit."""
    if not cell:
        return None
    if name not in TEXTS:
        cell = csv_text.with_point(where, name, cell, decimal)
    if unit is None:
        return cell
    if not NUMBER.fullmatch(cell):
        allowed = "allowed is a number" + (
            "" if needed else f", or a heading without a unit: {name}"
        )
        raise ValueError(f"line {where}: {name} is {cell!r} in a column in {unit}; {allowed}")
    return f"{cell} {unit}".strip()


def _by_names(argument: str, table: Any) -> dict[str, Any]:
    """Columns of a mapping or a DataFrame as lists, None for missing values.

    Numbers under a heading with a unit become texts with it.  Values that are no sequences stay as
    they are.
    """
    found: dict[str, Any] = {}
    for name, values in table.items():
        if not isinstance(name, str):
            allowed = "names of columns must be texts, such as 'load [N]'"
            raise InputError(argument, name, allowed)
        heading = HEADING.fullmatch(name)
        if not isinstance(values, str | bytes) and hasattr(values, "__len__"):
            values = [None if _is_missing(value) else value for value in values]
            unit = _unit(heading) if heading else None
            if heading and unit is not None:
                name = heading[1].lower()
                values = [v if v is None else f"{_digits(v)} {unit}".strip() for v in values]
        if name in found:
            raise InputError(argument, name, "is there twice; allowed: once")
        found[name] = values
    return found


def _is_missing(value: object) -> bool:
    """Whether a value is None, or the NaN, NA or NaT of pandas, which differ from themselves."""
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        return True
    return isinstance(value, float) and value != value


def _digits(value: object) -> str:
    return repr(float(value)) if isinstance(value, float) else str(value)
