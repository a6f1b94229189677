"""Interpolation on a regular grid by local cubics, with an error estimate.

Along an axis, values are interpolated by the cubic through the four nearest nodes.  To estimate the
error, each node is also predicted from its neighbours by a cubic with twice the spacing.  The error
bound of a cell is the largest difference between prediction and value at the nodes of its cubic.
The true error is sixteen times smaller for a smooth function and about as large at a kink.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np

NODES = 4
"""Number of nodes of a local cubic."""


@dataclass(frozen=True, eq=False)
class Axis:
    """Ascending coordinates of one axis of a grid.

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
            return np.broadcast_to(np.abs(table[-1] - table[0]), table.shape)
        out = np.empty(table.shape)
        for i in range(1, count - 1):
            others = np.delete(np.arange(count), i)
            near = np.sort(others[np.argsort(np.abs(others - i), kind="stable")[:NODES]])
            weights = lagrange(x[None, near], x[i : i + 1])[0]
            out[i] = np.abs(table[i] - np.tensordot(weights, table[near], 1))
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
class Grid:
    """Values and errors at the nodes of a regular grid with one or more axes.

    Attributes
    ----------
    axes : tuple of Axis
        Axes of the grid.
    values, errors : np.ndarray, shape (n, m, ...)
        Values and their error estimates, with one dimension for each axis.  Unknown values are NaN.
    """

    axes: tuple[Axis, ...]
    values: np.ndarray
    errors: np.ndarray

    @cached_property
    def _misses(self) -> list[np.ndarray]:
        """Differences of the leave-one-out prediction along each axis, see Axis.misses."""
        return [
            np.moveaxis(axis.misses(np.moveaxis(self.values, k, 0)), 0, k)
            for k, axis in enumerate(self.axes)
        ]

    def at(self, *points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return values and error bounds at points inside the grid, shape (n,) each.

        Between two nodes of an axis, the interpolation error is proportional to the product of the
        distances to them.  The bound is the sum over all axes, plus the largest error of the nodes.
        If a value at one of the nodes is unknown, the result is NaN and the bound is infinite.

        points: coordinates, one array of shape (n,) for each axis.
        """
        stencils = [axis.cubics(one) for axis, one in zip(self.axes, points, strict=True)]
        count = len(points[0])
        value, error = np.zeros(count), np.zeros(count)
        misses = np.zeros((len(self.axes), count))
        for corner in product(*(range(index.shape[1]) for _, _, index, _ in stencils)):
            parts = [(i[:, k], w[:, k]) for (_, _, i, w), k in zip(stencils, corner, strict=True)]
            node = tuple(index for index, _ in parts)
            value += np.prod([weight for _, weight in parts], axis=0) * self.values[node]
            error = np.maximum(error, self.errors[node])
            misses = np.maximum(misses, [miss[node] for miss in self._misses])
        for (_, share, _, _), miss in zip(stencils, misses, strict=True):
            error = error + 4.0 * share * (1.0 - share) * miss
        return value, np.where(np.isnan(value) | np.isnan(error), np.inf, error)
