"""Read a grid of pressures from a CSV file: a heading with the column names, then one line for each
point."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from microslip.foundation.number_table import read_numbers
from microslip.pressures.grid_units import COLUMNS, MOST_POINTS, Units, read_units

SAME = 1e-9
"""Coordinates count as equal if they differ by less than this fraction of their range."""
ALLOWED = (
    "forward,lateral,pressure in any order, with units such as forward [mm] if at all; or a matrix "
    "of pressures alone, with pitch=0.5 mm after the path"
)


def grid(
    content: bytes, decimal: str = ".", encoding: str = "utf-8"
) -> tuple[tuple[np.ndarray, np.ndarray, np.ndarray], Units]:
    """Return the coordinates (n,) and (m,), the pressures (n, m) and the Units in a CSV file.

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
    read = read_numbers(
        content,
        COLUMNS,
        ALLOWED,
        complete=True,
        least={"pressure": 0.0},
        decimal=decimal,
        encoding=encoding,
        most=MOST_POINTS,
    )
    table = np.stack([read.columns[name] for name in COLUMNS], axis=1)
    ratio, sizes = read_units([read.units[name] for name in COLUMNS])
    table[:, 1] *= ratio
    return _filled(table, read.lines), sizes


def _filled(table: np.ndarray, places: Sequence[int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the coordinates and values of the grid formed by the points.

    table: forward, lateral and pressure of each point, (points, 3); places: line number of each
    point.  Raises ValueError if a point is missing or occurs twice.
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
