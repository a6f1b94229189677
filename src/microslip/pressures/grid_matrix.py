"""Read a grid of pressures from a matrix of numbers without coordinates.  Programs for pressure
sensors and pressure films write such files."""

from __future__ import annotations

import numpy as np

from microslip.foundation import csv_text
from microslip.foundation.number_table import NUMBER, number
from microslip.pressures.grid_units import COLUMNS, MOST_POINTS, Units, read_pitch

OUTSIDE = "B"
"""Content of cells outside the sensor in Tekscan files.  Its pressure is 0."""
END = ["@@"]
"""Last line of Tekscan files, as a list of cells."""
LEAST_COORDINATES = 4
"""Smallest number of evenly spaced values that count as coordinates.  Three pressures can be evenly
spaced by chance."""
EVEN = 0.05
"""Largest difference between the steps of evenly spaced coordinates, divided by the first step.  It
allows for coordinates rounded to 1/40 of their step, because rounding changes a step by at most one
unit of the last place."""
ALLOWED = (
    "allowed: a header without numbers in columns, then one row of the matrix in each line up to "
    "the end of the file, with decimal=comma after the path for decimal commas"
)


def grid(
    content: bytes, pitch: str, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]:
    """Return the coordinates (n,) and (m,), the pressures (n, m) and the Units of a matrix.

    The forward coordinate increases from line to line, and the lateral coordinate increases from
    cell to cell.  Commas, semicolons, tabs or spaces separate the cells.  Lines above the matrix
    are ignored.

    Parameters
    ----------
    content : bytes
        Content of the file.
    pitch : str
        Distance between the cells, see grid_units.read_pitch.
    decimal, encoding : str
        Decimal mark and encoding of the file.

    Raises
    ------
    ValueError
        If a line is neither a header nor a row of the matrix, or if the matrix contains
        coordinates.
    """
    forward, lateral, units = read_pitch(pitch)
    lines = [(n, *_split(line, decimal)) for n, line in csv_text.lines(content, encoding)]
    if lines and _trimmed(lines[-1][-1]) == END:
        lines.pop()
    filled = [[cell for cell in cells if cell] for *_, cells in lines]
    header = next((i for i, cells in enumerate(filled) if all(map(_is_number, cells))), None)
    if header is None:
        raise ValueError(f"no row of numbers; {ALLOWED}")
    widest = max(len(_trimmed(cells)) for *_, cells in lines[header:])
    for where, _, cells in lines[header:]:
        if "" in cells[:widest]:
            empty = f"cell {cells.index('') + 1} is empty; {ALLOWED}, with 0 where nothing presses"
            raise ValueError(f"line {where}: {empty}")
    lines = [(where, separator, _trimmed(cells)) for where, separator, cells in lines]
    start, separator, first = lines[header]
    for where, own, cells in lines[:header]:
        titles = filter(None, map(csv_text.HEADING.fullmatch, cells))
        if {title[1].lower() for title in titles} == set(COLUMNS):
            raise ValueError(f"line {where}: a heading of columns; allowed without pitch only")
        count = sum(map(_is_number, cells))
        if own == separator and (count > 1 or count and len(cells) == len(first)):
            text = next(cell for cell in cells if not _is_number(cell))
            raise ValueError(f"line {where}: {text[:40]!r} between numbers; {ALLOWED}")
    rows, thousands = [], csv_text.Thousands(separator, decimal, ["pressure"])
    for expected, (where, _, cells) in enumerate(lines[header:], start):
        if where != expected:
            raise ValueError(f"line {expected}: no row of the matrix; {ALLOWED}")
        if len(cells) != len(first):
            problem = f"{len(cells)} cells, but {len(first)} in line {start}"
            raise ValueError(f"line {where}: {problem}; {ALLOWED}")
        words = [csv_text.with_point(where, "pressure", cell, decimal) for cell in cells]
        words = ["0" if word == OUTSIDE else word for word in words]
        rows.append([number(where, "pressure", word, 0.0) for word in words])
        if len(rows) * len(first) > MOST_POINTS:
            raise ValueError(f"line {where}: more than {MOST_POINTS} points; allowed: at most that")
        for word in words:
            thousands.see(where, [word])
    thousands.refuse()
    values = np.array(rows)
    if min(values.shape) < 2:
        shape = " x ".join(map(str, values.shape))
        raise ValueError(f"a matrix of {shape}; allowed: two rows and two columns, or more")
    for side, numbers in (("row", values[0]), ("column", values[:, 0])):
        if _are_coordinates(numbers[1:]):
            allowed = "allowed: pressures alone, or columns forward,lateral,pressure without pitch"
            raise ValueError(f"the numbers of the first {side} look like coordinates; {allowed}")
    n, m = values.shape
    return (np.arange(n) * forward, np.arange(m) * lateral, values), units


def _split(line: str, decimal: str) -> tuple[str, list[str]]:
    """Return the separator of a line, and its cells."""
    separators = [";", "\t"] + [","] * (decimal == ".")
    for separator in filter(line.__contains__, separators):
        return separator, csv_text.all_words(line, separator)
    return " ", line.split()


def _trimmed(cells: list[str]) -> list[str]:
    """Cells without empty last cells."""
    while len(cells) > 1 and not cells[-1]:
        cells = cells[:-1]
    return cells


def _is_number(cell: str) -> bool:
    """True if a cell is a number, with either decimal mark."""
    return cell == OUTSIDE or bool(NUMBER.fullmatch(csv_text.DECIMAL_COMMA.sub(r"\1.", cell)))


def _are_coordinates(numbers: np.ndarray) -> bool:
    """Whether numbers are evenly spaced and differ from each other."""
    steps = np.diff(numbers)
    even = len(numbers) >= LEAST_COORDINATES and np.ptp(steps) <= EVEN * abs(steps[0])
    return bool(even and steps[0] != 0.0)
