"""Interpolation in a table by local cubics, with an error estimate.

Along an axis, values are interpolated by the cubic through the four nearest nodes.  To estimate the
error, each node is also predicted from its neighbours by a cubic with twice the spacing.  The error
bound of a cell is the largest difference between prediction and value at the surrounding nodes.
The true error is sixteen times smaller for a smooth function and about as large at a kink.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

NODES = 4
"""Number of nodes of a local cubic."""


@dataclass(frozen=True, eq=False)
class Axis:
    """Ascending coordinates of one axis of a table.

    The axis is logarithmic if the coordinates are closer to equal ratios than to equal steps.
    """

    values: np.ndarray

    @cached_property
    def logarithmic(self) -> bool:
        values = self.values
        if len(values) < 3 or values[0] <= 0.0:
            return len(values) == 2 and 0.0 < 10.0 * values[0] < values[1]
        return _unevenness(np.log(values)) < _unevenness(values)

    @cached_property
    def nodes(self) -> np.ndarray:
        return self.scaled(self.values)

    def scaled(self, points: np.ndarray) -> np.ndarray:
        """Return the points, or their logarithms if the axis is logarithmic."""
        return np.log(points) if self.logarithmic else np.asarray(points, float)

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Return True for points between the ends of the axis, including the ends."""
        return (points >= self.values[0]) & (points <= self.values[-1])

    def cubics(self, points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Return the weights of the local cubics at points.

        Parameters
        ----------
        points : numpy.ndarray, shape (n,)
            Points between the ends of the axis.

        Returns
        -------
        cell : numpy.ndarray, shape (n,)
            Index of the node below each point.
        share : numpy.ndarray, shape (n,)
            Position of the point in its cell, 0 to 1.
        index, weights : numpy.ndarray, shape (n, k)
            Indices and weights of the k nodes of the cubic, with k at most 4.
        """
        x, q = self.nodes, self.scaled(points)
        count = len(x)
        if count == 1:
            zero = np.zeros(len(q), int)
            return zero, np.zeros(len(q)), zero[:, None], np.ones((len(q), 1))
        width = min(NODES, count)
        cell = np.clip(np.searchsorted(x, q, side="right") - 1, 0, count - 2)
        share = (q - x[cell]) / (x[cell + 1] - x[cell])
        first = np.clip(cell - (width // 2 - 1), 0, count - width)
        index = first[:, None] + np.arange(width)
        return cell, share, index, lagrange(x[index], q)

    def misses(self, table: np.ndarray) -> np.ndarray:
        """Return the absolute difference between the value at each node and the cubic through its
        neighbours.

        The nodes are along the first axis of the table.  An end node is assigned the difference of
        its neighbour.  If there are only two nodes, both are assigned the difference between their
        values.
        """
        x = self.nodes
        count = len(x)
        if count < 3:
            return np.broadcast_to(np.abs(table[-1] - table[0]), table.shape).copy()
        out = np.empty(table.shape)
        for i in range(1, count - 1):
            others = np.delete(np.arange(count), i)
            near = np.sort(others[np.argsort(np.abs(others - i), kind="stable")[:NODES]])
            weights = lagrange(x[None, near], x[i : i + 1])[0]
            out[i] = np.abs(table[i] - weights @ table[near])
        out[0], out[-1] = out[1], out[-2]
        return out


def _unevenness(values: np.ndarray) -> float:
    steps = np.diff(values)
    return steps.max() / steps.min()


def lagrange(nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Return the Lagrange weights for interpolation from k nodes to n points, shape (n, k).

    nodes: shape (n, k), or (1, k) if all points have the same nodes; points: shape (n,).
    """
    weights = np.ones((len(points), nodes.shape[1]))
    for own in range(nodes.shape[1]):
        for other in range(nodes.shape[1]):
            if other != own:
                gap = nodes[:, own] - nodes[:, other]
                weights[:, own] *= (points - nodes[:, other]) / gap
    return weights


@dataclass(frozen=True, eq=False)
class Table:
    """Values and errors on two axes, shape (len(rows), len(columns)).  Unknown values are NaN."""

    rows: Axis
    columns: Axis
    values: np.ndarray
    errors: np.ndarray

    @property
    def last_row(self) -> tuple[np.ndarray, np.ndarray]:
        """Values and errors along the last row, shape (len(columns),) each."""
        return self.values[-1], self.errors[-1]

    @cached_property
    def _misses(self) -> tuple[np.ndarray, np.ndarray]:
        """Largest differences (see `misses`) at the nodes around each cell, along both axes."""
        along_rows = self.rows.misses(self.values)
        along_columns = self.columns.misses(self.values.T).T
        return largest_around(along_rows, 4), largest_around(along_columns, 4)

    def at(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at points inside the table, shape (n,) each.

        If a value at one of the nodes is unknown, the result is NaN and the error bound is
        infinite.
        """
        i, s, rows, row_weights = self.rows.cubics(row)
        j, t, columns, column_weights = self.columns.cubics(column)
        corners = rows[:, :, None], columns[:, None, :]
        value = np.einsum("ni,nj,nij->n", row_weights, column_weights, self.values[corners])
        error = self.errors[corners].max(axis=(1, 2))
        # Between two nodes the interpolation error is proportional to the product of the distances.
        for miss, share in zip(self._misses, (s, t), strict=True):
            error = error + 4.0 * share * (1.0 - share) * miss[i, j]
        return value, np.where(np.isnan(value) | np.isnan(error), np.inf, error)


def largest_around(values: np.ndarray, size: int = 3) -> np.ndarray:
    """Return the largest entry in each window of a table.  The table is padded with its edge
    entries.

    Parameters
    ----------
    values : numpy.ndarray, shape (n, m)
        Entries at the nodes of a table.
    size : int
        Number of nodes along a side of a window: 3 for windows around each node, 4 for windows
        around each cell.

    Returns
    -------
    numpy.ndarray
        Array of shape (n, m) for size 3.  For size 4, the shape is (n - 1, m - 1), with at least
        one entry along each axis.
    """
    padded = np.pad(values, [(1, max(1, size - 1 - n)) for n in values.shape], mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (size, size))
    return windows.max(axis=(-2, -1))
