"""Places of a map with a requested friction: `dataset.microslip.solve_for(...)`.

A map is known to within its error, so that the result is an interval: all places whose friction may
be the requested one, with the place where the map's own value equals it.  Friction may be the same
at several places, and then there are as many intervals.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr

from microslip.datasets.query.coordinates import labelled
from microslip.datasets.variables import flags, variable
from microslip.foundation.errors import InputError

OUTCOMES = (
    "found",
    "several",
    "possible",
    "friction is larger everywhere",
    "friction is smaller everywhere",
)
"""Outcomes of a search, by their code in the variable `outcome`; possible: within the error, but
the map's own value nowhere equals the requested friction."""
(FOUND, SEVERAL, POSSIBLE, LARGER, SMALLER) = range(len(OUTCOMES))
EVEN, GEOMETRIC = 65, 97
"""Places that are looked at first, in equal steps and in equal ratios; between two of them friction
is taken to cross what is wanted once at most."""
DECADES = 6
"""Decades from the smallest to the largest of the GEOMETRIC places."""
AT_A_TIME = 1000
"""Questions, which bounds the memory."""
ACCURACY = {"xrtol": 1e-10, "xatol": 1e-14}


class Inverse:
    """Adds questions the other way round to what has a method `at`."""

    at: Callable[..., xr.Dataset]
    _dataset: xr.Dataset
    _motion: str
    _periodic: bool

    def solve_for(
        self,
        wanted: object,
        *,
        velocity: object = None,
        amplitude: object = None,
        poisson: float | None = None,
        within: tuple[float, float] | None = None,
    ) -> xr.Dataset:
        """Amplitude or velocity at which friction is the wanted one, with its interval.

        Parameters
        ----------
        wanted : number, sequence or DataArray
            The wanted friction mu_macro, at least 0; a sequence becomes a dimension of this name.
        velocity, amplitude : number, sequence or DataArray
            The one that is known; the other one is looked for.  continuous-bore has no amplitude,
            and its velocity is looked for.
        poisson : number, optional
            As for `at`.
        within : two numbers, optional
            Where to look; the range of the dataset if not given.

        Returns
        -------
        xarray.Dataset
            Over the dimensions of what was given and `root`: the place where the map has this
            friction (NaN: none), and `_low` and `_high` of it, between which friction is the wanted
            one to within the map's error; `bounded`, whether both ends lie inside of the range.
            Without `root`: `outcome`, an index into OUTCOMES.

        Raises
        ------
        InputError
            For both or neither of the two, and as `at`.
        """
        periodic = self._periodic
        known = {"velocity": velocity, "amplitude": amplitude}
        known = {name: value for name, value in known.items() if value is not None}
        if len(known) != (1 if periodic else 0):
            allowed = "one of velocity and amplitude, the other one is looked for"
            allowed = allowed if periodic else "none, the velocity is looked for"
            raise InputError("solve_for", sorted(known), f"allowed is {allowed}")
        sought = "velocity" if "velocity" not in known else "amplitude"
        ends = _ends(self._dataset, sought, within)

        def at(place: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            points = {sought: xr.DataArray(place, dims="point")}
            points |= {name: xr.DataArray(other, dims="point") for name in known}
            found = self.at(**points, poisson=poisson)
            return found["mu_macro"].values, found["mu_macro_error"].values

        parts = [labelled("wanted", wanted)]
        parts += [labelled(name, value) for name, value in known.items()]
        parts = xr.broadcast(*parts)
        values, other = (part.values.ravel().astype(float) for part in (parts[0], parts[-1]))
        found = [
            _answers(_Questions(at, values[k : k + AT_A_TIME], other[k : k + AT_A_TIME]), *ends)
            for k in range(0, len(values), AT_A_TIME)
        ]
        return _dataset(sought, parts[0], found, self._motion)


class _Questions(NamedTuple):
    """Some questions: at(places, others) gives friction and its error; shapes (n,)."""

    at: Callable
    wanted: np.ndarray
    other: np.ndarray

    def missing(self, place: np.ndarray, row: np.ndarray) -> np.ndarray:
        """Friction less the wanted one."""
        row = np.asarray(row, int)
        return self.at(place, self.other[row])[0] - self.wanted[row]

    def beyond(self, place: np.ndarray, row: np.ndarray) -> np.ndarray:
        """How much further than its error friction is from the wanted one."""
        row = np.asarray(row, int)
        value, error = self.at(place, self.other[row])
        return np.abs(value - self.wanted[row]) - error


def _ends(
    dataset: xr.Dataset, sought: str, within: tuple[float, float] | None
) -> tuple[float, float]:
    """The range that is looked through."""
    if within is None:
        return float(dataset[sought].min()), float(dataset[sought].max())
    try:
        low, high = labelled("within", within).values.astype(float)
    except (TypeError, ValueError):
        low, high = 0.0, 0.0
    if not low < high:
        raise InputError("within", within, "allowed are two numbers >= 0, the smaller one first")
    return float(low), float(high)


def _places(low: float, high: float) -> np.ndarray:
    least = max(low, high * 10.0**-DECADES)
    both = np.linspace(low, high, EVEN), np.geomspace(least, high, GEOMETRIC)
    return np.unique(np.clip(np.concatenate(both), low, high))


def _answers(asked: _Questions, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Rows of (question, place or NaN, low end, high end, bounded), and the outcome of each."""
    places = _places(low, high)
    count = len(asked.wanted)
    value, error = (
        part.reshape(count, -1)
        for part in asked.at(np.tile(places, count), np.repeat(asked.other, len(places)))
    )
    off = value - asked.wanted[:, None]
    inside = ~(np.abs(off) > error)  # what is not known may be anything
    crosses = np.sign(off[:, :-1]) * np.sign(off[:, 1:]) < 0.0
    intervals = [(row, *one) for row in range(count) for one in _runs(inside[row], crosses[row])]
    outcome = np.where(off[:, 0] > 0.0, LARGER, SMALLER)
    if not intervals:
        return np.empty((0, 5)), outcome
    row, first, last = np.array(intervals).T
    place = _roots(asked, places, off, crosses, (row, first, last))
    ends = []
    for node, step in ((first, 1), (last, -1)):
        # The neighbour is within the error, or else the crossing is between both.
        next_node = np.clip(node + step, 0, len(places) - 1)
        inner = np.where(inside[row, next_node], places[next_node], place)
        at_end = inside[row, node]
        ends.append(_end(asked, places[node], inner, row, at_end))
    bounded = ~inside[row, first] & ~inside[row, last]
    for k in range(count):
        own = place[row == k]
        if own.size:
            known = np.isfinite(own).any()
            outcome[k] = (SEVERAL if own.size > 1 else FOUND) if known else POSSIBLE
    return np.stack([row, place, *ends, bounded], axis=1), outcome


def _runs(inside: np.ndarray, crosses: np.ndarray) -> Iterator[tuple[int, int]]:
    """Pairs of the first and the last node around what may have the wanted friction.

    The nodes of a pair are outside, unless the range ends there.
    """
    touched = inside[:-1] | inside[1:] | crosses
    cells = np.flatnonzero(touched)
    if not cells.size:
        return
    # Two cells belong together where the node between them is inside.
    breaks = np.flatnonzero((np.diff(cells) > 1) | ~inside[cells[1:]])
    for part in np.split(cells, breaks + 1):
        yield int(part[0]), int(part[-1]) + 1


def _roots(
    asked: _Questions,
    places: np.ndarray,
    off: np.ndarray,
    crosses: np.ndarray,
    runs: tuple[np.ndarray, ...],
) -> np.ndarray:
    """In each run the place where friction is the wanted one, NaN: none; the middle one of many."""
    from scipy.optimize.elementwise import find_root

    found = np.full(len(runs[0]), np.nan)
    cells = []
    for k, (row, first, last) in enumerate(zip(*runs, strict=True)):
        exact = first + np.flatnonzero(off[row, first : last + 1] == 0.0)
        own = first + np.flatnonzero(crosses[row, first:last])
        if exact.size:
            found[k] = places[exact[len(exact) // 2]]
        elif own.size:
            cells.append((k, row, own[len(own) // 2]))
    if cells:
        which, row, cell = np.array(cells).T
        bracket = places[cell], places[cell + 1]
        answer = find_root(asked.missing, bracket, args=(row.astype(float),), tolerances=ACCURACY)
        found[which] = answer.x
    return found


def _end(
    asked: _Questions, outer: np.ndarray, inner: np.ndarray, row: np.ndarray, skip: np.ndarray
) -> np.ndarray:
    """End of the interval within the error, between a place outside of it and one inside; the
    outer place itself where `skip`."""
    from scipy.optimize.elementwise import find_root

    end = np.where(skip | np.isnan(inner), outer, inner)
    if skip.all():
        return end
    left, right = np.minimum(outer, end)[~skip], np.maximum(outer, end)[~skip]
    rows = row[~skip].astype(float)
    answer = find_root(asked.beyond, (left, right), args=(rows,), tolerances=ACCURACY)
    end[~skip] = np.where(answer.success, answer.x, end[~skip])  # an error of 0 leaves no room
    return end


def _dataset(
    sought: str, shape: xr.DataArray, found: list[tuple[np.ndarray, np.ndarray]], motion: str
) -> xr.Dataset:
    """The answers of all questions as arrays of the shape of what was asked."""
    offsets = np.cumsum([0] + [len(outcome) for _, outcome in found])
    rows = np.concatenate(
        [part + np.array([k, 0, 0, 0, 0]) for (part, _), k in zip(found, offsets, strict=False)]
    )
    outcome = np.concatenate([part for _, part in found])
    row = rows[:, 0].astype(int)
    first = np.searchsorted(row, row)  # rows of one question follow one another
    root = np.arange(len(row)) - first
    most = int(root.max(initial=0)) + 1
    table = np.full((4, len(outcome), most), np.nan)
    table[:, row, root] = rows[:, 1:].T
    dims, size = (*shape.dims, "root"), (*shape.shape, most)
    texts = {
        sought: f"{sought} with the wanted friction",
        f"{sought}_low": "lower end of its interval",
        f"{sought}_high": "upper end of its interval",
    }
    values = {
        name: variable(dims, part.reshape(size), text)
        for (name, text), part in zip(texts.items(), table, strict=False)
    }
    inside = (table[3] == 1.0).reshape(size)
    values["bounded"] = variable(dims, inside, "both ends lie inside of the range", bool)
    codes = outcome.reshape(shape.shape)
    values["outcome"] = flags(shape.dims, codes, "outcome of the search", OUTCOMES)
    return xr.Dataset(values, coords=shape.coords, attrs={"motion": motion})
