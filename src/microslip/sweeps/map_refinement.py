"""Compute the points of a certified map, in rounds of refinement."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import parent_process
from pathlib import Path
from threading import Thread

from microslip.config.extended import solver_names
from microslip.config.records import CertifiedMap
from microslip.foundation import named_files
from microslip.sweeps.batches import answer, gather, points_of
from microslip.sweeps.map_cells import Answers, Node, Refinement, refine_cells
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.sweeps.store import Store
from microslip.theory.kinks import kinks_of


def coordinates_of(map_: CertifiedMap) -> MapCoordinates:
    """Scaled coordinates of a certified map."""
    motion, pressure = solver_names(map_.sweep)
    kinks = kinks_of(motion, pressure)
    return MapCoordinates(map_.velocity, map_.amplitude, kinks, map_.poisson)


def refine(
    map_: CertifiedMap, ask: Callable[[list[dict]], Iterable[dict]]
) -> tuple[Answers, Refinement]:
    """Solve all nodes of a certified map, round by round.

    Parameters
    ----------
    map_ : CertifiedMap
        The map.
    ask : callable
        Function that returns the records for a list of requests, in the same order.

    Returns
    -------
    answers : dict of tuple to (float, float)
        Friction and its error at each node.  They depend only on the records.  If the point did
        not converge, the value is NaN and the error is infinite.
    refinement : Refinement
        The cells.
    """
    coordinates = coordinates_of(map_)
    answers: dict[Node, tuple[float, float]] = {}
    while nodes := (state := refine_cells(coordinates, answers, map_.error)).missing:
        requests = [_request(map_, coordinates, node) for node in nodes]
        for node, record in zip(nodes, ask(requests), strict=True):
            answers[node] = _answer(record["result"])
    return answers, state


def _request(map_: CertifiedMap, coordinates: MapCoordinates, node: tuple[float, ...]) -> dict:
    """Request for a node.  It equals a sweep's request for the same point."""
    place = dict(zip(coordinates.directions, coordinates.place(node), strict=True))
    point: dict = {"velocity": (0.0,)} | {name: (value,) for name, value in place.items()}
    (request,) = points_of(replace(map_.sweep, tolerance=map_.tolerance, **point)).requests
    return request


def _answer(result: dict) -> tuple[float, float]:
    if not result.get("converged", False):
        return math.nan, math.inf
    return result["mu_macro"], result["mu_macro_error"]


def solve_points(map_: CertifiedMap, store: Store, processes: int) -> tuple[list[dict], dict]:
    """Solve all points of a map in several processes.  Progress is printed on standard error.

    Each point is stored as soon as it is solved.  Returns the records and their statistics, see
    batches.gather.
    """
    from tqdm import tqdm

    answers: dict[str, tuple[dict, float]] = {}

    def ask(requests: list[dict]) -> Iterator[dict]:
        results = pool.map(partial(answer, store=store), requests)
        for record, seconds in tqdm(
            results, map_.name, len(requests), unit="point", mininterval=1.0
        ):
            answers[record["key"]] = record, seconds
            yield record

    with ProcessPoolExecutor(processes, None, _begin, (named_files.PLACES,)) as pool:
        refine(map_, ask)
    return gather(answers.values())


def _begin(places: dict[str, Path]) -> None:
    """Prepare a worker process: store the paths of motion and pressure files by digest, and make
    the process end with its parent."""
    named_files.PLACES.update(places)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None  # processes of a pool have a parent
    parent.join()
    os._exit(1)
