"""Tables of quantities from a CSV file, a mapping or a DataFrame.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"

`pandas.read_csv` accepts too much.  Under the heading "load [N],mu" it reads the line "1" as a load
with an empty mu, and the line "1,5,0.3" as a load of 5.  It rejects the whole file for an unclosed
quote and renames duplicate columns.  Its messages do not contain the line number of a cell.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

from microslip.foundation import csv_text
from microslip.foundation.csv_text import HEADING, PURE
from microslip.foundation.errors import InputError
from microslip.foundation.named_files import content_of
from microslip.foundation.spec import near_miss

T = TypeVar("T")

NUMBER = re.compile(r"[+−-]?[\d.,]+([eE][+−-]?\d+)?", re.A)
"""Pattern of a text that resembles a number.  `quantities.read` checks it later."""
ALLOWED = "allowed is a path, a DataFrame of pandas, or a mapping of names to sequences"
LABELS = ("label", "name", "id", "sample", "comment")
"""Text columns that are copied to the output."""
TEXTS = ("material", "pressure", *LABELS)
"""Text columns; all others are quantities."""
EXAMPLES = {"speed": "mm/s", "forward": "um"}
"""Columns with a unit that a message can show as an example."""


@dataclass(frozen=True)
class Table:
    """A table.

    Attributes
    ----------
    columns : dict of list
        Values of each column.  They are texts with units or other objects; an empty cell is None.
    lines : list of int
        Line number of each row in the file, starting at 1.  The list is empty without a file.
    errors : dict of str
        Error messages of invalid rows, by index of the row.
    """

    columns: dict[str, list[Any]]
    lines: list[int]
    errors: dict[int, str]

    def place(self, case: int) -> str:
        """Phrase for a row in messages, such as "in line 3"."""
        return f"in line {self.lines[case]}" if self.lines else f"in case {case}"

    @property
    def labels(self) -> dict[str, list[Any]]:
        """Text columns that are copied to the output."""
        return {name: texts for name, texts in self.columns.items() if name in LABELS}


def is_table(value: object) -> bool:
    """True for a path, a mapping of columns or a pandas DataFrame."""
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
    """Read a table from a file or from columns.

    Parameters
    ----------
    argument : str
        Name of the table in messages.
    source : path, mapping or pandas DataFrame
        A file, or columns with headings such as "load [N]".
    names : mapping of bool
        Allowed columns of a file, besides labels.  The value is True for a column that needs a
        unit.
    decimal, encoding : str
        Decimal mark and encoding of the file.

    Raises
    ------
    InputError
        If the table is invalid, or the file has no valid line.
    """
    csv_text.check_format(decimal, encoding)
    if not is_table(source):
        raise InputError(argument, source, ALLOWED)
    if not isinstance(source, str | os.PathLike):
        return Table(_by_names(argument, source), [], {})
    return parsed_file(
        argument,
        source,
        lambda content: read_table(content, names, decimal=decimal, encoding=encoding),
    )


def parsed_file(argument: str, path: str | os.PathLike, parse: Callable[[bytes], T]) -> T:
    """Read a CSV file and return parse(content).  Raises InputError about the argument if the file
    cannot be read, or if `parse` raises ValueError."""
    try:
        return parse(content_of(path))
    except OSError as error:
        problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        raise InputError(argument, str(path), problem) from None
    except ValueError as error:
        raise InputError(argument, str(path), str(error)) from None


def read_table(
    content: bytes, names: Mapping[str, bool], *, decimal: str = ".", encoding: str = "utf-8"
) -> Table:
    """Read a table from the content of a file.

    Commas, semicolons or tabs separate the columns.  A cell that contains the separator is in
    double quotes.  Cells under a heading with a unit are numbers in that unit.  Other cells are
    texts with units.  Empty lines, lines that begin with #, and empty columns at the end are
    skipped.  The arguments are those of `table_of`.

    Raises
    ------
    ValueError
        If the table is invalid or has no valid line.  The message begins with the line number.
    """

    def is_heading(text: str) -> bool:
        try:
            return bool(_headings(0, text, names, decimal))
        except ValueError:
            return False

    lines = csv_text.lines(content, encoding, is_heading)
    where, heading = next(lines, (1, ""))
    separator, units = _headings(where, heading, names, decimal)
    table = Table({name: [] for name in units}, [], {})
    quantities = [name for name in units if name not in TEXTS]
    thousands = csv_text.Thousands(separator, decimal, quantities)
    for where, line in lines:
        row: dict[str, str | None] = dict.fromkeys(units)
        try:
            cells = csv_text.cells(where, line, separator, len(units))
            raw = dict(zip(units, cells, strict=True))
            numbers = [(name, raw[name]) for name in quantities if name != "counterbody"]
            units_row = not table.lines and not any(map(str.isdigit, "".join(cells)))
            row |= {name: raw[name] or None for name in units if name in LABELS}
            row |= {
                name: _text(where, name, cell, units[name], decimal, names[name])
                for name, cell in raw.items()
                if name not in LABELS
            }
            thousands.see(where, [raw[name] for name in quantities])
        except ValueError as error:
            units_row, table.errors[len(table.lines)] = False, str(error)
        if units_row:
            csv_text.refuse_units(where, numbers)
        table.lines.append(where)
        for name, text in row.items():
            table.columns[name].append(text)
    thousands.refuse()
    if not table.lines:
        raise ValueError(f"line {where}: no line follows the heading; allowed: one or more")
    if len(table.errors) == len(table.lines):
        raise ValueError(table.errors[0])
    return table


def _headings(
    where: int, heading: str, names: Mapping[str, bool], decimal: str
) -> tuple[str, dict[str, str | None]]:
    """The separator of a table, and the unit of each column.  A column without brackets has the
    unit None."""
    units_are = "each with its unit" if any(names.values()) else "with a unit or without"
    example = next((f", as in {n} [{unit}]" for n, unit in EXAMPLES.items() if n in names), "")
    allowed = f"allowed: some of {', '.join(names)}, {units_are}{example}"
    separator, matches = next(csv_text.headings(heading, decimal), ("", []))
    if not matches:
        hint = csv_text.heading_hint(heading)
        raise ValueError(f"line {where}: the heading is {heading[:80]!r}; {allowed}{hint}")
    units: dict[str, str | None] = {}
    for match in matches:
        name, unit = match[1].lower(), _unit(match)
        if name not in names and name not in LABELS:
            texts = f"columns of text: {', '.join(LABELS)}"
            hint = near_miss(name, names)
            texts += csv_text.heading_hint(heading)
            raise ValueError(f"line {where}: a column {name!r}; {hint}{allowed}; {texts}")
        if name in units:
            raise ValueError(f"line {where}: {name} is there twice; allowed: once")
        if names.get(name) and not unit:
            raise ValueError(f"line {where}: {name} has no unit; {allowed}")
        units[name] = unit
    return separator, units


def _unit(heading: re.Match) -> str | None:
    """The unit in a heading.  It is empty for a pure number, and None without brackets."""
    unit = heading[2] if heading[3] is None else heading[3]
    if unit is None:
        return None
    return "" if unit.strip() in PURE else unit.strip()


def _text(
    where: int, name: str, cell: str, unit: str | None, decimal: str, needed: bool
) -> str | None:
    """The text of a cell with its unit, or None if the cell is empty.  needed: True if the heading
    needs a unit."""
    if not cell:
        return None
    if name not in TEXTS:
        cell = csv_text.with_point(where, name, cell, decimal)
    if unit is None:
        return cell
    if not NUMBER.fullmatch(cell):
        other = "" if needed else f", or a heading without a unit: {name}"
        allowed = f"allowed is a number{other}"
        raise ValueError(f"line {where}: {name} is {cell!r} in a column in {unit}; {allowed}")
    return f"{cell} {unit}".strip()


def _by_names(argument: str, table: Any) -> dict[str, list[Any]]:
    """Columns of a mapping or a DataFrame as lists.  Missing values become None.

    Numbers under a heading with a unit become texts with this unit.
    """
    columns: dict[str, list[Any]] = {}
    for name, values in table.items():
        if not isinstance(name, str):
            allowed = "names of columns must be texts, such as 'load [N]'"
            raise InputError(argument, name, allowed)
        heading = HEADING.fullmatch(name)
        if isinstance(values, str | bytes) or not hasattr(values, "__len__"):
            raise InputError(name, values, "allowed is a sequence of one value for each row")
        values = [None if _is_missing(value) else value for value in values]
        unit = _unit(heading) if heading else None
        if heading and unit is not None:
            name = heading[1].lower()
            values = [v if v is None else f"{_digits(v)} {unit}".strip() for v in values]
        if name in columns:
            raise InputError(argument, name, "is there twice; allowed: once")
        columns[name] = values
    return columns


def _is_missing(value: object) -> bool:
    """True for None, and for NaN, NA and NaT."""
    if value is None or type(value).__name__ in ("NAType", "NaTType"):
        return True
    return isinstance(value, float) and value != value


def _digits(value: object) -> str:
    return repr(float(value)) if isinstance(value, float) else str(value)
