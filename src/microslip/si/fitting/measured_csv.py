"""Measured friction as CSV: one measurement a line, under a heading with names and units.

speed [mm/s],amplitude [um],friction [N]
1,0.5,1.93
"""

from __future__ import annotations

from typing import NamedTuple

from microslip.foundation import csv_text
from microslip.foundation.errors import InputError
from microslip.si.quantities import read

COLUMNS = {
    "speed": "m/s",
    "amplitude": "m",
    "frequency": "Hz",
    "load": "N",
    "friction": "N",
    "friction_error": "N",
    "mu": "",
    "mu_error": "",
}
"""Columns that a table may have, and their units in the SI; the amplitude of a bore is in rad."""
MOST_ROWS = 10_000


class Rows(NamedTuple):
    """Rows of a table.

    columns: values in the SI by their names; labels: texts of columns that are carried through;
    lines: numbers of the lines; left_out: messages about lines that cannot be read.
    """

    columns: dict[str, list[float]]
    labels: dict[str, list[str]]
    lines: list[int]
    left_out: list[str]


def read_table(
    content: bytes, unit_of_amplitude: str, *, decimal: str = ".", encoding: str = "utf-8"
) -> Rows:
    """Rows of a table, with columns in the SI.

    Columns are parted by commas, semicolons or tabs.  Lines that are empty or begin with # do not
    count, and empty columns at the end neither.

    Parameters
    ----------
    content : bytes
        The file.
    unit_of_amplitude : str
        "m" or "rad".
    decimal, encoding : str
        The decimal mark, and the encoding of the file.

    Raises
    ------
    ValueError
        For what is no table, and where no line can be read; the message begins with the line.
    """
    lines = csv_text.lines(content, encoding)
    where, heading = next(lines, (1, ""))
    separator, names, units = _columns(where, heading)
    numbers = [name for name in names if name in COLUMNS]
    texts = [name for name in names if name not in COLUMNS]
    rows = Rows({name: [] for name in numbers}, {name: [] for name in texts}, [], [])
    thousands = csv_text.Thousands(separator if decimal == "." else ",", numbers)
    for where, line in lines:
        try:
            cells = csv_text.cells(where, line, separator, len(names))
            given = dict(zip(names, cells, strict=True))
            values = {}
            for name, unit in zip(names, units, strict=True):
                if name in COLUMNS:
                    wanted = unit_of_amplitude if name == "amplitude" else COLUMNS[name]
                    values[name] = _value(where, name, given[name], unit, wanted, decimal)
            thousands.see(where, [given[name] for name in numbers])
        except ValueError as error:
            rows.left_out.append(str(error))
            continue
        rows.lines.append(where)
        for name, value in values.items():
            rows.columns[name].append(value)
        for name in texts:
            rows.labels[name].append(given[name])
        if len(rows.lines) > MOST_ROWS:
            raise ValueError(f"line {where}: more than {MOST_ROWS} rows; allowed: at most that")
    thousands.refuse()
    if rows.left_out and not rows.lines:
        raise ValueError(rows.left_out[0])
    return rows


def _columns(where: int, heading: str) -> tuple[str, list[str], list[str]]:
    """Separator, names and units of the columns."""
    allowed = f"allowed: some of {', '.join(COLUMNS)}, each with its unit, as in speed [mm/s]"
    separator, columns = csv_text.columns(where, heading, COLUMNS, allowed)
    for name, unit in columns:
        if COLUMNS.get(name) and not unit:
            raise ValueError(f"line {where}: {name} has no unit; {allowed}")
    names, units = zip(*((name, unit or "") for name, unit in columns), strict=True)
    return separator, list(names), ["" if unit in csv_text.PURE else unit for unit in units]


def _value(where: int, name: str, cell: str, unit: str, wanted: str, decimal: str) -> float:
    if not cell:
        allowed = "allowed: a number in every row; leave out the row, or fill the cell"
        raise ValueError(f"line {where}: {name} is empty; {allowed}")
    text = f"{csv_text.with_point(where, name, cell, decimal)} {unit}".strip()
    low = -float("inf") if name in ("friction", "mu") else 0.0
    open_below = name not in ("speed", "amplitude", "friction", "mu")
    try:
        return read(name, text, wanted, low=low, low_open=open_below).si
    except InputError as error:
        raise ValueError(f"line {where}: {error}") from None
