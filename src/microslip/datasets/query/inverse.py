"""Search a map for the velocities or amplitudes at which friction has a requested value.

Because a map has an error, the result is an interval in which friction equals the requested value
to within the error.  The result also includes the place at which the map has exactly this value.
If friction has the value at several places, there is an interval for each place.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr

from microslip.datasets.query.coordinates import coordinate_array
from microslip.datasets.variables import flags, variable
from microslip.foundation.errors import InputError

OUTCOMES = (
    "found",
    "several",
    "possible",
    "friction is larger everywhere",
    "friction is smaller everywhere",
)
"""Outcomes of a search.  The variable `outcome` contains their indices.  The outcome is "possible"
if the map reaches the value only to within the error."""
(SINGLE, SEVERAL, POSSIBLE, LARGER, SMALLER) = range(len(OUTCOMES))
EVEN, GEOMETRIC = 65, 97
"""Numbers of evenly spaced and of logarithmically spaced places at which a search first evaluates
friction.  Friction is assumed to cross the requested value at most once between neighbouring
places."""
DECADES = 6
"""Number of decades covered by the logarithmically spaced places."""
AT_A_TIME = 1000
"""Number of simultaneous searches.  This number limits the memory use."""
ACCURACY = {"xrtol": 1e-10, "xatol": 1e-14}

Friction = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]
"""Function friction_at(searched coordinate, other coordinate) -> (friction, error), shape (n,)
each."""


def ends_of(
    dataset: xr.Dataset, name: str, within: tuple[float, float] | None
) -> tuple[float, float]:
    """Return the ends of the searched range: `within`, or the range of the dataset."""
    if within is None:
        return float(dataset[name].min()), float(dataset[name].max())
    try:
        low, high = coordinate_array("within", within).values.astype(float)
    except (TypeError, ValueError):
        low, high = 0.0, 0.0
    if not low < high:
        raise InputError("within", within, "allowed are two numbers >= 0, the smaller one first")
    return float(low), float(high)


def search(
    at: Friction, wanted: np.ndarray, other: np.ndarray, ends: tuple[float, float]
) -> tuple[np.ndarray, np.ndarray]:
    """Search a range for requested values of friction.

    Parameters
    ----------
    at : callable
        Function that returns friction and its error.
    wanted, other : numpy.ndarray, shape (n,)
        Requested values of friction, and values of the coordinate that is not searched.
    ends : tuple of float
        Ends of the searched range.

    Returns
    -------
    intervals : numpy.ndarray, shape (k, 5)
        A row for each interval, in ascending order.  Its entries are the index of the search, the
        place or NaN, the lower end, the upper end, and 1 if both ends are inside the range, else 0.
    outcome : numpy.ndarray, shape (n,)
        Indices into OUTCOMES.
    """
    low, high = ends
    least = max(low, high * 10.0**-DECADES)
    both = np.linspace(low, high, EVEN), np.geomspace(least, high, GEOMETRIC)
    places = np.unique(np.clip(np.concatenate(both), low, high))
    intervals, outcomes = [np.empty((0, 5))], [np.empty(0, int)]
    for begin in range(0, len(wanted), AT_A_TIME):
        part = slice(begin, begin + AT_A_TIME)
        rows, outcome = _search(at, wanted[part], other[part], places)
        rows[:, 0] += begin
        intervals.append(rows)
        outcomes.append(outcome)
    return np.concatenate(intervals), np.concatenate(outcomes)


def _search(
    at: Friction, wanted: np.ndarray, other: np.ndarray, places: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the intervals and outcomes of `search` from friction at `places`."""

    def difference(place: np.ndarray, wanted: np.ndarray, other: np.ndarray) -> np.ndarray:
        return at(place, other)[0] - wanted

    def excess(place: np.ndarray, wanted: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return the absolute difference between friction and the requested value, minus the
        error."""
        value, error = at(place, other)
        return np.abs(value - wanted) - error

    count = len(wanted)
    value, error = (
        part.reshape(count, -1)
        for part in at(np.tile(places, count), np.repeat(other, len(places)))
    )
    off = value - wanted[:, None]
    inside = ~(np.abs(off) > error)  # an unknown value may equal the requested value
    crosses = np.sign(off[:, :-1]) * np.sign(off[:, 1:]) < 0.0
    # A run of cells can contain the requested friction.  Two cells belong to the same run if
    # friction at the node between them is within the error of the request ("inside").  The nodes at
    # the ends of a run are outside, except at the ends of the range.
    touched = inside[:, :-1] | inside[:, 1:] | crosses
    row, first = np.nonzero(touched & ~np.pad(inside[:, 1:-1], ((0, 0), (1, 0))))
    last = np.nonzero(touched & ~np.pad(inside[:, 1:-1], ((0, 0), (0, 1))))[1] + 1
    arguments = wanted[row], other[row]
    place = np.full(len(row), np.nan)
    crossings = np.full(len(row), -1)
    for k, (i, begin, stop) in enumerate(zip(row, first, last, strict=True)):
        exact = begin + np.flatnonzero(off[i, begin : stop + 1] == 0.0)
        cells = begin + np.flatnonzero(crosses[i, begin:stop])
        if exact.size:
            place[k] = places[exact[len(exact) // 2]]
        elif cells.size:
            crossings[k] = cells[len(cells) // 2]
    crossed = crossings >= 0
    lower = crossings[crossed]
    place[crossed], _ = _roots(difference, places[lower], places[lower + 1], arguments, crossed)
    ends = []
    for node, step in ((first, 1), (last, -1)):
        # The end lies between an outer node, which is outside, and an inner place.  The inner place
        # is the neighbouring node if this node is inside, else the place of the requested friction.
        neighbour = np.clip(node + step, 0, len(places) - 1)
        inner = np.where(inside[row, neighbour], places[neighbour], place)
        end = np.where(inside[row, node] | np.isnan(inner), places[node], inner)
        outer = ~inside[row, node]
        left, right = np.sort([places[node][outer], end[outer]], axis=0)
        root, success = _roots(excess, left, right, arguments, outer)
        end[outer] = np.where(success, root, end[outer])  # with an error of 0 there is no root
        ends.append(end)
    bounded = ~inside[row, first] & ~inside[row, last]
    number = np.bincount(row, minlength=count)
    has_place = np.bincount(row, np.isfinite(place), count) > 0
    outcome = np.select(
        [has_place & (number > 1), has_place, number > 0, off[:, 0] > 0.0],
        [SEVERAL, SINGLE, POSSIBLE, LARGER],
        SMALLER,
    )
    return np.stack([row, place, *ends, bounded], axis=1), outcome


def _roots(
    function: Callable,
    left: np.ndarray,
    right: np.ndarray,
    arguments: tuple[np.ndarray, ...],
    chosen: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Find the roots of a function in brackets.  Return the roots and, for each bracket, whether
    the search succeeded.

    left, right: ends of the brackets, shape (n,); arguments: additional arguments of the function,
    shape (m,) each; chosen: mask, shape (m,), that selects the arguments for the n brackets.
    """
    from scipy.optimize.elementwise import find_root

    if not len(left):
        return left, np.ones(0, bool)
    more = tuple(part[chosen] for part in arguments)
    result = find_root(function, (left, right), args=more, tolerances=ACCURACY)
    return result.x, result.success


def answer(
    name: str, shape: xr.DataArray, intervals: np.ndarray, outcome: np.ndarray, motion: str
) -> xr.Dataset:
    """Convert intervals to a dataset with the request's dimensions and the dimension `root`.

    Parameters
    ----------
    name : str
        Name of the searched coordinate.
    shape : xarray.DataArray
        Dimensions and coordinates of the request.
    intervals, outcome : numpy.ndarray
        Results of `search`.
    motion : str
        Name of the motion, stored as an attribute of the dataset.
    """
    row = intervals[:, 0].astype(int)
    root = np.arange(len(row)) - np.searchsorted(row, row)
    most = int(root.max(initial=0)) + 1
    table = np.full((4, len(outcome), most), np.nan)
    table[:, row, root] = intervals[:, 1:].T
    dims, (place, low, high, bounded) = (*shape.dims, "root"), table.reshape(4, *shape.shape, most)
    inside = bounded == 1.0
    codes = outcome.reshape(shape.shape)
    values = {
        name: variable(dims, place, f"{name} with the wanted friction"),
        f"{name}_low": variable(dims, low, "lower end of its interval"),
        f"{name}_high": variable(dims, high, "upper end of its interval"),
        "bounded": variable(dims, inside, "both ends lie inside of the range", bool),
        "outcome": flags(shape.dims, codes, "outcome of the search", OUTCOMES),
    }
    return xr.Dataset(values, coords=shape.coords, attrs={"motion": motion})
