"""Interpolate a map onto a grid that is fine enough for drawing.

Datasets contain values at the computed points only.  For figures, this module interpolates between
the points with the cubics of `datasets.interpolation`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from microslip.datasets.interpolation import Axis

FINE = 200
"""Approximate number of grid lines along each axis of the fine grid."""


class Surface:
    """Values of a map on a fine grid that contains all computed points.

    The values equal the values from `dataset.microslip.at`, with two exceptions.  On coarse maps, a
    value can be outside the range of the two neighbouring points.  Such a value is clipped to this
    range, so that figures show only computed extrema.  If a cubic would need an unknown value, the
    interpolation is linear.

    Parameters
    ----------
    velocity : ndarray, shape (m,)
        Dimensionless velocities above 0, in ascending order.
    amplitude : ndarray, shape (n,)
        Dimensionless amplitudes, in ascending order.
    values : ndarray, shape (n, m)
        Values at the points.  Values that are not finite count as unknown.

    Attributes
    ----------
    velocity, amplitude : ndarray, shapes (k,) and (l,)
        Coordinates of the fine grid.
    values : masked ndarray, shape (l, k)
        Values on the fine grid, masked where they are unknown.
    """

    def __init__(self, velocity: np.ndarray, amplitude: np.ndarray, values: np.ndarray) -> None:
        self._columns = Axis(np.asarray(velocity, float))
        self._rows = Axis(np.asarray(amplitude, float))
        self._points = np.where(np.isfinite(values), values, np.nan)
        self.velocity, self.amplitude = _subdivided(self._columns), _subdivided(self._rows)
        along_velocity = _refined(self._columns, self.velocity, self._points.T).T
        fine = _refined(self._rows, self.amplitude, along_velocity)
        self.values = np.ma.masked_invalid(fine)

    def supported(self, levels: ArrayLike) -> np.ma.MaskedArray:
        """Return the values on the fine grid, masked in cells without reliable contours.

        A contour is reliable if the interpolation error is below half the distance between two
        levels.  To estimate this error, each point is interpolated from its neighbours.

        Parameters
        ----------
        levels : sequence of float
            Levels of the contours, in ascending order.
        """
        misses = self._rows.misses(self._points), self._columns.misses(self._points.T).T
        error = sum(largest_around(np.nan_to_num(missed)) for missed in misses)
        cells = error <= np.diff(levels).min(initial=np.inf) / 2.0
        # A line on the border of two cells is drawn if it is reliable in one of them.
        rows = _cells(self._rows, self.amplitude)
        columns = _cells(self._columns, self.velocity)
        drawn = np.logical_or.reduce([cells[np.ix_(i, j)] for i in rows for j in columns])
        return np.ma.masked_where(~drawn, self.values)


def _subdivided(axis: Axis) -> np.ndarray:
    """Return the coordinates of an axis, with evenly spaced coordinates inserted between
    neighbours."""
    parts = -(-FINE // (len(axis.nodes) - 1))
    share = np.arange(1, parts) / parts
    between = axis.nodes[:-1, None] + share * np.diff(axis.nodes)[:, None]
    inner = np.exp(between) if axis.logarithmic else between
    filled = np.column_stack((axis.values[:-1, None], inner)).ravel()
    return np.append(filled, axis.values[-1])


def _refined(axis: Axis, coordinates: np.ndarray, table: np.ndarray) -> np.ndarray:
    """Interpolate a table along its first axis, and clip the values to the range of each cell."""
    cell, share, nodes, weights = axis.cubics(coordinates)
    cubic = np.einsum("pn,pn...->p...", weights, table[nodes])
    low, high = table[cell], table[np.minimum(cell + 1, len(table) - 1)]
    share = share[:, None]
    # At a point with a known value, the unknown value of the other point has no weight.
    line = np.where(share > 0, share * high, 0.0) + np.where(share < 1, (1.0 - share) * low, 0.0)
    return np.where(np.isnan(cubic), line, np.clip(cubic, np.fmin(low, high), np.fmax(low, high)))


def _cells(axis: Axis, coordinates: np.ndarray) -> list[np.ndarray]:
    """Return the indices of the cells to the left and to the right of each coordinate.  The two
    indices are equal if the coordinate is inside a cell."""
    sides = (np.searchsorted(axis.values, coordinates, side) for side in ("left", "right"))
    return [np.clip(side - 1, 0, len(axis.values) - 2) for side in sides]


def largest_around(values: np.ndarray) -> np.ndarray:
    """For each cell of a table, return the largest entry at the surrounding nodes.

    The nodes around a cell form a window with four nodes along each side.  The table is padded with
    its edge entries.  The result has the shape (n - 1, m - 1), but it has at least one entry along
    each axis.

    values: entries at the nodes, as an array of shape (n, m).
    """
    padded = np.pad(values, [(1, max(1, 3 - n)) for n in values.shape], mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (4, 4))
    return windows.max(axis=(-2, -1))
