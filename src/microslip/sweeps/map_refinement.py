"""Computation of the points of a certified map, in rounds of refinement."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import parent_process
from threading import Thread

from microslip.config.extended import solver_names
from microslip.config.records import CertifiedMap
from microslip.foundation import named_files
from microslip.sweeps.batches import PointRequests, answer
from microslip.sweeps.drift_coordinates import DriftCoordinates, scaled_velocity
from microslip.sweeps.map_cells import Answers, Node, Refinement, refine_cells
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.sweeps.store import Store
from microslip.theory.kinks import kinks_of


def coordinates_of(map_: CertifiedMap) -> MapCoordinates | DriftCoordinates:
    """Scaled coordinates of a certified map."""
    motion, pressure = solver_names(map_.sweep)
    if map_.force is not None:
        return DriftCoordinates(motion, map_.force, map_.amplitude)
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
        Friction and its error by node, or the scaled velocity under a force and its error.  The
        values are NaN and infinity if a point did not converge.  They depend only on the records.
    refinement : Refinement
        The cells.
    """
    coordinates = coordinates_of(map_)
    answers: dict[Node, tuple[float, float]] = {}
    while nodes := (state := refine_cells(coordinates, answers, map_.error)).missing:
        requests = [_request(map_, coordinates, node) for node in nodes]
        for node, request, record in zip(nodes, requests, ask(requests), strict=True):
            answers[node] = _answer(request, record["result"])
    return answers, state


def _request(
    map_: CertifiedMap, coordinates: MapCoordinates | DriftCoordinates, node: tuple[float, ...]
) -> dict:
    """Request for a node, which equals the request of a sweep for the same point."""
    place = dict(zip(coordinates.directions, coordinates.place(node), strict=True))
    point: dict = {"velocity": (0.0,)}
    if "force" in place:
        point = {"velocity": (), "drives": (("force", (place.pop("force"),), True),)}
    point |= {name: (value,) for name, value in place.items()}
    (request,) = PointRequests(replace(map_.sweep, tolerance=map_.tolerance, **point))
    return request


def _answer(request: dict, result: dict) -> tuple[float, float]:
    if not result.get("converged", False):
        return math.nan, math.inf
    if "force" in request:
        return scaled_velocity(result["velocity"], result["velocity_error"])
    return result["mu_macro"], result["mu_macro_error"]


def solve_points(
    map_: CertifiedMap,
    store: Store,
    processes: int,
    progress: Callable[[Iterable, int], Iterable],
) -> tuple[list[dict], list[float]]:
    """Solve all points of a map in several processes.

    Each point is stored as soon as it is solved.

    Parameters
    ----------
    map_ : CertifiedMap
        The map.
    store : Store
        Store of results.
    processes : int
        Number of processes.
    progress : callable
        Function that is called with an iterable and its length in each round, and yields the items
        of the iterable.

    Returns
    -------
    records : list of dict
        Records of all points.
    seconds : list of float
        CPU times of the solver for the points.
    """
    answers: dict[str, tuple[dict, float]] = {}
    names = [named_files.with_path(name) for name in (map_.sweep.motion, map_.sweep.pressure)]
    with ProcessPoolExecutor(processes, initializer=_begin, initargs=(names,)) as pool:

        def ask(requests: list[dict]) -> Iterator[dict]:
            results = pool.map(partial(answer, store=store), requests)
            for record, seconds in progress(results, len(requests)):
                answers[record["key"]] = record, seconds
                yield record

        refine(map_, ask)
    records, seconds = zip(*answers.values(), strict=True)
    return list(records), list(seconds)


def _begin(names: list[str]) -> None:
    """Prepare a worker process to read files of motions and pressures, and to end when its parent
    process ends."""
    named_files.remember(names)
    Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = parent_process()
    assert parent is not None  # processes of a pool have a parent
    parent.join()
    os._exit(1)
