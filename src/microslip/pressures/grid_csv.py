"""Read a grid of pressures from a CSV file: a heading with the column names, then one line for each
point."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from microslip.foundation import csv_text
from microslip.pressures.grid_units import COLUMNS, MOST_POINTS, Units, read_units

NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.I | re.A)
SAME = 1e-9
"""Coordinates count as equal if they differ by less than this fraction of their range."""
ALLOWED = (
    "forward,lateral,pressure in any order, with units such as forward [mm] if at all; or a matrix "
    "of pressures alone, with pitch=0.5 mm after the path"
)


def grid(
    content: bytes, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]:
    """Return the coordinates and pressures of a CSV file, shapes (n,), (m,) and (n, m), and their
    units.

    Commas, semicolons or tabs separate the columns.  Empty lines and lines that begin with # are
    ignored.

    Parameters
    ----------
    content : bytes
        Content of the file.
    decimal, encoding : str
        Decimal mark and encoding of the file.

    Raises
    ------
    ValueError
        If the content has another format, or if the points do not fill a grid.
    """
    lines = csv_text.lines(content, encoding)
    where, heading = next(lines, (1, ""))
    separator, order, units = _columns(where, heading)
    rows, places, thousands = [], [], csv_text.Thousands(separator, COLUMNS)
    for where, line in lines:
        cells = csv_text.cells(where, line, separator, len(order))
        places_and_names = zip(order, COLUMNS, strict=True)
        words = [
            csv_text.with_point(where, name, cells[i], decimal) for i, name in places_and_names
        ]
        rows.append([number(where, *word) for word in zip(COLUMNS, words, strict=True)])
        places.append(where)
        thousands.see(where, words)
        if len(rows) > MOST_POINTS:
            raise ValueError(f"line {where}: more than {MOST_POINTS} points; allowed: at most that")
    thousands.refuse()
    table = np.array(rows, float).reshape(-1, 3)
    ratio, sizes = read_units(units)
    table[:, 1] *= ratio
    return _filled(table, places), sizes


def _columns(where: int, heading: str) -> tuple[str, list[int], list[str | None]]:
    """Return the separator, the position of each of COLUMNS, and their units (None if there is no
    unit)."""
    for separator in csv_text.SEPARATORS:
        words = csv_text.words(heading, separator)
        matches = [match for match in map(csv_text.HEADING.fullmatch, words) if match]
        names = [match[1].lower() for match in matches]
        if set(names) == set(COLUMNS) and len(words) == len(names) == len(COLUMNS):
            order = [names.index(name) for name in COLUMNS]
            return separator, order, [matches[i][2] for i in order]
    raise ValueError(f"line {where}: the heading is {heading[:80]!r}; allowed: {ALLOWED}")


def number(where: int, name: str, word: str) -> float:
    """The number of a word.  Raises ValueError unless it is finite, and at least 0 for a
    pressure."""
    if not NUMBER.fullmatch(word):
        raise ValueError(f"line {where}: {name} is {word[:40]!r}; allowed: a number")
    value = float(word)
    if not np.isfinite(value) or (name == "pressure" and value < 0.0):
        allowed = "a finite number" + (", 0 or above" if name == "pressure" else "")
        raise ValueError(f"line {where}: {name} is {word.lower()}; allowed: {allowed}")
    return value


def _filled(table: np.ndarray, places: Sequence[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the coordinates and values of the grid formed by the points.

    table: forward, lateral and pressure of each point, (points, 3); places: line of each point.
    Raises ValueError if a point is missing or occurs twice.
    """
    if len(table) == 0:
        raise ValueError("no points; allowed: a line with three numbers for each point of a grid")
    (forward, i), (lateral, j) = (_distinct(column) for column in table.T[:2])
    if len(forward) * len(lateral) > MOST_POINTS:  # a grid of this size is never full
        raise ValueError(
            f"{len(table)} points do not fill a grid of {len(forward)} x {len(lateral)}; allowed: "
            "every point of a regular grid once"
        )
    key = i * len(lateral) + j
    repeated = np.setdiff1d(np.arange(len(key)), np.unique(key, return_index=True)[1])
    if len(repeated):
        first = np.flatnonzero(key == key[repeated[0]])[0]
        raise ValueError(
            f"line {places[repeated[0]]}: the same point as in line {places[first]}; "
            "allowed: every point of a regular grid once"
        )
    values = np.full((len(forward), len(lateral)), np.nan)
    values[i, j] = table[:, 2]
    missing = np.argwhere(np.isnan(values))
    if len(missing):
        a, b = missing[0]
        raise ValueError(
            f"line {places[-1]} is the last: {len(table)} points do not fill a grid of "
            f"{len(forward)} x {len(lateral)}, there is none at forward {forward[a]:g}, lateral "
            f"{lateral[b]:g}; allowed: every point of a regular grid once"
        )
    return forward, lateral, values


def _distinct(column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distinct coordinates in increasing order, (n,), and the index of each point among them."""
    values, which = np.unique(column, return_inverse=True)
    group = np.concatenate([[0], np.cumsum(np.diff(values) > SAME * np.ptp(values))])
    return values[np.unique(group, return_index=True)[1]], group[which.reshape(-1)]
