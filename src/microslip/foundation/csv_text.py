"""Reading of CSV files with units in headings, labels, decimal commas, and empty rows and
columns."""

from __future__ import annotations

import codecs
import csv
import re
from collections.abc import Callable, Iterator, Sequence

from microslip.foundation.errors import InputError

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
HEADING = re.compile(r"(\w+)\s*(?:\[([^\]]*)\]|\(([^()]*)\))?")
"""Pattern of the heading of a column, with or without a unit in brackets."""
PURE = ("", "1", "-")
"""Units in a heading that stand for a pure number."""
ENCODING = "allowed: UTF-8, which spreadsheets call CSV UTF-8, or the encoding of the file by name"
DECIMALS = (".", ",")
SPREADSHEET_ERROR = re.compile(r"#(N/A|NV|[A-Z/0]+[!?])")
"""Pattern of the texts that spreadsheets write in a cell without a value, such as #N/A and
#DIV/0!."""
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+", re.A)
"""Pattern of a number such as 1.100, where the point can be a thousands separator or a decimal
mark."""
UNGROUPED = re.compile(r"[+-]?[1-9]\d{0,2}", re.A)
EMPTY = re.compile(r"[\s,;\"]*")
"""Pattern of a line of empty cells."""
SEPARATOR_LINE = re.compile(r"\"?sep=.\"?", re.I)
"""Pattern of the first line that names the separator for a spreadsheet."""
UNIT = re.compile(r"[\[(]?[^\W\d_][^\s,;]*[\])]?")
"""Pattern of a cell that may be a unit."""
OPEN_CELL = re.compile(r'(?:^|([,;\t]))\s*"[^"]*$')
"""Pattern of a line that ends inside a quoted cell."""
MOST_BREAKS = 100
"""Largest number of lines of a quoted cell."""
DECIMAL_COMMA = re.compile(r"(?<=[0-9]),(?=[0-9])|^([+−-]?),(?=[0-9])")


def check_format(decimal: str, encoding: str) -> None:
    """Raise InputError for an unknown decimal mark or encoding."""
    if decimal not in DECIMALS:
        raise InputError("decimal", decimal, "allowed is '.' or ','")
    try:
        codecs.lookup(encoding)
        "".encode(encoding)  # refuses encodings from bytes to bytes
    except (LookupError, TypeError, ValueError):
        allowed = "allowed is the name of an encoding, such as utf-8 or cp1252"
        raise InputError("encoding", encoding, allowed) from None


def lines(
    content: bytes,
    encoding: str = "utf-8",
    is_heading: Callable[[str], bool] = lambda text: False,
) -> Iterator[tuple[int, str]]:
    """Line number and text of each line.

    Empty lines, comments that begin with #, and a first line such as sep=; are omitted.  The lines
    of a quoted cell are joined by spaces.  The comment above the first line is a line if it is a
    heading, and the first line is none.

    Raises
    ------
    ValueError
        If the content is not text in this encoding.  The message begins with the line number.
    """
    is_utf_8 = codecs.lookup(encoding).name == "utf-8"
    if is_utf_8 and content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ValueError(f"line 1: UTF-16; {ENCODING}")
    try:
        text = content.decode("utf-8-sig" if is_utf_8 else encoding)
    except UnicodeDecodeError as error:
        where = content.count(b"\n", 0, error.start) + 1
        byte = f"byte 0x{content[error.start]:02x}"
        name = "UTF-8" if is_utf_8 else encoding
        raise ValueError(f"line {where}: {byte} is not {name}; {ENCODING}") from None
    if "\0" in text:
        where = text.count("\n", 0, text.index("\0")) + 1
        raise ValueError(f"line {where}: not text; allowed: CSV or netCDF")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    comment, first = (0, ""), True
    for number, line in _joined(text.split("\n")):
        stripped = line.strip()
        if EMPTY.fullmatch(stripped) or number == 1 and SEPARATOR_LINE.fullmatch(stripped):
            continue
        if stripped.startswith("#") and not SPREADSHEET_ERROR.match(stripped):
            comment = number, stripped.lstrip("#").strip()
            continue
        if first and is_heading(comment[1]) and not is_heading(line):
            yield comment
        first = False
        yield number, line


def _joined(parts: list[str]) -> Iterator[tuple[int, str]]:
    """Number and text of each line.  The lines of a quoted cell are one line."""
    number = 0
    while number < len(parts):
        line, end = parts[number], number + 1
        begin = OPEN_CELL.search(line)
        while OPEN_CELL.search(line) and line.count('"') % 2 and end < len(parts):
            line, end = f"{line} {parts[end]}", end + 1
            if end - number > MOST_BREAKS:
                break
        separators = begin[1] if begin and begin[1] else SEPARATORS
        if end > number + 1 and not any(_are_cells(line, one) for one in separators):
            line, end = parts[number], number + 1
        yield number + 1, line
        number = end


def _are_cells(line: str, separator: str) -> bool:
    """True if all quotes of a line are in pairs around whole cells."""
    try:
        return bool(list(csv.reader([line], delimiter=separator, strict=True)))
    except csv.Error:
        return False


def heading_hint(heading: str) -> str:
    """What to change in a file whose heading is not accepted; empty if unknown."""
    if heading.startswith("LabVIEW Measurement"):
        return "; of a LabVIEW file keep only the table, below a heading with units"
    return ""


def all_words(line: str, separator: str) -> list[str]:
    """Cells of a line, without surrounding spaces and quotes."""
    return [word.strip().strip("\"'").strip() for word in line.split(separator)]


def words(line: str, separator: str) -> list[str]:
    """Cells of the heading line, without surrounding spaces and quotes.  Empty cells at the end are
    omitted."""
    cells = all_words(line, separator)
    while len(cells) > 1 and not cells[-1]:
        cells.pop()
    return cells


def headings(line: str, decimal: str) -> Iterator[tuple[str, list[re.Match]]]:
    """Separators that split a line into headings of columns, each with the matches of HEADING.

    The comma is the last separator if it is the decimal mark, because a file with a single column
    then has commas only in its numbers.
    """
    for separator in sorted(SEPARATORS, key=decimal.__eq__):
        parts = words(line, separator)
        matches = [match for match in map(HEADING.fullmatch, parts) if match]
        if len(matches) == len(parts):
            yield separator, matches


def cells(where: int, line: str, separator: str, count: int) -> list[str]:
    """Cells of a line.  Additional empty cells at the end are omitted.  Raises ValueError unless
    `count` cells remain."""
    try:
        rows = csv.reader([line], delimiter=separator, strict=True, skipinitialspace=True)
        cells = [cell.strip() for cell in next(rows)]
    except csv.Error as error:
        allowed = "allowed are cells in whole pairs of double quotes, within one line"
        raise ValueError(f"line {where}: {error}; {allowed}") from None
    while len(cells) > count and not cells[-1]:
        cells.pop()
    if len(cells) != count:
        parted = f"parted by a {SEPARATORS[separator]} as in the heading"
        hint = "; for decimal commas in quotes give decimal = ','" if len(cells) > count else ""
        allowed = f"{count}, {parted}, one with such a sign in double quotes{hint}"
        raise ValueError(f"line {where}: {len(cells)} cells; allowed: {allowed}")
    return cells


def refuse_units(where: int, pairs: Sequence[tuple[str, str]]) -> None:
    """Raise ValueError about a line of units below the heading.  pairs: heading and cell."""
    example = next(((name, cell) for name, cell in pairs if UNIT.fullmatch(cell)), None)
    if example is not None:
        name, cell = example[0], example[1].strip("[]()")
        problem = f"line {where}: {name} is {cell!r}; allowed: a number"
        raise ValueError(f"{problem}, with its unit in the heading, as in {name} [{cell}]")


def with_point(where: int, name: str, cell: str, decimal: str) -> str:
    """Text of a cell, with decimal points in all numbers.

    Raises ValueError if the decimal mark of a number differs from the declared one.
    """
    cell = cell.strip("'").strip()
    if decimal == ".":
        if re.match(r"[+−-]?\d*,\d", cell, re.ASCII):
            allowed = "allowed: a decimal point, or decimal = ','"
            raise ValueError(f"line {where}: {cell!r} has a decimal comma, in {name}; {allowed}")
        return cell
    if re.search(r"\d\.\d", cell):
        allowed = "allowed: no points where commas are decimal"
        raise ValueError(f"line {where}: {name} is {cell!r}; {allowed}")
    return DECIMAL_COMMA.sub(r"\1.", cell)


class Thousands:
    """Detector of columns in which points may be thousands separators.

    Programs with decimal commas may write 900 and 1.100 for 900 and 1100.  No column is refused if
    commas separate the cells, or if `decimal` is a comma, because numbers then have no points.
    """

    def __init__(self, separator: str, decimal: str, columns: Sequence[str]):
        self.columns = tuple(columns)
        self.possible = dict.fromkeys(columns if "," not in (separator, decimal) else ())
        self.plain: set[str] = set()

    def see(self, where: int, cells: Sequence[str]) -> None:
        """Add the cells of a line, in the order of the columns."""
        for name, word in zip(self.columns, cells, strict=True):
            if name not in self.possible:
                continue
            if UNGROUPED.fullmatch(word):
                self.plain.add(name)
            elif GROUPED.fullmatch(word):
                self.possible[name] = self.possible[name] or (where, word)
            elif word not in ("0", "-0", "+0"):
                del self.possible[name]

    def refuse(self) -> None:
        """Raise ValueError for the first column in which points may be thousands separators."""
        for name, first in self.possible.items():
            if first and name in self.plain:
                where, word = first
                raise ValueError(
                    f"line {where}: {name} is {word!r} beside whole numbers, so that its point may "
                    "part thousands; allowed: no such points, and as many decimals in all lines"
                )
