"""Loads on the cells of a regular grid.

The pressure is a function of the radius, or is given by values on another grid, such as the
readings of a sensor or the results of another program.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from microslip.foundation.errors import InputError

AXES = ("forward", "lateral")
READINGS = ("cells", "samples")
"""Possible meanings of the values on a grid.  The reading "cells" means that each value is the mean
over the cell around its point. A cell is one grid step wide.  The reading "samples" means that the
values apply at the points and are interpolated bilinearly.  The pressure is 0 outside the grid."""
FINE = 256
"""To compute u_lim and the torque, the contact is divided into this number of squares along each
side."""
FINEST = 1024
"""Largest number of squares along each side.  If a grid has more points along a side than `FINE`,
the number of squares is increased up to this limit."""
REGULAR = 1e-3
"""Largest allowed distance of a coordinate from the regular grid, divided by the step of the
grid."""


def checked(
    forward: np.ndarray, lateral: np.ndarray, values: np.ndarray
) -> tuple[list[np.ndarray], np.ndarray, float]:
    """Check the coordinates and the pressures of a grid, and scale the coordinates.

    Coordinates are arrays of shapes (n,) and (m,), and `values` is an array of shape (n, m).

    Returns
    -------
    points : list of two arrays
        Coordinates that start at 0, in units of the longer grid step.  In these units, areas
        neither overflow nor underflow.
    values : array, shape (n, m)
    step : float
        The longer grid step, in the original unit.

    Raises
    ------
    InputError
        If coordinates are not evenly spaced, if a value is negative or not finite, or if all values
        are 0.
    """
    values = np.asarray(values, float)
    axes = [np.asarray(axis, float) for axis in (forward, lateral)]
    steps = [_step(label, axis) for label, axis in zip(AXES, axes, strict=True)]
    for i, j in np.argwhere(~(np.isfinite(values) & (values >= 0.0)))[:1]:
        place = f"at forward {axes[0][i]:g}, lateral {axes[1][j]:g}"
        allowed = f"{place}; allowed: finite numbers, 0 or above"
        raise InputError("pressure", float(values[i, j]), allowed)
    if not values.any():
        raise InputError("pressure", 0.0, "it is 0 everywhere; allowed: a load above 0")
    longest = max(steps)
    if not (np.isfinite(longest) and min(steps) > 1e-12 * longest):
        allowed = "allowed are steps in one unit of length"
        raise InputError("forward and lateral", tuple(map(float, steps)), allowed)
    sides = zip(axes, steps, strict=True)
    points = [np.arange(len(axis)) * (step / longest) for axis, step in sides]
    return points, values, float(longest)


def _step(label: str, axis: np.ndarray) -> float:
    """Return the spacing of coordinates, which are given as an array of shape (n,).  The spacing
    must be uniform: deviations are at most `REGULAR` times the spacing.

    Raises InputError for other coordinates.  The error message shows the pair of neighbours whose
    distance deviates most.
    """
    worst = int(np.isfinite(axis).argmin()) if len(axis) else 0
    if len(axis) > 1 and np.isfinite(axis).all():
        even, steps = np.linspace(axis[0], axis[-1], len(axis)), np.diff(axis)
        if even[1] > even[0] and np.abs(axis - even).max() <= REGULAR * (even[1] - even[0]):
            return even[1] - even[0]
        usual = np.sort(steps)[(len(steps) - 1) // 2]
        worst = int(np.abs(steps - usual).argmax())
    pair = ", ".join(f"{place:g}" for place in axis[worst : worst + 2])
    allowed = "not evenly spaced; allowed: two coordinates or more, at equal distances"
    raise InputError(label, pair, allowed)


@dataclass(frozen=True, eq=False)
class Axis:
    """One side of the smallest rectangle that contains all nonzero pressures, and the grid points
    along this side.

    points: evenly spaced coordinates, as an array of shape (n,).  low, high: coordinates of the two
    ends of the side.  step: distance between neighbouring points.  reading: one of READINGS.
    """

    points: np.ndarray
    low: float
    high: float
    step: float
    reading: str

    @property
    def middle(self) -> float:
        return 0.5 * (self.low + self.high)

    @property
    def half(self) -> float:
        """Half the length of the side."""
        return 0.5 * (self.high - self.low)

    def integrals(self, edges: np.ndarray) -> np.ndarray:
        """For each point and each interval between edges, integrate the shape function of the point
        over the interval.

        The result is an array of shape (intervals, n).
        """
        t = (edges[:, None] - self.points) / self.step
        if self.reading == "cells":
            return self.step * np.diff(np.clip(t, -0.5, 0.5), axis=0)
        rise, fall = np.full(len(self.points), -1.0), np.full(len(self.points), 1.0)
        rise[0] = fall[-1] = 0.0  # the pressure ends at the outermost points
        t = np.clip(t, rise, fall)
        return self.step * np.diff(t - 0.5 * t * np.abs(t), axis=0)

    @property
    def steps(self) -> int:
        """Length of the side divided by the step."""
        return len(self.points) - (self.reading == "samples")

    def edges(self, parts: int) -> np.ndarray:
        """Return coordinates that divide each step into `parts` equal parts."""
        return np.linspace(self.low, self.high, self.steps * parts + 1)

    def coarsened(self) -> tuple[Axis, np.ndarray]:
        """Return an axis with half as many steps, and the matrix that averages values onto this
        axis."""
        steps = -(-self.steps // 2)
        points = edges = np.linspace(self.low, self.high, steps + 1)
        middles = 0.5 * (edges[1:] + edges[:-1])
        if self.reading == "cells":
            points = middles
        else:  # average over the part nearest to each point
            edges = np.array([self.low, *middles, self.high])
        coarse = replace(self, points=points, step=(self.high - self.low) / steps)
        return coarse, self.integrals(edges) / np.diff(edges)[:, None]


class Grid(NamedTuple):
    """Values on a grid over the smallest rectangle that contains all nonzero pressures.

    The values are an array of shape (n, m).
    """

    forward: Axis
    lateral: Axis
    values: np.ndarray

    def loads(self, along: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Compute the load on each rectangle of a grid.

        The grid has n + 1 forward edges and m + 1 lateral edges.
        """
        return self.forward.integrals(along) @ self.values @ self.lateral.integrals(across).T

    def coarsened(self) -> Grid:
        """Return a grid with half the resolution."""
        forward, along = self.forward.coarsened()
        lateral, across = self.lateral.coarsened()
        return Grid(forward, lateral, along @ self.values @ across.T)


def cropped(points: Sequence[np.ndarray], values: np.ndarray, reading: str) -> Grid:
    """Create a `Grid` without the zeros around the pressure.

    points, values: return values of `checked`.  reading: one of READINGS.
    """
    axes = []
    for number, places in enumerate(points):
        first, last = np.flatnonzero(values.any(axis=1 - number))[[0, -1]]
        step = places[1] - places[0]
        if reading == "cells":
            low, high = places[first] - 0.5 * step, places[last] + 0.5 * step
        else:  # the pressure decreases to 0 towards the next point, if there is one
            first, last = max(first - 1, 0), min(last + 1, len(places) - 1)
            low, high = places[first], places[last]
        axes.append(Axis(places[first : last + 1], low, high, step, reading))
        values = values.take(range(first, last + 1), axis=number)
    return Grid(axes[0], axes[1], values)


def distances(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """For each rectangle of a grid, compute the mean distance of its points from the origin.

    x, y: coordinates of the edges of the rectangles.
    """
    areas = np.diff(x)[:, None] * np.diff(y)
    x, y = x[:, None], y[None, :]
    r = np.hypot(x, y)
    tiny = 1e-99  # replaces 0 in logarithms, which are then multiplied by 0
    corner = 2.0 * x * y * r
    corner = corner + x**3 * np.arcsinh(y / np.maximum(np.abs(x), tiny))
    corner = corner + y**3 * np.arcsinh(x / np.maximum(np.abs(y), tiny))
    return np.diff(np.diff(corner / 6.0, axis=0), axis=1) / areas


def largest_displacement(loads: np.ndarray, forward: float, lateral: float) -> float:
    """Compute the largest displacement of the cell centres under full slip, for G* = 1.

    loads: load on each cell, as an array of shape (n, n); each load is distributed uniformly over
    its cell.  forward, lateral: half-widths of the rectangle.
    """
    n = len(loads)
    edges = (np.arange(1 - n, n + 1) - 0.5) * 2.0 / n
    u, v = forward * edges[:, None], lateral * edges[None, :]
    # Integral of 1/distance over the rectangle from the centre to (u, v)
    to_corner = u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))
    kernel = np.diff(np.diff(to_corner, axis=0), axis=1) / (forward * lateral * (2.0 / n) ** 2)
    padded = (3 * n, 3 * n)  # at least 3 n - 2, so that nothing wraps around
    spectrum = np.fft.rfft2(loads, padded) * np.fft.rfft2(kernel, padded)
    displacement = np.fft.irfft2(spectrum, padded)[n - 1 : 2 * n - 1, n - 1 : 2 * n - 1]
    return float(displacement[loads > 0.0].max() / np.pi)


RINGS = 4096
"""A pressure that depends on the radius alone is approximated by this number of thin rings."""
SMALLEST_LOAD = 1e-13
"""Cell loads below this fraction of the total load are rounding errors and are set to 0."""


def of_corner_loads(load: np.ndarray) -> np.ndarray:
    """Compute the loads on the cells, as an array of shape (cells, cells) with the sum 1.

    load: load on the rectangle between the centre of the grid and each cell corner, as an array of
    shape (cells + 1, cells + 1); it is odd in both coordinates.
    """
    return of_loads(np.diff(np.diff(load, axis=0), axis=1))


def of_loads(loads: np.ndarray) -> np.ndarray:
    """Scale the loads on the cells so that their sum is 1, and replace rounding errors near 0 by
    0."""
    loads = np.where(loads < SMALLEST_LOAD * loads.sum(), 0.0, loads)
    return loads / loads.sum()


def round_loads(cells: int, ring_loads: Callable, inner: float = 0.0) -> np.ndarray:
    """Compute the cell loads of a pressure that depends on the radius alone.

    The result is an array of shape (cells, cells) with the sum 1.  The pressure is divided into
    thin rings, whose number is RINGS.  The load of each thin ring is distributed uniformly along
    its middle circle.

    Parameters
    ----------
    cells : int
        Number of cells along a side.
    ring_loads : callable
        ring_loads(psi) returns the load on each ring between neighbouring radii r = sin(psi).
    inner : float
        Radius of the hole in the contact.
    """
    turn = np.linspace(0.0, np.pi / 2, RINGS + 1)
    psi = np.arcsin(np.sqrt(inner**2 + (1.0 - inner**2) * np.sin(turn) ** 2))
    loads = ring_loads(psi)
    middle = np.sin(0.5 * (psi[1:] + psi[:-1]))
    edges = np.arange(cells + 1) * 2.0 / cells - 1.0
    sizes, places = np.unique(np.abs(edges), return_inverse=True)
    corner = np.empty((len(sizes), len(sizes)))
    across = np.arcsin(np.minimum(sizes[:, None] / middle, 1.0))
    for i, size in enumerate(sizes):
        along = np.arccos(np.minimum(size / middle, 1.0))
        corner[i] = np.maximum(across - along, 0.0) @ loads
    signs = np.sign(edges)
    return of_corner_loads(signs[:, None] * signs * corner[np.ix_(places, places)])
