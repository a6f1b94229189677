"""The surface between the points of a map: that of `microslip.at`, on a grid fine enough to draw.

Datasets hold what was computed and nothing between it, so that no interpolation can be taken for a
result. What a figure shows between the points is asked here of `query.interpolation`, whose error
is known, rather than left to straight lines from point to point. Where its cubics would leave the
values of the points on both sides, as on coarse maps, the surface stays at these: what lies further
is within their error, and would be drawn as an island that nobody computed.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    from microslip.datasets.query.interpolation import Axis

FINE = 200
"""Lines of the fine grid along each axis, about."""


def refined(
    velocity: np.ndarray, amplitude: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A finer grid that holds all points, and the values there.

    Parameters
    ----------
    velocity : ndarray, shape (m,)
        Dimensionless, ascending, above 0.
    amplitude : ndarray, shape (n,)
        Dimensionless, ascending.
    values : ndarray, shape (n, m)
        Values at the points; what is not finite is not known.

    Returns
    -------
    tuple of ndarray
        Velocities (k,), amplitudes (l,) and values (l, k), masked where nothing is known. At the
        points the values are those given. Where a point that the cubic needs is not known, a
        straight line takes its place.
    """
    from microslip.datasets.query.interpolation import Axis  # loads the solver

    columns, rows = Axis(np.asarray(velocity, float)), Axis(np.asarray(amplitude, float))
    x, y = _subdivided(columns), _subdivided(rows)
    known = np.where(np.isfinite(values), values, np.nan)
    fine = _along(rows, y, _along(columns, x, known.T).T)
    return x, y, np.ma.masked_invalid(fine)


def supported(
    surface: tuple[np.ndarray, ...], points: tuple[np.ndarray, ...], levels: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ma.MaskedArray]:
    """A fine grid without the cells in which the points cannot support contours.

    The place of a contour is known where interpolation is off by less than half the distance
    between two levels, by what it misses when points are left out.

    Parameters
    ----------
    surface : tuple of ndarray
        The fine grid, as `refined` returns it.
    points : tuple of ndarray
        The arguments of `refined`.
    levels : sequence of float
        The levels of the contours, ascending.

    Returns
    -------
    tuple of ndarray
        The surface, masked inside such cells.
    """
    from microslip.datasets.query.interpolation import Axis, largest_around

    (x, y, fine), (velocity, amplitude, values) = surface, points
    columns, rows = Axis(np.asarray(velocity, float)), Axis(np.asarray(amplitude, float))
    known = np.where(np.isfinite(values), values, np.nan)
    off = np.zeros((len(amplitude) - 1, len(velocity) - 1))
    for missed in (rows.misses(known), columns.misses(known.T).T):
        nodes = largest_around(np.nan_to_num(missed))
        off += np.maximum.reduce([nodes[:-1, :-1], nodes[1:, :-1], nodes[:-1, 1:], nodes[1:, 1:]])
    kept = off <= np.diff(levels).min(initial=np.inf) / 2.0
    # A line between two cells stays if either of them does.
    up, along = _cells(amplitude, y), _cells(velocity, x)
    some = np.logical_or.reduce([kept[np.ix_(i, j)] for i in up for j in along])
    return x, y, np.ma.masked_where(~some, fine)


def _cells(nodes: np.ndarray, at: np.ndarray) -> list[np.ndarray]:
    """Indices of the cells on both sides of each place, which are the same inside a cell."""
    sides = (np.searchsorted(nodes, at, side) for side in ("left", "right"))
    return [np.clip(side - 1, 0, len(nodes) - 2) for side in sides]


def _along(axis: Axis, points: np.ndarray, table: np.ndarray) -> np.ndarray:
    """A table whose first axis is refined; within each cell no value leaves those at its ends."""
    cell, share, nodes, weights = axis.cubics(points)
    cubic = np.einsum("pn,pn...->p...", weights, table[nodes])
    ends = table[cell], table[np.minimum(cell + 1, len(table) - 1)]
    share = share[:, None]
    # Of an unknown end nothing is taken at the other one.
    straight = np.where(share > 0, share * ends[1], 0.0) + np.where(
        share < 1, (1.0 - share) * ends[0], 0.0
    )
    return np.where(np.isnan(cubic), straight, np.clip(cubic, np.fmin(*ends), np.fmax(*ends)))


def _subdivided(axis: Axis) -> np.ndarray:
    """The points of an axis and evenly spaced ones between them."""
    parts = -(-FINE // (len(axis.nodes) - 1))
    share = np.arange(1, parts) / parts
    between = axis.nodes[:-1, None] + share * np.diff(axis.nodes)[:, None]
    inner = np.exp(between) if axis.logarithmic else between
    filled = np.column_stack((axis.values[:-1, None], inner)).ravel()
    return np.append(filled, axis.values[-1])
