"""Adaptive refinement of a map into cells.

A cell is a box in scaled coordinates (map_coordinates) with equally spaced nodes: 5 along the
velocity, 5 along the amplitude and 3 along Poisson's ratio.  Friction in a cell is interpolated by
the polynomial through its nodes.  The surplus of a direction is computed from the largest
differences of the highest order along this direction.  It equals the error of a polynomial whose
degree is lower by one.  The error of the cell's polynomial is estimated as a fraction of the
surplus; the fraction was calibrated on other points.  A cell whose error is too large is halved
along the direction with the largest surplus.  Both halves reuse the nodes of the cell.

The cells depend only on the results at the nodes, not on the order of the requests.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from microslip.sweeps.map_coordinates import MapCoordinates

SHARE = 0.1
"""Ratio of a cell's polynomial error to its surplus, calibrated by benchmarks/certified.py."""
LOWER_ORDER = 0.35
"""Weight of third differences in the surplus, for cells in which fourth differences cancel by
chance."""
LOW_DEGREE = 2.0
"""Weight of second differences in the surplus.  Polynomials of degree 2 have a larger error
relative to the surplus."""
RESOLVED = 0.05
"""Largest surplus of a cell that is not halved.  Above this value, the error can be much larger
than SHARE times the surplus, so the cell is halved even if its error bound is small."""
SMALLEST = 2.0**-9
"""Smallest width of a cell, as a fraction of a patch's width."""

Node = tuple[float, ...]
Answers = Mapping[Node, tuple[float, float]]
"""Friction and its error, keyed by node.  Friction is NaN if the point did not converge."""


class Cell(NamedTuple):
    """A box in scaled coordinates.

    Attributes
    ----------
    begin, end : tuple of float
        Lower and upper ends by direction: velocity, amplitude and perhaps Poisson's ratio.
    """

    begin: tuple[float, ...]
    end: tuple[float, ...]

    def nodes(self, degrees: tuple[int, ...]) -> list[Node]:
        """Nodes of the cell; the last direction changes fastest."""
        ends = zip(self.begin, self.end, degrees, strict=True)
        return list(product(*(np.linspace(low, high, n + 1).tolist() for low, high, n in ends)))

    def halves(self, direction: int) -> tuple[Cell, Cell]:
        """The two halves of the cell along the direction with this index."""
        middle = 0.5 * (self.begin[direction] + self.end[direction])
        return (
            self._replace(end=_with(self.end, direction, middle)),
            self._replace(begin=_with(self.begin, direction, middle)),
        )


@dataclass(frozen=True)
class Refinement:
    """State of the refinement of a map.

    Attributes
    ----------
    cells : tuple of Cell
        Cells that cover the map, including cells with missing nodes.
    errors : tuple of float
        Error bound of each cell, due to the interpolation and to the errors of the nodes; infinite
        if unknown.
    missing : tuple of Node
        Nodes to be solved next, in ascending order; empty if the map is finished.
    """

    cells: tuple[Cell, ...]
    errors: tuple[float, ...]
    missing: tuple[Node, ...]


def first_cells(coordinates: MapCoordinates) -> list[Cell]:
    """Create one cell for each patch of a map."""
    return [Cell(*patch) for patch in coordinates.patches]


def refine_cells(coordinates: MapCoordinates, answers: Answers, error: float) -> Refinement:
    """Refine a map as far as the results at the nodes allow.

    Parameters
    ----------
    coordinates : MapCoordinates
        Coordinates of the map.
    answers : mapping of Node to (float, float)
        Friction and its error at the solved nodes.
    error : float
        Largest accepted error, including the errors of the nodes.
    """
    pending, finished, missing = first_cells(coordinates)[::-1], [], set()
    degrees = coordinates.degrees
    while pending:
        cell = pending.pop()
        nodes = cell.nodes(degrees)
        unknown = [node for node in nodes if node not in answers]
        if unknown:
            missing.update(unknown)
            finished.append((cell, np.inf))
            continue
        values, errors = np.array([answers[node] for node in nodes]).T
        surpluses = surpluses_of(values.reshape([n + 1 for n in degrees]))
        bound = errors.max() + SHARE * sum(surpluses)
        worst = _worst(cell, surpluses)
        is_good = bound <= error and sum(surpluses) <= RESOLVED
        if not is_good and worst is not None:
            pending.extend(cell.halves(worst)[::-1])
        else:
            finished.append((cell, float(bound) if np.isfinite(bound) else np.inf))
    finished.sort()
    cells, bounds = zip(*finished, strict=True)
    return Refinement(cells, bounds, tuple(sorted(missing)))


def surpluses_of(values: np.ndarray) -> tuple[float, ...]:
    """Surplus along each direction, computed from the values at the nodes."""
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
    """Direction with the largest surplus.  None if the cell has the smallest size, or if friction
    is unknown."""
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
