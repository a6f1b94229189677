"""Pressures given by values on a regular grid, from a sensor or from another program."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from microslip.foundation.errors import InputError
from microslip.pressures.cell_loads import of_loads

AXES = ("forward", "lateral")
READINGS = ("cells", "samples")
"""Possible meanings of the values on a grid.  With "cells", a value is the mean over the cell
around a point; a cell is one step wide.  With "samples", values apply at the points and are
interpolated bilinearly.  The pressure is 0 outside the grid."""
FINE = 256
"""Number of squares along a side in the computation of u_lim and the torque."""
FINEST = 1024
"""Largest number of squares along a side.  Grids with more than FINE points along a side use more
than FINE squares."""
REGULAR = 1e-3
"""Largest allowed distance of a coordinate from the regular grid, divided by the step of the
grid."""


def read_grids(
    forward: np.ndarray, lateral: np.ndarray, values: np.ndarray, reading: str
) -> dict[str, Grid]:
    """Create a Grid from values on a regular grid, and alternative grids from the same values.

    The unit of length a is half the longer side of the smallest rectangle that contains all
    pressure.  Rotations are about the centre of this rectangle.

    Parameters
    ----------
    forward, lateral : array, shapes (n,) and (m,)
        Increasing coordinates, both in the same unit of length.
    values : array, shape (n, m)
        Pressure in any unit, 0 outside the contact.
    reading : str
        Meaning of the values, one of READINGS.

    Returns
    -------
    dict of str to Grid
        Label -> grid.  The first label is "", for the grid itself.  The second has the same values
        with the other meaning in READINGS, and the third has half the resolution.

    Raises
    ------
    InputError
        If coordinates are not evenly spaced, if a value is negative or not finite, or if all values
        are 0.
    """
    values = np.asarray(values, float)
    axes = [np.asarray(axis, float) for axis in (forward, lateral)]
    points = [_even(label, axis) for label, axis in zip(AXES, axes, strict=True)]
    _refuse(axes[0], axes[1], values)
    peak, (points, step) = float(values.max()), _in_steps(points)
    grid, other = (
        _grid(points, values / peak, kind, step, peak)
        for kind in sorted(READINGS, key=reading.__ne__)
    )
    return {
        "": grid,
        f"read as {other.reading}": other,
        "at half its resolution": _coarsened(grid),
    }


def _refuse(forward: np.ndarray, lateral: np.ndarray, values: np.ndarray) -> None:
    """Raise InputError if a value is negative or not finite, or if all values are 0."""
    bad = np.argwhere(~(np.isfinite(values) & (values >= 0.0)))
    if len(bad):
        i, j = bad[0]
        place = f"at forward {forward[i]:g}, lateral {lateral[j]:g}"
        allowed = f"{place}; allowed: finite numbers, 0 or above"
        raise InputError("pressure", float(values[i, j]), allowed)
    if not values.any():
        raise InputError("pressure", 0.0, "it is 0 everywhere; allowed: a load above 0")


def _even(label: str, axis: np.ndarray) -> np.ndarray:
    """Replace the coordinates of an axis (n,) by evenly spaced ones, within the tolerance REGULAR.

    Raises InputError for uneven coordinates; the message shows the pair whose distance deviates
    most.
    """
    worst = int(np.isfinite(axis).argmin()) if len(axis) else 0
    if len(axis) > 1 and np.isfinite(axis).all():
        even, steps = np.linspace(axis[0], axis[-1], len(axis)), np.diff(axis)
        if even[1] > even[0] and np.abs(axis - even).max() <= REGULAR * (even[1] - even[0]):
            return even
        usual = np.sort(steps)[(len(steps) - 1) // 2]
        worst = int(np.abs(steps - usual).argmax())
    raise InputError(
        label,
        ", ".join(f"{place:g}" for place in axis[worst : worst + 2]),
        "not evenly spaced; allowed: two coordinates or more, at equal distances",
    )


def _in_steps(points: Sequence[np.ndarray]) -> tuple[list[np.ndarray], float]:
    """Return coordinates that start at 0, in units of the longer step, and the length of this step.
    In these units, areas neither overflow nor underflow.

    Raises InputError if one step is more than 1e12 times the other.
    """
    steps = [places[1] - places[0] for places in points]
    longest = max(steps)
    if not (np.isfinite(longest) and min(steps) > 1e-12 * longest):
        raise InputError(
            "forward and lateral",
            tuple(map(float, steps)),
            "allowed are steps in one unit of length",
        )
    scaled = [
        np.arange(len(places)) * (step / longest)
        for places, step in zip(points, steps, strict=True)
    ]
    return scaled, float(longest)


@dataclass(frozen=True, eq=False)
class _Axis:
    """One side of the smallest rectangle that contains all pressure, and the grid points on it.

    points: evenly spaced coordinates, (n,); low, high: ends of the side; step: distance between
    points.
    """

    points: np.ndarray
    low: float
    high: float
    step: float
    reading: str

    def integrals(self, edges: np.ndarray) -> np.ndarray:
        """Integral of the shape function of each point over each interval, (intervals, n)."""
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

    def coarsened(self) -> tuple[_Axis, np.ndarray]:
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


@dataclass(frozen=True, eq=False)
class Grid:
    """Values (n, m) on a grid over the smallest rectangle that contains all pressure.

    step: the unit of the axes, expressed in the unit of the coordinates.  peak: the unit of the
    values, expressed in the unit of the pressure.
    """

    forward: _Axis
    lateral: _Axis
    values: np.ndarray
    step: float = 1.0
    peak: float = 1.0

    @property
    def reading(self) -> str:
        """Meaning of the values, one of READINGS."""
        return self.forward.reading

    def loads(self, along: np.ndarray, across: np.ndarray) -> np.ndarray:
        """Load of each rectangle between forward edges (n + 1,) and lateral edges (m + 1,)."""
        return self.forward.integrals(along) @ self.values @ self.lateral.integrals(across).T

    @property
    def middles(self) -> list[float]:
        """Forward and lateral coordinates of the centre of the rectangle."""
        return [0.5 * (side.low + side.high) for side in (self.forward, self.lateral)]

    @property
    def half_widths(self) -> list[float]:
        """Half of the forward and the lateral width of the rectangle."""
        return [0.5 * (side.high - side.low) for side in (self.forward, self.lateral)]

    @property
    def half(self) -> float:
        """Half the longer side of the rectangle, which is the unit of length a."""
        return max(self.half_widths)

    def cell_loads(self, cells: int) -> np.ndarray:
        """Load on each of cells x cells cells of the rectangle; the sum is 1."""
        edges = np.arange(cells + 1) * 2.0 / cells - 1.0
        sides = zip(self.middles, self.half_widths, strict=True)
        return of_loads(self.loads(*(middle + half * edges for middle, half in sides)))

    @property
    def area(self) -> float:
        """Area of the cells under pressure, divided by a^2."""
        cell = self.forward.step * self.lateral.step
        return np.count_nonzero(self.values) * cell / self.half**2

    def reduced_modulus(self) -> float:
        """G* in working units.  It equals the largest displacement under full slip for G* = 1."""
        fine = min(max(FINE, *self.values.shape), FINEST)
        forward, lateral = (width / self.half for width in self.half_widths)
        return _largest_displacement(self.cell_loads(fine), forward, lateral)

    def largest(self) -> float:
        """Largest pressure divided by F_z / a^2."""
        return float(self.values.max()) * self.half**2 / self.total

    @property
    def total(self) -> float:
        """Integral of the values over the rectangle."""
        return float(self.loads(self.forward.edges(1), self.lateral.edges(1)).sum())

    def mean_distance(self) -> float:
        """Mean distance from the centre, weighted with the pressure and divided by a.  It is exact
        for the meaning "cells"."""
        edges = [side.edges(-(-FINE // side.steps)) for side in (self.forward, self.lateral)]
        loads = self.loads(*edges)
        x, y = ((axis - at) / self.half for axis, at in zip(edges, self.middles, strict=True))
        areas = np.diff(x)[:, None] * np.diff(y)
        return float(np.sum(loads * _distances(x, y) / areas) / loads.sum())


def _grid(
    points: Sequence[np.ndarray], values: np.ndarray, reading: str, unit: float, peak: float
) -> Grid:
    axes = []
    for number, places in enumerate(points):
        loaded = np.flatnonzero(values.any(axis=1 - number))
        first, last = loaded[0], loaded[-1]
        step = places[1] - places[0]
        if reading == "cells":
            low, high = places[first] - 0.5 * step, places[last] + 0.5 * step
        else:  # the pressure falls to 0 towards the next point, if there is one
            first, last = max(first - 1, 0), min(last + 1, len(places) - 1)
            low, high = places[first], places[last]
        axes.append(_Axis(places[first : last + 1], low, high, step, reading))
        values = values.take(range(first, last + 1), axis=number)
    forward, lateral = axes
    return Grid(forward, lateral, values, unit, peak)


def _coarsened(grid: Grid) -> Grid:
    forward, along = grid.forward.coarsened()
    lateral, across = grid.lateral.coarsened()
    values = along @ grid.values @ across.T
    return replace(grid, forward=forward, lateral=lateral, values=values)


def _distances(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Integrate the distance from the origin over each rectangle of the grid with the edges x and
    y."""
    x, y = x[:, None], y[None, :]
    r = np.hypot(x, y)
    tiny = 1e-99  # where it replaces 0, the logarithm is multiplied by 0
    corner = 2.0 * x * y * r
    corner = corner + x**3 * np.arcsinh(y / np.maximum(np.abs(x), tiny))
    corner = corner + y**3 * np.arcsinh(x / np.maximum(np.abs(y), tiny))
    return np.diff(np.diff(corner / 6.0, axis=0), axis=1)


def _largest_displacement(loads: np.ndarray, forward: float, lateral: float) -> float:
    """Largest displacement at the centre of a cell under full slip, for G* = 1.

    loads: load of each cell, (n, n), spread evenly over the cell.  forward, lateral: half of the
    widths of the rectangle.
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
