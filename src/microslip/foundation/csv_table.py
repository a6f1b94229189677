"""Tables in CSV files, mappings and DataFrames.

load [N],speed [mm/s],counterbody
10,1,steel
20,1,"70 GPa, 0.22"

Commas, semicolons or tabs separate the columns.  A heading is a name, with or without a unit in
brackets.  In a name, hyphens and spaces count as underscores.  Empty lines, lines that begin with
#, a first line such as "sep=;" and empty columns at the end are ignored.  The heading can also be a
comment directly above the first line.

`pandas.read_csv` accepts invalid lines.  Under the heading "load [N],mu", pandas reads the line "1"
as a load without a mu, and the line "1,5,0.3" as a load of 5.  If a quote is not closed, pandas
rejects the whole file.  Pandas also renames duplicate columns.  The error messages of pandas do not
contain the line number of a cell.
"""

from __future__ import annotations

import csv
import math
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from microslip.foundation.errors import InputError
from microslip.foundation.files import content_of
from microslip.foundation.spec import near_miss

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
LABELS = ("label", "name", "id", "sample", "comment")
"""Columns of text that are copied to the output."""
PURE = ("", "1", "-")
"""Accepted units in the heading of a column of pure numbers."""
HEADING = re.compile(r"(\w+(?:[ -]+\w+)*)\s*(?:\[([^\]]*)\]|\(([^()]*)\))?")
NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.I | re.A)
NO_ROW = re.compile(r"[\s,;\"]*|\s*#(?!(N/A|NV|[A-Z/0]+[!?])).*")
"""Pattern of a comment, or of a line without cells.  #N/A and #DIV/0! are cells of spreadsheets,
not comments."""
SEPARATOR_LINE = re.compile(r"\s*\"?sep=.\"?\s*", re.I)
EXAMPLES = ("speed [mm/s]", "forward [um]")
"""Headings that messages show as examples."""
UNIT = re.compile(r"[\[(]?[^\W\d_][^\s,;]*[\])]?")
"""Pattern of a cell that may be a unit."""
DECIMAL_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])|^([+-]?),(?=[0-9])")
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})*", re.A)
"""Pattern of a number in which each point can be a thousands separator, such as 1.100.  The pattern
also matches numbers without a point, such as 900."""
Rows = Iterator[tuple[int, list[str]]]
"""Line number and cells of each row.  A row has no cells if its quotes are not in pairs."""
UTF_8 = "allowed: UTF-8, which spreadsheets call CSV UTF-8, or the encoding of the file by name"
SOURCES = "allowed is a path, a DataFrame of pandas, or a mapping of names to sequences"


@dataclass(frozen=True)
class Table:
    """A table of cells.

    Attributes
    ----------
    cells : dict of list
        Cells of each column, keyed by its name in lower case.  Cells of a file are strings with
        decimal points.  An empty cell is None.
    units : dict of str or None
        Unit of each column: "" for a pure number, None for a heading without brackets.
    lines : list of int
        Line number of each row, starting at 1; empty without a file.
    errors : dict of str
        Error messages of invalid rows, keyed by the index of the row.  The cells of these rows are
        None.
    """

    cells: dict[str, list[Any]]
    units: dict[str, str | None]
    lines: list[int]
    errors: dict[int, str]

    @property
    def columns(self) -> dict[str, list[Any]]:
        """The cells of each column.  Each cell includes the unit of the heading, as in "10 N"."""
        return {n: [_with_unit(c, self.units[n]) for c in one] for n, one in self.cells.items()}

    @property
    def labels(self) -> dict[str, list[Any]]:
        return {name: cells for name, cells in self.cells.items() if name in LABELS}

    def numbers(self, least: Mapping[str, float] | None = None) -> dict[str, list[float]]:
        """Return the cells of each column as finite numbers.

        least: smallest allowed number of a column, keyed by its name.  Raises ValueError if a row
        is invalid.
        """
        for problem in self.errors.values():
            raise ValueError(problem)
        limits = dict.fromkeys(self.cells, -math.inf) | dict(least or {})
        columns = {n: zip(self.lines, cells, strict=True) for n, cells in self.cells.items()}
        return {
            n: [_number(f"line {k}: {n}", c or "", limits[n]) for k, c in one]
            for n, one in columns.items()
        }


def _with_unit(cell: Any, unit: str | None) -> Any:
    return cell if cell is None or unit is None else f"{cell} {unit}".rstrip()


def source_name(source: Any) -> str | list:
    """Return the name of a table for messages: the path, or the names of the columns."""
    return str(source) if isinstance(source, str | os.PathLike) else list(source)


def check_format(decimal: str, encoding: str) -> None:
    """Raise InputError for an unknown decimal mark or encoding."""
    if not isinstance(decimal, str) or decimal not in (".", ","):
        raise InputError("decimal", decimal, "allowed is '.' or ','")
    try:
        "".encode(encoding)  # refuses encodings from bytes to bytes
    except (LookupError, TypeError, ValueError):
        allowed = "allowed is the name of an encoding, such as utf-8 or cp1252"
        raise InputError("encoding", encoding, allowed) from None


def table_of(argument: str, source: Any, names: Mapping[str, str | None], **form: Any) -> Table:
    """Read a table from a file or from columns.

    Parameters
    ----------
    argument : str
        Name of the table in messages.
    source : path, mapping or pandas DataFrame
        A file, or columns with headings such as "load [N]".
    names, form
        See `read_table`.  If the source is not a file, columns other than `names` are allowed.

    Raises
    ------
    InputError
        If the table is invalid, or the file has no valid row.
    """
    check_format(form.get("decimal", "."), form.get("encoding", "utf-8"))
    if isinstance(source, str | os.PathLike):
        try:
            table = read_table(content_of(source), names, **form)
            if len(table.errors) < len(table.lines):
                return table
            problem = [*table.errors.values(), "no line follows the heading; allowed: some"][0]
            problem += f"; all {len(table.lines)} lines are invalid" * (len(table.lines) > 1)
        except OSError as error:
            problem = f"cannot be read ({error.strerror}); allowed is a file of CSV"
        except ValueError as error:
            problem = str(error)
        raise InputError(argument, str(source), problem)
    if not (isinstance(source, Mapping) or hasattr(source, "iloc") and hasattr(source, "columns")):
        raise InputError(argument, source, SOURCES)
    if form.get("decimal", ".") != ".":
        raise InputError("decimal", ",", "allowed for a file; pandas.read_csv has the same option")
    table = Table({}, {}, [], {})
    for title, values in source.items():
        if not isinstance(title, str):
            allowed = "names of columns must be texts, such as 'load [N]'"
            raise InputError(argument, title, allowed)
        if isinstance(values, str | bytes) or not hasattr(values, "__len__"):
            raise InputError(title, values, "allowed is a sequence of one value for each row")
        name, unit = _name_and_unit(title) or (title, None)
        if name in table.cells:
            raise InputError(argument, name, "is there twice; allowed: once")
        table.units[name] = unit
        table.cells[name] = [None if _is_missing(one) else one for one in values]
    if len(counts := {*map(len, table.cells.values())}) > 1:
        allowed = f"columns of {' and '.join(map(str, sorted(counts)))} values; allowed are "
        raise InputError(argument, list(table.cells), f"{allowed}columns of one length")
    return table


def _is_missing(value: Any) -> bool:
    """Return True for None, NaN, NA and NaT."""
    missing = type(value).__name__ in ("NoneType", "NAType", "NaTType")
    return missing or isinstance(value, float) and value != value


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
        SI unit of each allowed column, keyed by name: "" for pure numbers, None for text.  The
        columns in LABELS are always allowed.
    need_units : bool
        If True, the heading of every quantity must have a unit.
    complete : str
        Description of the heading, for messages.  If it is not empty, all columns are required.
    decimal, encoding : str
        Decimal mark, "." or ",", and encoding.

    Raises
    ------
    ValueError
        If the content is not text, if the heading is invalid, if units are below the heading, or if
        points may be thousands separators.  The message begins with the line number.
    """
    lines = lines_of(content, encoding)
    if SEPARATOR_LINE.fullmatch(lines[0]):
        lines[0] = ""
    first = next((k for k, line in enumerate(lines) if not NO_ROW.fullmatch(line)), 0)
    comments = [k for k in range(first) if lines[k].strip()[:1] == "#" and '"' not in lines[k]]
    problems = []
    for k in (first, *comments[-1:]):
        if k in comments:  # a heading behind a comment mark
            lines[k] = lines[k].lstrip("# \t")
        separator, titles, rows = _heading(lines, k, decimal)
        problems.append(_heading_problem(lines[k], titles, names, need_units, complete))
        if not problems[-1]:
            break
    else:
        raise ValueError(f"line {first + 1}: {problems[0]}")
    units = dict(filter(None, map(_name_and_unit, titles)))
    quantities = [name for name in units if names.get(name) is not None]
    table = Table({name: [] for name in units}, units, [], {})
    for where, cells in rows:
        while len(cells) > len(units) and not cells[-1]:
            cells.pop()
        row = dict.fromkeys(units, "") | dict(zip(units, cells, strict=False))
        for name in [] if table.lines or any(map(str.isdigit, "".join(cells))) else quantities:
            if units[name] is None and UNIT.fullmatch(row[name]):
                unit = row[name].strip("[]()")
                allowed = f"a number, with its unit in the heading, as in {name} [{unit}]"
                raise ValueError(f"line {where}: {name} is {row[name]!r}; allowed: {allowed}")
        try:
            if len(cells) != len(units):
                raise ValueError(_count_problem(where, len(cells), len(units), separator, decimal))
            for name in [one for one in units if row[one] and one not in LABELS]:
                cell = row[name]
                if name in quantities:
                    row[name] = _with_point(where, name, cell, decimal)
                if decimal == ",":
                    row[name] = DECIMAL_COMMA.sub(r"\1.", row[name])
                if name in quantities and units[name] is not None:
                    of = f" in {units[name]}, the unit of the heading" * bool(units[name])
                    _number(f"line {where}: {name}", row[name], of=of, cell=cell)
        except ValueError as error:
            table.errors[len(table.lines)] = str(error)
            row = {name: cell if name in LABELS else "" for name, cell in row.items()}
        table.lines.append(where)
        for name, cell in row.items():
            table.cells[name].append(cell or None)
    for name in quantities if "," not in (separator, decimal) else ():
        _refuse_thousands(name, dict(zip(table.lines, table.cells[name], strict=True)))
    return table


def lines_of(content: bytes, encoding: str) -> list[str]:
    """Return the lines of a file.  Raises ValueError if the content is not text in this
    encoding."""
    try:
        text = content.decode(encoding).removeprefix("\ufeff")
    except UnicodeDecodeError as error:
        where = content.count(b"\n", 0, error.start) + 1
        problem = f"byte 0x{content[error.start]:02x} is not {encoding.upper()}"
        if content.startswith((b"\xff\xfe", b"\xfe\xff")):
            problem = "UTF-16"
        raise ValueError(f"line {where}: {problem}; {UTF_8}") from None
    before, zero, _ = text.partition("\0")
    if zero:
        raise ValueError(f"line {before.count(chr(10)) + 1}: not text; allowed: CSV or netCDF")
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _heading(lines: list[str], index: int, decimal: str) -> tuple[str, list[str], Rows]:
    """Read the heading that begins on a given line.  Returns the separator, the cells of the
    heading, and the rows below the heading.  The separator is the first one for which all cells are
    headings.  If there is no such separator, it is the one with the most cells."""
    readings = []
    for separator in sorted(SEPARATORS, key=decimal.__eq__):  # the comma last if it is decimal
        rows = _rows(lines, index, separator)
        titles = next(rows, (0, []))[1]
        while len(titles) > 1 and not titles[-1]:
            titles.pop()
        readings.append((separator, titles, rows))
    return max(readings, key=lambda one: (all(map(_name_and_unit, one[1])), len(one[1])))


def _rows(lines: list[str], index: int, separator: str) -> Rows:
    """Yield the line number and the cells of each row, beginning with a given line.  A quoted cell
    can have several lines, which are joined by spaces.  Such a cell ends on the next line that
    contains an odd number of quotes."""
    while index < len(lines):
        where, text, cells = index + 1, lines[index], _cells(lines[index], separator)
        if not cells and text.count('"') % 2:
            odd = (k for k in range(where, len(lines)) if lines[k].count('"') % 2)
            end = next(odd, index)
            joined = " ".join(lines[index : end + 1])
            if more := _cells(joined, separator):
                text, cells, index = joined, more, end
        index += 1
        if not NO_ROW.fullmatch(text):
            yield where, cells


def _cells(text: str, separator: str) -> list[str]:
    """Return the cells of a row.  The list is empty if a quote has no partner, or if a pair of
    quotes does not enclose a whole cell."""
    rows = csv.reader([text], delimiter=separator, strict=True, skipinitialspace=True)
    try:
        return [cell.strip() for cell in next(rows, [])]
    except csv.Error:
        return []


def _heading_problem(
    line: str, titles: list[str], names: Mapping[str, str | None], need_units: bool, complete: str
) -> str:
    """Return a message about an invalid heading of a table, or an empty string if the heading is
    valid."""
    heads = [_name_and_unit(title) or (title, None) for title in titles]
    columns = [name for name, _ in heads]
    how = "each with its unit" if need_units else "with a unit or without"
    shown = next((f", as in {one}" for one in EXAMPLES if one.split()[0] in names), "")
    allowed = complete or f"some of {', '.join(names)}, {how}{shown}; texts: {', '.join(LABELS)}"
    if line.startswith("LabVIEW Measurement"):
        allowed += "; of a LabVIEW file keep only the table, below a heading with units"
    if not titles or complete and sorted(columns) != sorted(names):
        return f"the heading is {line.strip()[:80]!r}; allowed: {allowed}"
    for title, (name, unit) in zip(titles, heads, strict=True):
        if name not in (*names, *LABELS):
            hint = near_miss(name, names).replace("? ", "?; ")
            return f"the heading has a column {title!r}; {hint}allowed: {allowed}"
        if columns.count(name) > 1:
            return f"{name} is there twice; allowed: {allowed}"
        if need_units and names.get(name) and not unit:
            return f"{name} has no unit; allowed: one such as {name} [{names[name]}]"
    return ""


def _name_and_unit(title: str) -> tuple[str, str | None] | None:
    """Return the name (in lower case, with underscores) and the unit from a heading.  The unit is
    "" for a pure number, and None if the heading has no brackets.  If the string is not a heading,
    the result is None."""
    match = HEADING.fullmatch(title)
    if match is None:
        return None
    unit = match[2] if match[3] is None else match[3]
    name = re.sub("[ -]+", "_", match[1].lower())
    return name, None if unit is None else "" if unit.strip() in PURE else unit.strip()


def _count_problem(where: int, count: int, columns: int, separator: str, decimal: str) -> str:
    """Return a message about a row with a wrong number of cells.  `count` is the number of cells,
    or 0 if a quote is not closed."""
    what = f"{count} cells" if count else "a double quote is open or inside a cell"
    hint = "; for decimal commas, give decimal = ','" if count > columns and decimal == "." else ""
    allowed = f"{columns}, parted by a {SEPARATORS[separator]} as in the heading, one with such a "
    return f"line {where}: {what}; allowed: {allowed}sign in a pair of double quotes{hint}"


def _with_point(where: int, name: str, cell: str, decimal: str) -> str:
    """Return the string of a cell, with a decimal point and with a hyphen as the minus sign.
    Raises ValueError if the decimal mark of a number differs from the declared one."""
    cell = cell.strip("'").strip().replace("−", "-")
    if decimal == "." and re.match(r"[+-]?\d*,\d", cell, re.ASCII):
        allowed = "allowed: a decimal point, or decimal = ','"
        raise ValueError(f"line {where}: {cell!r} has a decimal comma, in {name}; {allowed}")
    if decimal == "," and re.search(r"\d\.\d", cell):
        allowed = "allowed: no points where commas are decimal"
        raise ValueError(f"line {where}: {name} is {cell!r}; {allowed}")
    return cell


def _number(what: str, word: str, least: float = -math.inf, of: str = "", cell: str = "") -> float:
    """Convert a word to a number.

    what: line and column, for messages.  of: words about the unit in the heading, for messages.
    cell: the word as written in the file, if it differs.  Raises ValueError if the word is not a
    finite number, or if the number is below `least`.
    """
    if not NUMBER.fullmatch(word):
        raise ValueError(f"{what} is {(cell or word)[:40]!r}; allowed: a number{of}")
    value = float(word)
    if not math.isfinite(value) or value < least:
        allowed = "a finite number" + (f", {least:g} or above" if math.isfinite(least) else "")
        raise ValueError(f"{what} is {word.lower()}; allowed: {allowed}")
    return value


def _refuse_thousands(name: str, words: Mapping[int, str | None]) -> None:
    """Raise ValueError for a column in which points may be thousands separators.

    Programs with decimal commas may use points as thousands separators.  Such programs write 1100
    as 1.100, but 900 without a point.  The check is not needed in two cases: commas separate the
    cells, or commas are declared as decimal marks.
    """
    cells = [(k, word) for k, word in words.items() if word and word.lstrip("+-") != "0"]
    points = [(k, word) for k, word in cells if "." in word]
    if 0 < len(points) < len(cells) and all(GROUPED.fullmatch(word) for _, word in cells):
        raise ValueError(
            f"line {points[0][0]}: {name} is {points[0][1]!r} beside whole numbers, so that its "
            "point may part thousands; allowed: no such points, and as many decimals in all lines"
        )
