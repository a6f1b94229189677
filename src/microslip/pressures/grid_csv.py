"""Read a grid of pressures from a CSV file: points with coordinates, or a matrix of pressures."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from microslip.foundation import csv_table
from microslip.pressures.grid_units import COLUMNS, MOST_POINTS, Units, read_pitch, read_units

Grid = tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]
"""Coordinates (n,) and (m,), pressures (n, m), and their units."""
SAME = 1e-9
"""Coordinates count as equal if they differ by less than this fraction of their range."""
HEADING = (
    "forward,lateral,pressure in any order, with units such as forward [mm] if at all; or a matrix "
    "of pressures alone, with pitch=0.5 mm after the path"
)
FULL = "allowed: every point of a regular grid once"
OUTSIDE = "B"
"""Content of cells outside the sensor in Tekscan files.  Its pressure is 0."""
END = "@@"
"""Last line of Tekscan files."""
LEAST_COORDINATES = 4
"""Smallest number of evenly spaced values that count as coordinates.  Three pressures can be evenly
spaced by chance."""
EVEN = 0.05
"""Largest difference between the steps of evenly spaced coordinates, divided by the first step.  It
allows for coordinates rounded to 1/40 of their step, because rounding changes a step by at most one
unit of the last place."""
MATRIX = (
    "allowed: a header without numbers in columns, then one row of the matrix in each line up to "
    "the end of the file, with decimal=comma after the path for decimal commas"
)


def read_points(content: bytes, decimal: str = ".", encoding: str = "utf-8") -> Grid:
    """Read a table with the columns forward, lateral and pressure, one point of the grid a row.

    decimal, encoding: decimal mark and encoding of the file.  Raises ValueError if the content has
    another format, or if the points do not fill a grid.
    """
    names = {"forward": "m", "lateral": "m", "pressure": "Pa"}
    table = csv_table.read_table(
        content, names, complete=HEADING, decimal=decimal, encoding=encoding
    )
    if len(table.lines) > MOST_POINTS:
        where = table.lines[MOST_POINTS]
        raise ValueError(f"line {where}: more than {MOST_POINTS} points; allowed: at most that")
    columns = table.numbers({"pressure": 0.0})
    ratio, units = read_units([one if one != "" else "1" for one in map(table.units.get, COLUMNS)])
    if not table.lines:
        raise ValueError("no points; allowed: a line with three numbers for each point of a grid")
    (forward, i), (lateral, j) = (_distinct(np.array(columns[name])) for name in COLUMNS[:2])
    shape = f"{len(forward)} x {len(lateral)}"
    if len(forward) * len(lateral) > MOST_POINTS:  # a grid of this size is never full
        raise ValueError(f"{len(i)} points do not fill a grid of {shape}; {FULL}")
    key = i * len(lateral) + j
    repeated = np.setdiff1d(np.arange(len(key)), np.unique(key, return_index=True)[1])
    if len(repeated):
        one, other = repeated[0], np.flatnonzero(key == key[repeated[0]])[0]
        problem = f"the same point as in line {table.lines[other]}"
        raise ValueError(f"line {table.lines[one]}: {problem}; {FULL}")
    values = np.full((len(forward), len(lateral)), np.nan)
    values[i, j] = columns["pressure"]
    if np.isnan(values).any():
        a, b = np.argwhere(np.isnan(values))[0]
        raise ValueError(
            f"line {table.lines[-1]} is the last: {len(i)} points do not fill a grid of {shape}, "
            f"there is none at forward {forward[a]:g}, lateral {lateral[b]:g}; {FULL}"
        )
    return (forward, ratio * lateral, values), units


def _distinct(column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct coordinates in increasing order, (n,), and the index of each point among them."""
    values, which = np.unique(column, return_inverse=True)
    group = np.concatenate([[0], np.cumsum(np.diff(values) > SAME * np.ptp(values))])
    return values[np.unique(group, return_index=True)[1]], group[which.reshape(-1)]


def read_matrix(content: bytes, pitch: str, decimal: str = ".", encoding: str = "utf-8") -> Grid:
    """Read a matrix of pressures, as programs for pressure sensors and pressure films write it.

    The forward coordinate increases from line to line, the lateral one from cell to cell.  Commas,
    semicolons, tabs or spaces separate the cells.  Lines above the matrix are ignored.

    pitch: distance between the cells, see grid_units.read_pitch.  Raises ValueError if a line is
    neither a header nor a row of the matrix, or if the matrix contains coordinates.
    """
    forward, lateral, units = read_pitch(pitch)
    text = enumerate(csv_table.lines_of(content, encoding))
    lines = [(k + 1, *_split(line, decimal)) for k, line in text if csv_table.is_row(k, line)]
    if lines and _trimmed(lines[-1][2]) == [END]:
        lines.pop()
    filled = [[cell for cell in cells if cell] for *_, cells in lines]
    header = next((k for k, cells in enumerate(filled) if _count(cells) == len(cells)), None)
    if header is None:
        raise ValueError(f"no row of numbers; {MATRIX}")
    start, separator, _ = lines[header]
    width = max(len(_trimmed(cells)) for *_, cells in lines[header:])
    first = lines[header][2][:width]
    for where, own, cells in lines[:header]:
        titles = filter(None, map(csv_table.HEADING.fullmatch, cells))
        if {title[1].lower() for title in titles} == set(COLUMNS):
            raise ValueError(f"line {where}: a heading of columns; allowed without pitch only")
        count = _count(cells)
        if own == separator and (count > 1 or count and len(_trimmed(cells)) == len(first)):
            odd = next(cell for cell in cells if not _count([cell]))
            raise ValueError(f"line {where}: {odd[:40]!r} between numbers; {MATRIX}")
    rows, words = [], []
    for expected, (where, _, all_cells) in enumerate(lines[header:], start):
        cells = all_cells[:width]
        if "" in cells:
            problem = f"cell {cells.index('') + 1} is empty; {MATRIX}, with 0 where nothing presses"
            raise ValueError(f"line {where}: {problem}")
        if where != expected:
            raise ValueError(f"line {expected}: no row of the matrix; {MATRIX}")
        if len(cells) != len(first):
            problem = f"{len(cells)} cells, but {len(first)} in line {start}"
            raise ValueError(f"line {where}: {problem}; {MATRIX}")
        cells = [csv_table.with_point(where, "pressure", cell, decimal) for cell in cells]
        cells = ["0" if cell == OUTSIDE else cell for cell in cells]
        rows.append([csv_table.number(where, "pressure", cell, 0.0) for cell in cells])
        words += [(where, cell) for cell in cells]
        if len(words) > MOST_POINTS:
            raise ValueError(f"line {where}: more than {MOST_POINTS} points; allowed: at most that")
    if "," not in (separator, decimal):
        places, texts = zip(*words, strict=True)
        csv_table.refuse_thousands("pressure", texts, places)
    values = np.array(rows)
    n, m = values.shape
    if min(n, m) < 2:
        raise ValueError(f"a matrix of {n} x {m}; allowed: two rows and two columns, or more")
    for side, numbers in (("row", values[0]), ("column", values[:, 0])):
        if _are_coordinates(numbers[1:]):
            allowed = "allowed: pressures alone, or columns forward,lateral,pressure without pitch"
            raise ValueError(f"the numbers of the first {side} look like coordinates; {allowed}")
    return (np.arange(n) * forward, np.arange(m) * lateral, values), units


def _split(line: str, decimal: str) -> tuple[str, list[str]]:
    """The separator of a line, and its cells."""
    separators = [";", "\t"] + [","] * (decimal == ".")
    separator = next(filter(line.__contains__, separators), " ")
    cells = line.split() if separator == " " else line.split(separator)
    return separator, [cell.strip().strip("\"'").strip() for cell in cells]


def _trimmed(cells: list[str]) -> list[str]:
    """Cells without empty cells at the end."""
    while len(cells) > 1 and not cells[-1]:
        cells = cells[:-1]
    return cells


def _count(cells: Sequence[str]) -> int:
    """Number of cells that are numbers, with either decimal mark."""
    number, comma = csv_table.NUMBER, csv_table.DECIMAL_COMMA
    return sum(cell == OUTSIDE or bool(number.fullmatch(comma.sub(r"\1.", cell))) for cell in cells)


def _are_coordinates(numbers: np.ndarray) -> bool:
    """Whether numbers are evenly spaced and differ from each other."""
    steps = np.diff(numbers)
    even = len(numbers) >= LEAST_COORDINATES and np.ptp(steps) <= EVEN * abs(steps[0])
    return bool(even and steps[0] != 0.0)
