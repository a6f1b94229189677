"""Interpolation of a table with an error that it earns: local cubics, judged by leaving nodes out.

Along an axis the value is that of the cubic through the four nearest nodes.  How wrong such a cubic
can be is seen at the nodes: each is predicted from its neighbours alone, as if it had not been
computed.  The largest miss at the nodes around a cell, from twice the spacing, bounds what the
cubic leaves within it: smooth stretches are sixteen times better than that, a kink about as bad.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

NODES = 4
"""Nodes of a local cubic."""


@dataclass(frozen=True, eq=False)
class Axis:
    """Coordinates of one axis of a table, ascending; logarithmic if their ratios are more even than
    their distances."""

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
        """Points in the measure that the axis is interpolated in."""
        return np.log(points) if self.logarithmic else np.asarray(points, float)

    def holds(self, points: np.ndarray) -> np.ndarray:
        """Which of the points lie on the axis or between its ends."""
        return (points >= self.values[0]) & (points <= self.values[-1])

    def cubics(self, points: np.ndarray) -> tuple[np.ndarray, ...]:
        """Local cubics at points inside, shape (n,): (index of the cell, its share that lies to the
        left of the point, indices of the nodes (n, k), their weights (n, k)); k: at most 4."""
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
        return cell, share, index, _lagrange(x[index], q)

    def misses(self, table: np.ndarray) -> np.ndarray:
        """|node - what the cubic through its neighbours says| along the first axis of a table.

        An end node is given what the node beside it has, and of two nodes both their difference.
        """
        x = self.nodes
        count = len(x)
        if count < 3:
            return np.broadcast_to(np.abs(table[-1] - table[0]), table.shape).copy()
        out = np.empty(table.shape)
        for i in range(1, count - 1):
            others = np.delete(np.arange(count), i)
            near = np.sort(others[np.argsort(np.abs(others - i), kind="stable")[:NODES]])
            weights = _lagrange(x[None, near], x[i : i + 1])[0]
            out[i] = np.abs(table[i] - weights @ table[near])
        out[0], out[-1] = out[1], out[-2]
        return out


def _unevenness(values: np.ndarray) -> float:
    steps = np.diff(values)
    return steps.max() / steps.min()


def _lagrange(nodes: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Weights (n, k) of values at nodes (n, k) for the polynomial through them, at points (n,)."""
    weights = np.ones_like(nodes)
    for own in range(nodes.shape[1]):
        for other in range(nodes.shape[1]):
            if other != own:
                gap = nodes[:, own] - nodes[:, other]
                weights[:, own] *= (points - nodes[:, other]) / gap
    return weights


@dataclass(frozen=True, eq=False)
class Table:
    """Values and their errors over two axes, shape (len(rows), len(columns)); NaN: not known."""

    rows: Axis
    columns: Axis
    values: np.ndarray
    errors: np.ndarray

    @cached_property
    def _miss(self) -> tuple[np.ndarray, np.ndarray]:
        """Error from leaving nodes out along each axis: the largest at a node and around it."""
        along_rows = self.rows.misses(self.values)
        along_columns = self.columns.misses(self.values.T).T
        return largest_around(along_rows), largest_around(along_columns)

    def at(self, row: np.ndarray, column: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values and bounds of their errors at points inside, shape (n,) each; NaN and infinity
        where a node that counts is not known."""
        i, s, rows, row_weights = self.rows.cubics(row)
        j, t, columns, column_weights = self.columns.cubics(column)
        picked = rows[:, :, None], columns[:, None, :]
        value = np.einsum("ni,nj,nij->n", row_weights, column_weights, self.values[picked])
        error = self.errors[picked].max(axis=(1, 2))
        # Between two nodes the error of an interpolation goes like the product of the distances.
        for miss, share in zip(self._miss, (s, t), strict=True):
            error = error + 4.0 * share * (1.0 - share) * _largest_of_cell(miss, i, j)
        return value, np.where(np.isnan(value) | np.isnan(error), np.inf, error)


def largest_around(values: np.ndarray) -> np.ndarray:
    """The largest of every entry of a table and those beside it, across corners too."""
    padded = np.pad(values, 1, mode="edge")
    n, m = values.shape
    shifts = [(a, b) for a in range(3) for b in range(3)]
    return np.maximum.reduce([padded[a : a + n, b : b + m] for a, b in shifts])


def _largest_of_cell(values: np.ndarray, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    n, m = values.shape
    right, above = np.minimum(i + 1, n - 1), np.minimum(j + 1, m - 1)
    corners = (values[a, b] for a in (i, right) for b in (j, above))
    return np.maximum.reduce(list(corners))
