"""Divide certified maps adaptively into cells, and compute the points of the maps.

A cell is a box in scaled coordinates (map_coordinates) with equally spaced nodes: 5 along the
velocity, 5 along the amplitude and 3 along Poisson's ratio.  Friction in a cell is interpolated by
the polynomial through the nodes of the cell.  The surplus along a direction is computed from the
finite differences of the highest order along this direction.  Only the largest of these differences
counts.  The surplus equals the error of a polynomial whose degree is one lower than the degree of
the cell's polynomial.  The error of the cell's own polynomial is estimated as a fraction of the
surplus.  The fraction was calibrated on points that are not nodes.  A cell whose error is too large
is halved along the direction with the largest surplus.  Both halves reuse the nodes of the cell.

The cells depend only on the results at the nodes, not on the order of the requests.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from itertools import product
from multiprocessing import parent_process
from pathlib import Path
from threading import Thread
from typing import NamedTuple

import numpy as np

from microslip.config.settings import Sweep
from microslip.foundation import named_files
from microslip.sweeps import batch
from microslip.sweeps.map_coordinates import Box, MapCoordinates
from microslip.sweeps.request import points_of, solver_names
from microslip.theory.exact import kinks_of

SHARE = 0.1
"""Ratio of a cell's interpolation error to its surplus, calibrated by benchmarks/certified.py."""
LOWER_ORDER = 0.35
"""Weight of third differences in the surplus.  Third differences matter in cells where the fourth
differences cancel by chance."""
LOW_DEGREE = 2.0
"""Weight of second differences in the surplus.  The error of a polynomial of degree 2 is a
larger fraction of the surplus than that of a polynomial of degree 4."""
RESOLVED = 0.05
"""Largest surplus of a cell that need not be halved.  Above this value, the error can be much
larger than the assumed fraction of the surplus (SHARE).  The cell is then halved even if its error
bound is small."""
SMALLEST = 2.0**-9
"""Smallest width of a cell, as a fraction of a patch's width."""

Node = tuple[float, ...]
Answers = Mapping[Node, tuple[float, float]]
"""Type of a mapping from nodes to friction and its error.  Friction is NaN if the point did not
converge."""


class Refinement(NamedTuple):
    """State of the refinement of a map.

    Attributes
    ----------
    cells : tuple of Box
        Cells that cover the map.  Nodes of some cells can be missing.
    errors : tuple of float
        Error bound of each cell, which includes the errors of the interpolation and of the nodes;
        infinite if unknown.
    missing : tuple of Node
        Nodes to be solved next, in ascending order; empty if the map is finished.
    """

    cells: tuple[Box, ...]
    errors: tuple[float, ...]
    missing: tuple[Node, ...]


def nodes_of(cell: Box, degrees: tuple[int, ...]) -> list[Node]:
    """Return the nodes of a cell.  The coordinate along the last direction changes fastest."""
    ends = zip(*cell, degrees, strict=True)
    return list(product(*(np.linspace(low, high, n + 1).tolist() for low, high, n in ends)))


def halves_of(cell: Box, direction: int) -> tuple[Box, Box]:
    """Return the two halves of a cell that is divided along the direction with the given index."""
    begin, end = map(list, cell)
    begin[direction] = end[direction] = 0.5 * (begin[direction] + end[direction])
    return (cell[0], tuple(end)), (tuple(begin), cell[1])


def surpluses_of(values: np.ndarray) -> tuple[float, ...]:
    """Return the surplus along each direction, computed from the values at the nodes."""

    def largest(axis: int, order: int) -> float:
        return float(np.abs(np.diff(values, order, axis=axis)).max())

    return tuple(
        LOW_DEGREE * largest(axis, 2)
        if count == 3
        else max(largest(axis, count - 1), LOWER_ORDER * largest(axis, count - 2))
        for axis, count in enumerate(values.shape)
    )


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
    pending, degrees = list(coordinates.patches), coordinates.degrees
    finished: list[tuple[Box, float]] = []
    missing: set[Node] = set()
    while pending:
        cell = pending.pop()
        nodes = nodes_of(cell, degrees)
        if unknown := [node for node in nodes if node not in answers]:
            missing.update(unknown)
            finished.append((cell, np.inf))
            continue
        values, errors = np.array([answers[node] for node in nodes]).T
        surpluses = np.array(surpluses_of(values.reshape([n + 1 for n in degrees])))
        bound = float(errors.max() + SHARE * sum(surpluses))
        is_wide = np.subtract(cell[1], cell[0]) > SMALLEST
        is_good = bound <= error and sum(surpluses) <= RESOLVED
        if is_good or not is_wide.any() or not np.isfinite(surpluses).all():
            finished.append((cell, bound if np.isfinite(bound) else np.inf))
        else:
            pending.extend(halves_of(cell, int(np.argmax(np.where(is_wide, surpluses, -1.0)))))
    cells, bounds = zip(*sorted(finished), strict=True)
    return Refinement(cells, bounds, tuple(sorted(missing)))


# Points of the map of a sweep


def coordinates_of(sweep: Sweep) -> MapCoordinates:
    """Return the scaled coordinates of a certified map over the ranges of a sweep.

    Velocities range from the smallest one above 0 to the largest.  A map of the static limit has no
    velocity axis.
    """
    positive = [velocity for velocity in sweep.velocity if velocity > 0]
    velocity = (positive[0], positive[-1]) if sweep.spans_a_map else ()
    poisson = (sweep.poisson[0], sweep.poisson[-1]) if len(sweep.poisson) > 1 else ()
    amplitude = sweep.amplitude[0], sweep.amplitude[-1]
    return MapCoordinates(velocity, amplitude, kinks_of(*solver_names(sweep)), poisson)


def refine(sweep: Sweep, ask: Callable[[list[dict]], Iterable[dict]]) -> tuple[Answers, Refinement]:
    """Solve all nodes of a certified map, round by round.

    Parameters
    ----------
    sweep : Sweep
        The map.
    ask : callable
        Function that returns the records for a list of requests, in the same order.

    Returns
    -------
    answers : dict of tuple to (float, float)
        Friction and its error at each node.  If the point did not converge, the friction is NaN and
        the error is infinite.  The answers depend only on the records.
    refinement : Refinement
        The cells.
    """
    assert sweep.error is not None
    coordinates = coordinates_of(sweep)
    answers: dict[Node, tuple[float, float]] = {}
    while nodes := (state := refine_cells(coordinates, answers, sweep.error)).missing:
        requests = [_request(sweep, coordinates, node) for node in nodes]
        for node, record in zip(nodes, ask(requests), strict=True):
            result = record["result"]
            value = result.get("mu_macro", np.nan), result.get("mu_macro_error", np.inf)
            answers[node] = value if result.get("converged") else (np.nan, np.inf)
    return answers, state


def _request(sweep: Sweep, coordinates: MapCoordinates, node: Node) -> dict:
    """Return the request for a node.  This request is identical to the request of an ordinary sweep
    for the same point."""
    place = dict(zip(coordinates.directions, coordinates.place(node), strict=True))
    point = {"velocity": (0.0,)} | {name: (value,) for name, value in place.items()}
    (request,) = points_of(sweep.model_copy(update=point)).requests
    return request


def solve_points(sweep: Sweep, path: str | Path, processes: int) -> dict:
    """Solve all points of a map in several processes, and write the batch file of the map.

    Progress is printed on standard error.  Returns the statistics of the job.
    """
    from tqdm import tqdm

    with (
        batch.Job(path) as job,
        ProcessPoolExecutor(processes, None, _begin, (named_files.PLACES,)) as pool,
    ):

        def compute(requests: Sequence[dict]) -> Iterator[tuple[dict, float]]:
            futures = [pool.submit(batch.computed, request) for request in requests]
            for one in tqdm(as_completed(futures), None, len(futures), unit="point", mininterval=1):
                yield one.result()

        records: dict[str, dict] = {}

        def ask(requests: list[dict]) -> list[dict]:
            some = job.solve(requests, compute)
            records.update((record["key"], record) for record in some)
            return some

        refine(sweep, ask)
        return job.finish([records[key] for key in sorted(records)])


def _begin(places: dict[str, Path]) -> None:
    """Prepare a worker process: store the paths of the motion and pressure files, keyed by file
    digest, and end the process when its parent ends."""
    named_files.PLACES.update(places)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None  # processes of a pool have a parent
    parent.join()
    os._exit(1)
