"""Compute the points of a certified map, in rounds of refinement."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing import parent_process
from pathlib import Path
from threading import Thread

from microslip.config.settings import Sweep
from microslip.foundation import files, named_files
from microslip.sweeps import batch, evaluate
from microslip.sweeps.map_cells import Answers, Node, Refinement, refine_cells
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.sweeps.request import key_of, points_of, solver_names
from microslip.theory.kinks import kinks_of


def coordinates_of(sweep: Sweep) -> MapCoordinates:
    """Scaled coordinates of a certified map over the ranges of a sweep.

    Velocities reach from the smallest one above 0 to the largest.  A map of the static limit has
    no velocity.
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
        Friction and its error at each node.  They depend only on the records.  If the point did not
        converge, the friction is NaN and the error is infinite.
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
            is_good = result.get("converged", False)
            value = (result["mu_macro"], result["mu_macro_error"]) if is_good else None
            answers[node] = value or (math.nan, math.inf)
    return answers, state


def _request(sweep: Sweep, coordinates: MapCoordinates, node: tuple[float, ...]) -> dict:
    """Request for a node.  It equals a sweep's request for the same point."""
    place = dict(zip(coordinates.directions, coordinates.place(node), strict=True))
    point = {"velocity": (0.0,)} | {name: (value,) for name, value in place.items()}
    (request,) = points_of(sweep.model_copy(update=point)).requests
    return request


def solve_points(sweep: Sweep, path: str | Path, processes: int) -> dict:
    """Solve all points of a map in several processes, and write its batch file.

    Progress is printed on standard error.  Each point is appended to a journal as soon as it is
    solved.  Returns the statistics of batch.finish.
    """
    from tqdm import tqdm

    files.refuse_unwritable(Path(path).parent)
    cache, journal = batch.Cache(path), batch.Journal(path)
    seconds: list[float] = []
    records: dict[str, dict] = {}

    def ask(requests: list[dict]) -> list[dict]:
        cache.find(requests)
        keys = [key_of(request) for request in requests]
        missing = dict(zip(keys, requests, strict=True))  # two nodes can be the same point
        missing = {key: r for key, r in missing.items() if key not in cache.records}
        jobs = [pool.submit(batch.computed, request) for request in missing.values()]
        for job in tqdm(as_completed(jobs), None, len(jobs), unit="point", mininterval=1.0):
            record, took = job.result()
            seconds.append(took)
            if evaluate.is_final(record["result"]):
                journal.append(record)
            records[record["key"]] = record
        records.update((key, cache.records[key]) for key in keys if key in cache.records)
        return [records[key] for key in keys]

    try:
        with ProcessPoolExecutor(processes, None, _begin, (named_files.PLACES,)) as pool:
            refine(sweep, ask)
    finally:
        journal.close()
    return batch.finish(cache, [records[key] for key in sorted(records)], seconds)


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
