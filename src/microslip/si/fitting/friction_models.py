"""Friction of a fit's rows, from an existing map, or from the solver and a coarse map.

A fit evaluates the friction of all rows for hundreds of pairs of unknowns.  The solver first
computes a coarse map.  This map gives the change of friction between two guesses.  Then the solver
computes the rows at the best guess so far, which corrects the coarse map at this guess.  At the
end, the remaining error of the coarse map is of second order.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, cached_property, partial
from typing import Any

import numpy as np

from microslip.adaptive.point import solve
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.si.fitting.scales import LEAST, MOST, Points
from microslip.si.friction_map import FrictionMap

SLOWEST, FASTEST = 1e-3, 20.0
"""Smallest and largest ratio of velocity to amplitude in the coarse map."""
NODES_A_DECADE = {"amplitude": 5, "ratio": 4}
"""Number of nodes of the coarse map per decade."""
COARSE = {"poisson": 0.0, "tolerance": 5e-3}
"""Settings of the coarse map.  Poisson's ratio hardly changes the slopes.  It is set to 0 to save
time."""
MOST_SOLVED = 200
"""Largest number of rows for a fit without a map."""


class MapFriction:
    """Friction interpolated in the dataset of a sweep; see datasets.accessor.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep of the requested motion.
    poisson : float
        Poisson's ratio.

    Raises
    ------
    InputError
        If the dataset is not of this motion, or does not contain this Poisson's ratio.
    """

    def __init__(self, dataset: Any, motion: str, poisson: float | None):
        self._map, self._poisson = FrictionMap(dataset, motion), poisson
        axes = (dataset[name] for name in ("velocity", "amplitude"))
        self._ends = [(float(axis.where(axis > 0.0).min()), float(axis.max())) for axis in axes]
        self._proved = motion == "transverse" and poisson == 0.0

    def at(self, points: Points) -> np.ndarray:
        """mu_macro at any points, shape (n,)."""
        if not self._proved:  # guesses may lie outside the map
            parts = zip(points, self._ends, strict=True)
            points = Points(*(np.clip(part, *ends) for part, ends in parts))
        return self._answer(points)[0]

    rough = at

    def anchor(self, points: Points) -> None:
        """Do nothing: a map needs no corrections."""

    def errors(self, points: Points) -> np.ndarray:
        """Error estimates of the friction at the points, shape (n,)."""
        try:
            return self._answer(points)[1]
        except ValueError as error:
            problem = f"does not contain the rows at the best fit: {error}"
            raise InputError("map", self._map.motion, problem) from None

    def _answer(self, points: Points) -> tuple[np.ndarray, np.ndarray]:
        from xarray import DataArray

        velocity, amplitude = (DataArray(part, dims="row") for part in points)
        return self._map.at(velocity, amplitude, self._poisson)


class SolvedFriction:
    """Friction from the solver and a coarse map.  The axes of the map are the logarithms of
    amplitude and ratio.

    The ratio is the velocity divided by the amplitude, which does not depend on u_lim.

    Parameters
    ----------
    motion : str
        Name of the motion.
    poisson, tolerance : float
        Arguments of microslip.solve.
    ends : list of Points
        Points of all rows, first for the smallest value of the second unknown, then for the
        largest.

    Raises
    ------
    InputError
        If there are more than MOST_SOLVED rows.
    """

    def __init__(self, motion: str, poisson: float, tolerance: float, ends: list[Points]):
        count = len(ends[0].velocity)
        if count > MOST_SOLVED:
            allowed = f"rows; allowed are at most {MOST_SOLVED}, or any number with a map"
            raise InputError("measured", count, allowed)
        self._motion = motion
        # each point is solved once
        self._solved = cache(partial(_solution, motion, poisson=poisson, tolerance=tolerance))
        axes = np.concatenate([self._coordinates(points) for points in ends], axis=1)
        nodes = NODES_A_DECADE["amplitude"], NODES_A_DECADE["ratio"]
        self._axes = [_axis(*pair) for pair in zip(axes, nodes, strict=True)]
        self._off: np.ndarray | float = 0.0
        self._errors = np.full(count, np.inf)

    def at(self, points: Points) -> np.ndarray:
        """mu_macro of all rows for each guess, with the corrections of the last `anchor`.

        Errors far from the best guess affect the iterations but not the result.
        """
        off = np.resize(self._off, len(points.amplitude))  # for each row of every guess
        return np.where(points.amplitude > 0.0, self._coarse(points) + off, 1.0)

    def anchor(self, points: Points) -> None:
        """Compute the corrections at the points of the best guess so far."""
        answers = [self._solved(v, a) for v, a in zip(*points, strict=True)]
        values, self._errors = np.array(answers).T
        self._off = values - self._coarse(points)

    def errors(self, points: Points) -> np.ndarray:
        """Error estimates of the friction at the points of the last correction, shape (n,)."""
        return self._errors

    def rough(self, points: Points) -> np.ndarray:
        """mu_macro at any points, without the corrections."""
        return np.where(points.amplitude > 0.0, self._coarse(points), 1.0)

    def _coordinates(self, points: Points) -> tuple[np.ndarray, np.ndarray]:
        """Logarithms of amplitude and ratio, clipped to the range of the coarse map."""
        velocity, amplitude = points
        moving = amplitude > 0.0
        size = np.clip(amplitude, LEAST, MOST)
        ratio = np.divide(velocity, amplitude, out=np.full_like(size, FASTEST), where=moving)
        return np.log(size), np.log(np.clip(ratio, SLOWEST, FASTEST))

    def _coarse(self, points: Points) -> np.ndarray:
        return self._map(*self._coordinates(points), grid=False)

    @cached_property
    def _map(self) -> Callable:
        """The coarse map."""
        from scipy.interpolate import RectBivariateSpline

        sizes, ratios = (np.exp(axis) for axis in self._axes)
        values = [
            [_solution(self._motion, ratio * size, size, **COARSE)[0] for ratio in ratios]
            for size in sizes
        ]
        return RectBivariateSpline(*self._axes, np.array(values), s=0)


def _solution(
    motion: str, velocity: float, amplitude: float, **settings: Any
) -> tuple[float, float]:
    """mu_macro and its error estimate from the solver."""
    if amplitude == 0.0:
        return 1.0, 0.0
    point = (min(part, LARGEST["velocity"]) for part in (velocity, amplitude))
    result = solve(motion, *point, **settings)
    if not np.isfinite(result.mu_macro):
        where = f"velocity {velocity:.3g} and amplitude {amplitude:.3g}"
        problem = f"no answer at {where}: {result.reason}"
        raise InputError("tolerance", settings["tolerance"], problem)
    return result.mu_macro, result.mu_macro_error


def _axis(values: np.ndarray, a_decade: float) -> np.ndarray:
    """Return at least four nodes that cover the range of these logarithms."""
    low, high = values.min() - 0.1, values.max() + 0.1
    count = max(4, 1 + int(np.ceil((high - low) / np.log(10.0) * a_decade)))
    return np.linspace(low, high, count)


FrictionModel = MapFriction | SolvedFriction
"""A model of mu_macro and its error estimate in each row."""
