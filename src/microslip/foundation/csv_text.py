"""CSV as people write it: lines that count, words of a line, points that may part thousands."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence

SEPARATORS = {",": "comma", ";": "semicolon", "\t": "tab"}
HEADING = re.compile(r"(\w+)\s*(?:\[([^\]]*)\]|\(([^()]*)\))?")
"""The name of a column, with its unit in brackets or without."""
ENCODING = "allowed: UTF-8, which spreadsheets call CSV UTF-8"
PURE = {"", "1", "-"}
"""Units that say that there is none."""
SPREADSHEET_ERROR = re.compile(r"#(N/A|NV|[A-Z/0]+[!?])")
"""What spreadsheets write into a cell without a value, such as #N/A and #DIV/0!."""
GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(\.\d{3})+", re.A)
"""A number with points between thousands, or with three decimals."""
UNGROUPED = re.compile(r"[+-]?[1-9]\d{0,2}", re.A)


def lines(content: bytes) -> Iterator[tuple[int, str]]:
    """Number and text of each line that counts: not those that are empty or begin with #.

    Raises
    ------
    ValueError
        For what is no text in UTF-8; the message begins with the line.
    """
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise ValueError(f"line 1: UTF-16; {ENCODING}")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        byte = f"byte 0x{content[error.start]:02x}"
        raise ValueError(f"line {line}: {byte} is not UTF-8; {ENCODING}") from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise ValueError(f"line {line}: not text; allowed: CSV or netCDF")
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    for number, line in enumerate(text.split("\n"), 1):
        text = line.strip()
        if text and (not text.startswith("#") or SPREADSHEET_ERROR.match(text)):
            yield number, line.rstrip()


def words(line: str, separator: str) -> list[str]:
    """The cells of a line, without spaces and quotes around them."""
    return [word.strip().strip("\"'").strip() for word in line.split(separator)]


def columns(
    where: int, heading: str, names: Collection[str], allowed: str
) -> tuple[str, list[tuple[str, str | None]]]:
    """The separator of a table, and name and unit of each of its columns, None without brackets.

    Raises
    ------
    ValueError
        For a heading that is none, a column that is not among the names, and one that is there
        twice; the message begins with the line and ends with what is allowed.
    """
    for separator in SEPARATORS:
        found = [HEADING.fullmatch(word) for word in words(heading, separator)]
        if all(found) and (len(found) > 1 or separator == ","):
            break
    else:
        raise ValueError(f"line {where}: the heading is {heading[:80]!r}; {allowed}")
    given = [match[1].lower() for match in found]
    for name in given:
        if name not in names:
            raise ValueError(f"line {where}: a column {name!r}; {allowed}")
        if given.count(name) > 1:
            raise ValueError(f"line {where}: {name} is there twice; allowed: once")
    units = [match[2] if match[3] is None else match[3] for match in found]
    units = [unit and unit.strip() for unit in units]
    return separator, list(zip(given, units, strict=True))


def row(where: int, line: str, separator: str, order: Sequence[int]) -> list[str]:
    """The cells of a line in another order; raises ValueError unless there are as many."""
    cells = words(line, separator)
    if separator != "," and "," in line:
        word = next(word for word in cells if "," in word)
        raise ValueError(f"line {where}: {word!r} has a decimal comma; allowed: a decimal point")
    if len(cells) != len(order):
        hint = "; decimal commas are not allowed" if len(cells) > len(order) else ""
        raise ValueError(
            f"line {where}: {len(cells)} values; allowed: {len(order)}, parted by a "
            f"{SEPARATORS[separator]} as in the heading{hint}"
        )
    return [cells[i] for i in order]


class Thousands:
    """Finds columns in which points may part thousands, beside numbers that have none.

    Where commas are decimal, 900 and 1.100 may be 900 and 1100, and then none is a decimal number.
    Commas as separators tell that they are not decimal.
    """

    def __init__(self, separator: str, columns: Sequence[str]):
        self.columns = tuple(columns)
        self.possible = dict.fromkeys(columns if separator != "," else ())
        self.plain = set()

    def see(self, where: int, cells: Sequence[str]) -> None:
        """Take the cells of a line into account, in the order of the columns."""
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
        """Raise ValueError for the first column in which points may part thousands."""
        for name, first in self.possible.items():
            if first and name in self.plain:
                where, word = first
                raise ValueError(
                    f"line {where}: {name} is {word!r} beside whole numbers, so that its point may "
                    "part thousands; allowed: no such points, and as many decimals in all lines"
                )
