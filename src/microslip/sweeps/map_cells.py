"""Cells of a map, and where they have to be split: from what is known to what is asked next.

A cell is a box in scaled coordinates (map_coordinates) with nodes at equal distances, 5 along the
velocity and the amplitude and 3 along Poisson's ratio; within it friction is the polynomial through
them.  How wrong that may be is seen in the nodes themselves: the highest differences along a
direction are what one degree less would miss, and a share of them, calibrated on points that were
never used, is what this degree does.  A cell that may be too wrong is halved across the direction
that is worst, and all of its nodes are nodes of the halves.

All is a function of the answers alone, so that whoever asks in whatever order, stops and goes on,
comes to the same cells.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from microslip.sweeps.map_coordinates import MapCoordinates

if TYPE_CHECKING:
    from microslip.sweeps.drift_coordinates import DriftCoordinates

SHARE = 0.1
"""Error of the polynomial in a cell over the surplus.  Measured by benchmarks/certified.py."""
LOWER_ORDER = 0.35
"""Factor on third differences, which count where fourth ones happen to cancel."""
LOW_DEGREE = 2.0
"""Factor of second differences: of degree 2 a polynomial misses a larger share of what it adds."""
RESOLVED = 0.05
"""Largest surplus that says how wrong a cell may be.  Of a larger one, which only a loose error
would accept, the share that is missed can be a multiple of SHARE, so the cell is halved anyway."""
SMALLEST = 2.0**-9
"""Width of a cell, in patches, that is not halved again."""

Node = tuple[float, ...]
Answers = Mapping[Node, tuple[float, float]]
"""Friction and its error by the scaled coordinates of a node; NaN: it did not converge."""


class Cell(NamedTuple):
    """A box in scaled coordinates.

    Attributes
    ----------
    begin, end : tuple of float
        Its lower and its upper ends by direction: velocity, amplitude and perhaps Poisson's ratio.
    """

    begin: tuple[float, ...]
    end: tuple[float, ...]

    def nodes(self, degrees: tuple[int, ...]) -> list[Node]:
        """Its nodes, the last direction fastest."""
        ends = zip(self.begin, self.end, degrees, strict=True)
        return list(product(*(np.linspace(low, high, n + 1).tolist() for low, high, n in ends)))

    def halves(self, direction: int) -> tuple[Cell, Cell]:
        """Both halves of the cell along a direction, an index."""
        middle = 0.5 * (self.begin[direction] + self.end[direction])
        return (
            self._replace(end=_with(self.end, direction, middle)),
            self._replace(begin=_with(self.begin, direction, middle)),
        )


@dataclass(frozen=True)
class Refinement:
    """The state of a refinement: cells, their errors, and the points that are missing.

    Attributes
    ----------
    cells : tuple of Cell
        All that cover the map; those that cannot be judged yet among them.
    errors : tuple of float
        Bounds of the error in each, of interpolation and nodes; infinite where it is not known.
    missing : tuple of Node
        Places to be solved next, ascending; none of them: the map is done.
    """

    cells: tuple[Cell, ...]
    errors: tuple[float, ...]
    missing: tuple[Node, ...]


def first_cells(coordinates: MapCoordinates | DriftCoordinates) -> list[Cell]:
    """A cell for each patch of a map."""
    return [Cell(*patch) for patch in coordinates.patches]


def refined(
    coordinates: MapCoordinates | DriftCoordinates, known: Answers, error: float
) -> Refinement:
    """Cells that the answers so far lead to, and what has to be asked next.

    Parameters
    ----------
    coordinates : MapCoordinates or DriftCoordinates
        Coordinates of the map.
    known : mapping of Node to (float, float)
        All answers so far.
    error : float
        That is to hold all over the map, nodes' errors included.
    """
    pending, done, missing = first_cells(coordinates)[::-1], [], set()
    degrees = coordinates.degrees
    while pending:
        cell = pending.pop()
        nodes = cell.nodes(degrees)
        unknown = [node for node in nodes if node not in known]
        if unknown:
            missing.update(unknown)
            done.append((cell, np.inf))
            continue
        values, errors = np.array([known[node] for node in nodes]).T
        surpluses = surpluses_of(values.reshape([n + 1 for n in degrees]))
        bound = errors.max() + SHARE * sum(surpluses)
        worst = _worst(cell, surpluses)
        is_good = bound <= error and sum(surpluses) <= RESOLVED
        if not is_good and worst is not None:
            pending.extend(cell.halves(worst)[::-1])
        else:
            done.append((cell, float(bound) if np.isfinite(bound) else np.inf))
    done.sort()
    cells, bounds = zip(*done, strict=True)
    return Refinement(cells, bounds, tuple(sorted(missing)))


def surpluses_of(values: np.ndarray) -> tuple[float, ...]:
    """Error of polynomials of one degree less, by direction; values: 5 along each, or 3."""
    return tuple(_surplus(values, axis) for axis in range(values.ndim))


def _surplus(values: np.ndarray, axis: int) -> float:
    degree = values.shape[axis] - 1
    highest, next_to_it = (
        np.abs(np.diff(values, n, axis=axis)).max() for n in (degree, degree - 1)
    )
    if degree == 2:
        return float(LOW_DEGREE * highest)
    return float(max(highest, LOWER_ORDER * next_to_it))


def _worst(cell: Cell, surpluses: tuple[float, ...]) -> int | None:
    """The direction to halve a cell along; None: not at all, where it is small enough, or where
    friction is not known."""
    if not np.all(np.isfinite(surpluses)):
        return None
    wide = [
        direction
        for direction, (low, high) in enumerate(zip(*cell, strict=True))
        if high - low > SMALLEST
    ]
    return max(wide, key=lambda direction: surpluses[direction], default=None)


def _with(ends: tuple[float, ...], direction: int, value: float) -> tuple[float, ...]:
    return (*ends[:direction], value, *ends[direction + 1 :])
