"""Tables in CSV files, mappings and DataFrames.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"

Commas, semicolons or tabs separate the columns.  A heading is a name, with or without a unit in
brackets.  Empty lines, lines that begin with #, a first line such as sep=; and empty columns at the
end are ignored.  A comment directly above the first line can be the heading.

`pandas.read_csv` accepts too much.  Under the heading "load [N],mu" it reads the line "1" as a load
with an empty mu, and the line "1,5,0.3" as a load of 5.  It rejects the whole file for an unclosed
quote and renames duplicate columns.  Its messages do not contain the line number of a cell.
"""

from __future__ import annotations

import codecs
import csv
import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeVar

from microslip.foundation.errors import InputError
from microslip.foundation.files import content_of
from microslip.foundation.spec import near_miss

T = TypeVar("T")

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
LABELS = ("label", "name", "id", "sample", "comment")
"""Columns of text that are copied to the output."""
PURE = ("", "1", "-")
"""Units in a heading that stand for a pure number."""
HEADING = re.compile(r"(\w+)\s*(?:\[([^\]]*)\]|\(([^()]*)\))?")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.I | re.A)
NO_ROW = re.compile(r"[\s,;\"]*|#(?!(N/A|NV|[A-Z/0]+[!?])).*")
"""Pattern of a line without cells and of a comment.  #N/A and #DIV/0! are cells of spreadsheets."""
SEPARATOR_LINE = re.compile(r"\"?sep=.\"?", re.I)
EXAMPLES = ("speed [mm/s]", "forward [um]")
"""Headings that messages show as an example."""
UNIT = re.compile(r"[\[(]?[^\W\d_][^\s,;]*[\])]?")
"""Pattern of a cell that may be a unit."""
DECIMAL_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])|^([+-]?),(?=[0-9])")
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+", re.A)
"""Pattern of a number such as 1.100, where the point can be a thousands separator."""
UNGROUPED = re.compile(r"[+-]?[1-9]\d{0,2}", re.A)
MOST_BREAKS = 100
"""Largest number of lines in a quoted cell."""
UTF_8 = "allowed: UTF-8, which spreadsheets call CSV UTF-8, or the encoding of the file by name"
SOURCES = "allowed is a path, a DataFrame of pandas, or a mapping of names to sequences"


@dataclass(frozen=True)
class Table:
    """A table of cells.

    Attributes
    ----------
    cells : dict of list
        Cells of each column, keyed by its name in lower case.  Cells of a file are texts with
        decimal points.  An empty cell is None.
    units : dict of str or None
        Unit of each column: "" for a pure number, None for a heading without brackets.
    lines : list of int
        Line number of each row, starting at 1; empty without a file.
    errors : dict of str
        Error messages of invalid rows, keyed by the index of the row.  Their cells are None.
    """

    cells: dict[str, list[Any]]
    units: dict[str, str | None]
    lines: list[int]
    errors: dict[int, str]

    @property
    def columns(self) -> dict[str, list[Any]]:
        """The cells with the units of their headings, such as "10 N"."""
        out = dict(self.cells)
        for name, unit in self.units.items():
            if unit is not None:
                out[name] = [c if c is None else f"{c} {unit}".strip() for c in self.cells[name]]
        return out

    @property
    def labels(self) -> dict[str, list[Any]]:
        return {name: cells for name, cells in self.cells.items() if name in LABELS}

    def place(self, row: int) -> str:
        """Phrase for a row in messages, such as "in line 3"."""
        return f"in line {self.lines[row]}" if self.lines else f"in case {row}"

    def numbers(self, least: Mapping[str, float] | None = None) -> dict[str, list[float]]:
        """The cells of each column as finite numbers.

        least: smallest allowed number of a column, keyed by its name.  Raises ValueError about an
        invalid row.
        """
        if self.errors:
            raise ValueError(next(iter(self.errors.values())))
        limits = dict.fromkeys(self.cells, -math.inf) | dict(least or {})
        columns = {n: zip(self.lines, cells, strict=True) for n, cells in self.cells.items()}
        return {n: [number(k, n, c or "", limits[n]) for k, c in one] for n, one in columns.items()}


def check_format(decimal: str, encoding: str) -> None:
    """Raise InputError for an unknown decimal mark or encoding."""
    if decimal not in (".", ","):
        raise InputError("decimal", decimal, "allowed is '.' or ','")
    try:
        codecs.lookup(encoding)
        "".encode(encoding)  # refuses encodings from bytes to bytes
    except (LookupError, TypeError, ValueError):
        allowed = "allowed is the name of an encoding, such as utf-8 or cp1252"
        raise InputError("encoding", encoding, allowed) from None


def table_of(
    argument: str,
    source: Any,
    names: Mapping[str, str | None],
    *,
    need_units: bool = False,
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
    names, need_units, decimal, encoding
        See `read_table`.  Other columns than `names` are allowed without a file.

    Raises
    ------
    InputError
        If the table is invalid, or the file has no valid row.
    """
    check_format(decimal, encoding)
    if isinstance(source, str | os.PathLike):
        form: dict[str, Any] = {"decimal": decimal, "encoding": encoding, "need_units": need_units}
        table = parsed_file(argument, source, lambda content: read_table(content, names, **form))
        if len(table.errors) == len(table.lines):
            problems = [*table.errors.values(), "no line follows the heading; allowed: some"]
            raise InputError(argument, str(source), problems[0])
        return table
    if not (isinstance(source, Mapping) or hasattr(source, "iloc") and hasattr(source, "columns")):
        raise InputError(argument, source, SOURCES)
    table = Table({}, {}, [], {})
    for title, values in source.items():
        if not isinstance(title, str):
            allowed = "names of columns must be texts, such as 'load [N]'"
            raise InputError(argument, title, allowed)
        if isinstance(values, str | bytes) or not hasattr(values, "__len__"):
            raise InputError(title, values, "allowed is a sequence of one value for each row")
        heading = HEADING.fullmatch(title)
        unit = _unit(heading) if heading else None
        name = title if unit is None or heading is None else heading[1].lower()
        if name in table.cells:
            raise InputError(argument, name, "is there twice; allowed: once")
        table.units[name] = unit
        table.cells[name] = [None if _is_missing(one) else one for one in values]
    return table


def _is_missing(value: Any) -> bool:
    """True for None, and for NaN, NA and NaT."""
    missing = value is None or type(value).__name__ in ("NAType", "NaTType")
    return missing or isinstance(value, float) and value != value


def parsed_file(argument: str, path: str | os.PathLike, parse: Callable[[bytes], T]) -> T:
    """Return parse(content of the file).  Raises InputError about the argument if the file cannot
    be read, or if `parse` raises ValueError."""
    try:
        return parse(content_of(path))
    except OSError as error:
        problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        raise InputError(argument, str(path), problem) from None
    except ValueError as error:
        raise InputError(argument, str(path), str(error)) from None


def read_table(
    content: bytes,
    names: Mapping[str, str | None],
    *,
    need_units: bool = False,
    complete: str = "",
    decimal: str = ".",
    encoding: str = "utf-8",
) -> Table:
    """Read the content of a CSV file.

    Parameters
    ----------
    content : bytes
        Content of the file.
    names : mapping of str or None
        SI unit of each allowed column: "" for pure numbers, None for texts.  The columns in LABELS
        are always allowed.
    need_units : bool
        True if the heading of a quantity must have a unit.
    complete : str
        Description of the heading if all columns are required, for messages.
    decimal, encoding : str
        Decimal mark, "." or ",", and encoding.

    Raises
    ------
    ValueError
        If the content is no text, if the heading is invalid, if units are below the heading, or if
        points may separate thousands.  The message begins with the line number.
    """
    lines, form = lines_of(content, encoding), _Form(names, need_units, complete, decimal)
    first = next((k for k, line in enumerate(lines) if is_row(k, line)), 0)
    mark = next((k for k in range(first)[::-1] if lines[k].lstrip().startswith("#")), first)
    problem, separator, units, row = _heading(lines, first, form)
    if problem and mark < first:  # a heading behind a comment mark
        hidden = _heading([*lines[:mark], lines[mark].lstrip("# \t")], mark, form)
        if not hidden[0]:
            problem, separator, units, row = *hidden[:3], first
    if problem:
        raise ValueError(problem)
    table = Table({name: [] for name in units}, units, [], {})
    quantities = [name for name in units if names.get(name) is not None]
    while row < len(lines):
        where = row + 1
        text, row = _joined(lines, row, separator)
        if not is_row(where - 1, text):
            continue
        cells = _parsed(text, separator) or []
        while len(cells) > len(units) and not cells[-1]:
            cells.pop()
        if not table.lines and not any(map(str.isdigit, text)):
            below = {n: c for n, c in zip(units, cells, strict=False) if n in quantities}
            _refuse_units(where, below, units)
        try:
            _check_count(where, len(cells), len(units), separator)
            pairs = zip(units, cells, strict=True)
            values = [_cell(where, name, cell, units[name], form) for name, cell in pairs]
        except ValueError as error:
            table.errors[len(table.lines)] = str(error)
            cells += [""] * len(units)
            pairs = zip(units, cells, strict=False)
            values = [cell or None if name in LABELS else None for name, cell in pairs]
        table.lines.append(where)
        for column, value in zip(table.cells.values(), values, strict=True):
            column.append(value)
    if "," not in (separator, decimal):
        for name in quantities:
            refuse_thousands(name, table.cells[name], table.lines)
    return table


class _Form(NamedTuple):
    """Allowed columns and format of a file; see read_table."""

    names: Mapping[str, str | None]
    need_units: bool
    complete: str
    decimal: str


def lines_of(content: bytes, encoding: str) -> list[str]:
    """Lines of a file.  Raises ValueError if the content is not text in this encoding."""
    is_utf_8 = codecs.lookup(encoding).name == "utf-8"
    if is_utf_8 and content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ValueError(f"line 1: UTF-16; {UTF_8}")
    try:
        text = content.decode("utf-8-sig" if is_utf_8 else encoding)
    except UnicodeDecodeError as error:
        where = content.count(b"\n", 0, error.start) + 1
        problem = f"byte 0x{content[error.start]:02x} is not {'UTF-8' if is_utf_8 else encoding}"
        raise ValueError(f"line {where}: {problem}; {UTF_8}") from None
    if "\0" in text:
        where = text.count("\n", 0, text.index("\0")) + 1
        raise ValueError(f"line {where}: not text; allowed: CSV or netCDF")
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def is_row(index: int, line: str) -> bool:
    """False for an empty line, a comment, and a first line that names the separator."""
    stripped = line.strip()
    names_separator = index == 0 and SEPARATOR_LINE.fullmatch(stripped)
    return not (NO_ROW.fullmatch(stripped) or names_separator)


def _heading(
    lines: list[str], index: int, form: _Form
) -> tuple[str, str, dict[str, str | None], int]:
    """What is wrong with a heading, the separator, the unit of each column, and the index of the
    line below."""
    names, need_units, complete, decimal = form
    for separator in sorted(SEPARATORS, key=decimal.__eq__):  # the comma last if it is decimal
        text, end = _joined(lines, index, separator)
        titles = _parsed(text, separator) or [text]
        while len(titles) > 1 and not titles[-1]:
            titles.pop()
        matches = [one for one in map(HEADING.fullmatch, titles) if one]
        if len(matches) == len(titles):
            break
    columns = [match[1].lower() for match in matches]
    units = {name: _unit(match) for name, match in zip(columns, matches, strict=True)}
    how = "each with its unit" if need_units else "with a unit or without"
    shown = next((f", as in {one}" for one in EXAMPLES if one.split()[0] in names), "")
    allowed = complete or f"some of {', '.join(names)}, {how}{shown}; texts: {', '.join(LABELS)}"
    if text.startswith("LabVIEW Measurement"):
        allowed += "; of a LabVIEW file keep only the table, below a heading with units"
    unknown = [name for name in columns if name not in (*names, *LABELS)]
    twice = [name for name in columns if columns.count(name) > 1]
    bare = [name for name in columns if need_units and names.get(name) and not units[name]]
    problem = ""
    if len(matches) < len(titles) or complete and sorted(columns) != sorted(names):
        problem = f"the heading is {text[:80]!r}"
    elif unknown:
        problem = f"a column {unknown[0]!r}; {near_miss(unknown[0], names)}".rstrip("; ")
    elif twice:
        problem = f"{twice[0]} is there twice"
    elif bare:
        problem, allowed = f"{bare[0]} has no unit", f"one such as {bare[0]} [{names[bare[0]]}]"
    if problem:
        problem = f"line {index + 1}: {problem}; allowed: {allowed}"
    return problem, separator, units, end


def _unit(heading: re.Match) -> str | None:
    """The unit in a heading: "" for a pure number, None without brackets."""
    unit = heading[2] if heading[3] is None else heading[3]
    return None if unit is None else "" if unit.strip() in PURE else unit.strip()


def _joined(lines: list[str], index: int, separator: str) -> tuple[str, int]:
    """The row that begins in a line, and the index of the line below it.  The lines of a quoted
    cell are joined by spaces."""
    text, end = lines[index] if lines else "", index + 1
    if text.count('"') % 2 and _parsed(text, separator) is None:
        while text.count('"') % 2 and end < min(len(lines), index + MOST_BREAKS):
            text, end = f"{text} {lines[end]}", end + 1
        if _parsed(text, separator) is None:
            text, end = lines[index], index + 1
    return text, end


def _parsed(text: str, separator: str) -> list[str] | None:
    """Cells of a row; None if the quotes are not in pairs around whole cells."""
    rows = csv.reader([text], delimiter=separator, strict=True, skipinitialspace=True)
    try:
        return [cell.strip() for cell in next(rows, [])]
    except csv.Error:
        return None


def _check_count(where: int, count: int, columns: int, separator: str) -> None:
    """Raise ValueError unless a row has a cell for each column.  count: 0 for open quotes."""
    if not count:
        allowed = "allowed are cells in whole pairs of double quotes"
        raise ValueError(f"line {where}: a double quote is open or inside a cell; {allowed}")
    if count != columns:
        hint = "; for decimal commas in quotes give decimal = ','" if count > columns else ""
        parted = f"parted by a {SEPARATORS[separator]} as in the heading"
        allowed = f"{columns}, {parted}, one with such a sign in double quotes{hint}"
        raise ValueError(f"line {where}: {count} cells; allowed: {allowed}")


def _refuse_units(where: int, row: Mapping[str, str], units: Mapping[str, str | None]) -> None:
    """Raise ValueError for a row of units below a heading without them."""
    for name, cell in row.items():
        if units[name] is None and UNIT.fullmatch(cell):
            problem = f"line {where}: {name} is {cell!r}; allowed: a number"
            example = f"{name} [{cell.strip('[]()')}]"
            raise ValueError(f"{problem}, with its unit in the heading, as in {example}")


def _cell(where: int, name: str, cell: str, unit: str | None, form: _Form) -> str | None:
    """Text of a cell with decimal points, or None if it is empty."""
    if name in LABELS or not cell:
        return cell or None
    if form.names[name] is None:
        return DECIMAL_COMMA.sub(r"\1.", cell) if form.decimal == "," else cell
    cell = with_point(where, name, cell, form.decimal)
    if unit is not None:
        number(where, name, cell, unit=unit)
    return cell


def with_point(where: int, name: str, cell: str, decimal: str) -> str:
    """Text of a cell with decimal points and hyphens for minus signs.  Raises ValueError if the
    decimal mark of a number differs from the declared one."""
    cell = cell.strip("'").strip().replace("−", "-")
    if decimal == ".":
        if re.match(r"[+-]?\d*,\d", cell, re.ASCII):
            allowed = "allowed: a decimal point, or decimal = ','"
            raise ValueError(f"line {where}: {cell!r} has a decimal comma, in {name}; {allowed}")
        return cell
    if re.search(r"\d\.\d", cell):
        allowed = "allowed: no points where commas are decimal"
        raise ValueError(f"line {where}: {name} is {cell!r}; {allowed}")
    return DECIMAL_COMMA.sub(r"\1.", cell)


def number(
    where: int, name: str, word: str, least: float = -math.inf, unit: str | None = None
) -> float:
    """Convert a word to a number.

    unit: unit in the heading, for the message.  Raises ValueError with the line number unless the
    word is a finite number of at least `least`.
    """
    if not NUMBER.fullmatch(word):
        of = f" in {unit}, the unit of the heading" if unit else ""
        raise ValueError(f"line {where}: {name} is {word[:40]!r}; allowed: a number{of}")
    value = float(word)
    if not math.isfinite(value) or value < least:
        allowed = "a finite number" + (f", {least:g} or above" if math.isfinite(least) else "")
        raise ValueError(f"line {where}: {name} is {word.lower()}; allowed: {allowed}")
    return value


def refuse_thousands(name: str, words: Iterable[str | None], lines: Iterable[int]) -> None:
    """Raise ValueError for a column in which points may be thousands separators.

    Programs with decimal commas may write 900 and 1.100 for 900 and 1100.  If commas separate the
    cells or are decimal, numbers have no such points.
    """
    grouped, plain = None, False
    for where, word in zip(lines, words, strict=True):
        if word is None or UNGROUPED.fullmatch(word):
            plain = plain or word is not None
        elif GROUPED.fullmatch(word):
            grouped = grouped or (where, word)
        elif word not in ("0", "-0", "+0"):
            return
    if grouped and plain:
        raise ValueError(
            f"line {grouped[0]}: {name} is {grouped[1]!r} beside whole numbers, so that its point "
            "may part thousands; allowed: no such points, and as many decimals in all lines"
        )
