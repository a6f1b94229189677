"""Chains of runs along one axis: a value at ever finer resolutions, and how far to trust it.

See microslip.adaptive.refinement for how an answer is made of them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from microslip.solver.discretise import Resolution

EXTRAPOLATED_SHARES = 0.6, 0.5
"""Errors of regular axes over the last extrapolation, and over the change of the extrapolated
value."""
CALIBRATED = 1.7
"""Error over what is estimated by the second power, from shares or projections, and over the mixed
difference: chosen on the random points of benchmarks/certificates.py, where 1 claim in 100 would
not hold without, and 1 in 300 with 1.4."""
SPREAD = 1.25
"""Error over the spread of the last runs along an irregular axis, chosen likewise."""
FITTED, JUDGED = 3, 4
"""Runs that a fitted value is extrapolated from, and those that its error is seen by, and that of a
static limit which was refined."""
FITTED_SHARES = 1.0, 1.0
"""Errors of fitted axes over the largest projection, and over the scatter about the line:
calibrated on the random bores of benchmarks/certificates.py."""
RESOLVED = 0.125
"""Share of the tolerance below which no axis claims its error to be: nothing was run to see it."""
READING_CAUTION = 2.5
"""Error over the sum of what the readings of a pressure change: a peak or an edge that falls
between the points of a grid shows in none of them in full."""


@dataclass(frozen=True)
class Axis:
    """One axis of refinement.

    Attributes
    ----------
    name : str
        "cells", "angles" or "steps".
    levels : tuple of int
        Resolutions, increasing.
    base : int
        Index of the one that the chains of other axes are run at.
    first : tuple of int
        Indices of the runs to start with, as many as the error is estimated from, at least three.
    regular : bool
        The error falls smoothly, with the second power of the levels, so that it can be
        extrapolated.
    imposed : bool
        The last level is what was asked for, and its error, the spread of the last three again, is
        only reported.
    projected : bool
        The error falls about so, but irregularly: each of the last differences tells how far the
        value would still go at the second power, and the largest is believed, but not added.
    caution : float
        Errors of irregular axes over that, or over their spread.
    shares : tuple of float
        See EXTRAPOLATED_SHARES.
    scatter : float
        Share of the correction along an irregular axis that its scatter may do to the differences
        of other chains.
    tied : tuple of (str, tuple of int)
        Names and levels of what is refined together with it, where none converges without the
        others.
    fitted : bool
        What it refines is all that there is, and the error of that falls with the second power of
        its levels, but for a scatter: a line through the last FITTED of the values tells what is
        left.
    resolved : float
        See RESOLVED.
    judged : int
        Runs that the error is seen by once the axis was refined; 0: as many as it began with.
    mixed : bool
        What it does together with the cells is measured.
    """

    name: str
    levels: tuple[int, ...]
    base: int
    first: tuple[int, ...]
    regular: bool = False
    imposed: bool = False
    projected: bool = False
    caution: float = 1.0
    shares: tuple[float, float] = EXTRAPOLATED_SHARES
    scatter: float = 0.5
    tied: tuple[tuple[str, tuple[int, ...]], ...] = ()
    fitted: bool = False
    resolved: float = RESOLVED
    judged: int = 0
    mixed: bool = False

    @property
    def refines(self) -> tuple[str, ...]:
        """Names of what it refines: itself, and what is tied to it."""
        return self.name, *(name for name, _ in self.tied)


class Runs:
    """Runs at (cells, angles, steps), given as indices into the levels of the axes; each once.

    read(run) returns the quantity to be refined, a float, from a run.Run.
    """

    def __init__(
        self,
        run: Callable | None,
        coarsest: Resolution,
        axes: Sequence[Axis],
        read: Callable = attrgetter("mu"),
    ):
        self.run, self.coarsest, self.axes = run, coarsest, {axis.name: axis for axis in axes}
        self.read = read
        self.base = {axis.name: axis.base for axis in axes}
        self.done = {}

    def resolution(self, **indices: int) -> Resolution:
        """The base with some indices replaced, as a problem.Resolution."""
        at = self.base | indices
        levels = {name: self.axes[name].levels[index] for name, index in at.items()}
        for name, index in at.items():
            levels |= {other: counts[index] for other, counts in self.axes[name].tied}
        return replace(self.coarsest, **levels)

    def __call__(self, **indices):
        resolution = self.resolution(**indices)
        if resolution not in self.done:
            self.done[resolution] = self.run(resolution, self._guess(indices))
        return self.done[resolution]

    def _guess(self, indices):
        """A run near that at some indices: at the base, or one level coarser on a fitted axis."""
        coarser = {
            name: index - 1 for name, index in indices.items() if self.axes[name].fitted and index
        }
        return self.done.get(self.resolution(**coarser))


class Readings:
    """The finest run along the cells, under other pressures that the same numbers may stand for."""

    def __init__(self, runs: Runs, readings: Sequence[Callable]):
        self.runs, self.readings, self.done = runs, readings, {}

    def open(self, chains: dict[str, Chain], read: Callable) -> float:
        """How far they leave the value read(run) open."""
        first = refines_cells(chains)
        finest = {} if first is None else {first: chains[first].indices[-1]}
        resolution, plain = self.runs.resolution(**finest), self.runs(**finest)
        value = read(plain)
        for number, run in enumerate(self.readings):
            if (number, resolution) not in self.done:
                self.done[number, resolution] = run(resolution, plain)  # which it is close to
        return READING_CAUTION * sum(
            abs(read(self.done[number, resolution]) - value) for number in range(len(self.readings))
        )


class Chain:
    """Runs along one axis, the others at the base."""

    def __init__(self, runs: Runs, axis: Axis):
        self.runs, self.axis = runs, axis
        self.indices = list(axis.first)

    @property
    def levels(self) -> list[int]:
        return [self.axis.levels[index] for index in self.indices]

    @property
    def judged(self) -> int:
        """Runs that the error is seen by."""
        began = len(self.axis.first)
        refined = self.axis.judged and len(self.indices) > began
        return self.axis.judged if refined else began

    def values(self, read: Callable) -> list:
        """read(run) for each run of the chain: numbers, or vectors of one shape."""
        return [read(self.runs(**{self.axis.name: index})) for index in self.indices]

    def rebase(self) -> None:
        """Go on from a new base: no more runs than the error needs, up to the base at least."""
        last = max(self.indices[-1], self.runs.base[self.axis.name])
        self.indices = list(range(max(last + 1 - len(self.axis.first), 0), last + 1))

    def refine(self) -> bool:
        """One more run; False if there is no finer level."""
        if self.indices[-1] + 1 == len(self.axis.levels):
            return False
        self.indices.append(self.indices[-1] + 1)
        return True

    def correction(self, read: Callable) -> float | np.ndarray:
        """The chain's addition to the value at the base, a linear combination of its values."""
        values = self.values(read)
        added = values[-1] - read(self.runs())
        if self.axis.regular:
            added += _extrapolation(values, self.levels)
        if self.axis.fitted:
            added += _limit(values[-FITTED:], self.levels[-FITTED:]) - values[-1]
        return added

    def error(self, read: Callable) -> float:
        """Estimated error after the correction."""
        values, levels = self.values(read), self.levels
        if self.axis.regular:
            beyond = _extrapolation(values, levels)
            before = _extrapolation(values[:-1], levels[:-1])
            change = values[-1] + beyond - values[-2] - before
            share, share_of_change = self.axis.shares
            return CALIBRATED * (share * abs(beyond) + share_of_change * abs(change))
        values, levels = values[-self.judged :], levels[-self.judged :]
        if self.axis.fitted:
            share, share_of_scatter = FITTED_SHARES
            # few rings may converge with the first power; the answer assumes the second
            first = values[-1] + _extrapolation(values, levels, order=1)
            unseen = abs(first - _limit(values[-FITTED:], levels[-FITTED:]))
            seen = max(share * _largest_projection(values, levels), unseen)
            return seen + share_of_scatter * _scatter(values, levels)
        if self.axis.projected:
            return CALIBRATED * self.axis.caution * _largest_projection(values, levels)
        spread = max(values) - min(values)
        return self.axis.caution * spread * (1.0 if self.axis.imposed else SPREAD)


def _extrapolation(values, levels, order=2):
    """What convergence of an order would still add to the last of the values."""
    return (values[-1] - values[-2]) / ((levels[-1] / levels[-2]) ** order - 1.0)


def _largest_projection(values, levels):
    """How far the last value may be off, as each of the differences tells it."""
    return max(
        abs(_extrapolation(values[:end], levels[:end])) * (levels[end - 1] / levels[-1]) ** 2
        for end in range(2, len(values) + 1)
    )


def _line(values, levels):
    """Limit and slope of a line through values over the inverse square of their levels; the values
    and the terms of the line, each times a scale with which all values scatter equally."""
    scale = (np.array(levels) / levels[-1]) ** 2
    terms = np.stack([scale, np.ones(len(levels))], axis=1)
    scaled = (scale * np.array(values).T).T
    return np.linalg.lstsq(terms, scaled, rcond=None)[0], scaled, terms


def _limit(values, levels):
    """Value of the line at infinitely fine levels."""
    return _line(values, levels)[0][0]


def _scatter(values, levels):
    """Standard deviation of a value at the last level about the line: the scatter falls as the
    error does."""
    line, scaled, terms = _line(values, levels)
    residual = scaled - terms @ line
    return float(np.sqrt(residual @ residual / (len(levels) - 2)))


def refines_cells(chains: dict[str, Chain]) -> str | None:
    """Name of the axis that refines the cells, or None."""
    return next((name for name, chain in chains.items() if "cells" in chain.axis.refines), None)
