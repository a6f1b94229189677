"""Cells of a map, and where they have to be split: from what is known to what is asked next.

A cell is a rectangle in scaled coordinates (map_coordinates) with 5 x 5 nodes at equal distances;
within it friction is the polynomial of degree 4 in each direction.  How wrong that may be is seen
in the nodes themselves: the fourth differences along a direction are what the degree 3 would miss,
and a share of them, calibrated on points that were never used, is what the degree 4 does.  A cell
that may be too wrong is halved across the direction that is worse, and all of its nodes are nodes
of the halves.

All is a function of the answers alone, so that whoever asks in whatever order, stops and goes on,
comes to the same cells.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from microslip.sweeps.map_coordinates import MapCoordinates

DEGREE = 4
SHARE = 0.1
"""Of the surplus of a cell: what the polynomial may miss.  Measured by benchmarks/certified.py."""
LOWER_ORDER = 0.25
"""Of the third differences, which count where fourth ones happen to cancel."""
SMALLEST = 2.0**-9
"""Width of a cell, in patches, that is not halved again."""

Node = tuple[float, float]
Answers = Mapping[Node, tuple[float, float]]
"""Friction and its error by the scaled coordinates of a node; NaN: it did not converge."""


class Cell(NamedTuple):
    """A rectangle in scaled coordinates: velocities left to right, amplitudes low to high."""

    left: float
    right: float
    low: float
    high: float

    @property
    def nodes(self) -> list[Node]:
        """Its nodes; the amplitude runs fastest."""
        columns = np.linspace(self.left, self.right, DEGREE + 1).tolist()
        rows = np.linspace(self.low, self.high, DEGREE + 1).tolist()
        return [(x, y) for x in columns for y in rows]

    def halves(self, along_velocity: bool) -> tuple[Cell, Cell]:
        """Both halves of the cell, along the velocity or along the amplitude."""
        if along_velocity:
            middle = 0.5 * (self.left + self.right)
            return self._replace(right=middle), self._replace(left=middle)
        middle = 0.5 * (self.low + self.high)
        return self._replace(high=middle), self._replace(low=middle)


@dataclass(frozen=True)
class Refinement:
    """Where a map stands.

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


def first_cells(coordinates: MapCoordinates) -> list[Cell]:
    """A cell for each patch of a map."""
    columns, rows = coordinates.patches
    return [
        Cell(float(i), float(i + 1), float(j), float(j + 1))
        for i in range(columns)
        for j in range(rows)
    ]


def refined(coordinates: MapCoordinates, known: Answers, error: float) -> Refinement:
    """Cells that the answers so far lead to, and what has to be asked next.

    Parameters
    ----------
    coordinates : MapCoordinates
        Of the map.
    known : mapping of Node to (float, float)
        All answers so far.
    error : float
        That is to hold all over the map, nodes' errors included.
    """
    pending, done, missing = first_cells(coordinates)[::-1], [], set()
    while pending:
        cell = pending.pop()
        nodes = cell.nodes
        unknown = [node for node in nodes if node not in known]
        if unknown:
            missing.update(unknown)
            done.append((cell, np.inf))
            continue
        values, errors = np.array([known[node] for node in nodes]).T
        surpluses = surpluses_of(values.reshape(DEGREE + 1, DEGREE + 1))
        bound = errors.max() + SHARE * sum(surpluses)
        half = _worse(cell, surpluses)
        if bound > error and half is not None:
            pending.extend(cell.halves(half)[::-1])
        else:
            done.append((cell, float(bound) if np.isfinite(bound) else np.inf))
    done.sort()
    cells, bounds = zip(*done, strict=True)
    return Refinement(cells, bounds, tuple(sorted(missing)))


def surpluses_of(values: np.ndarray) -> tuple[float, float]:
    """What lower degrees miss along the velocity and along the amplitude; values: (5, 5)."""
    return _surplus(values), _surplus(values.T)


def _surplus(values):
    fourth, third = (np.abs(np.diff(values, n, axis=0)).max() for n in (DEGREE, DEGREE - 1))
    return float(max(fourth, LOWER_ORDER * third))


def _worse(cell, surpluses):
    """Whether to halve a cell along the velocity; None: not at all, where it is small enough, or
    where friction is not known."""
    if not np.all(np.isfinite(surpluses)):
        return None
    wide = cell.right - cell.left > SMALLEST, cell.high - cell.low > SMALLEST
    if not any(wide):
        return None
    along_velocity = surpluses[0] >= surpluses[1]
    return along_velocity if wide[0 if along_velocity else 1] else not along_velocity
