"""Rounds of a certified map: which points are solved next, from what is solved so far.

A round is a plain dict, kept in a file: the nodes to solve in it, the requests for them, and how
many parts they are cut into.  The round after the last one has no nodes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

from microslip.config.extended import solver_names
from microslip.config.records import CertifiedMap
from microslip.foundation.canonical import canonical_json
from microslip.sweeps import batch_files
from microslip.sweeps.batches import PointRequests, key_of
from microslip.sweeps.drift_coordinates import DriftCoordinates, scaled_velocity
from microslip.sweeps.map_cells import Answers, Refinement, refined
from microslip.sweeps.map_coordinates import MapCoordinates
from microslip.sweeps.sealed_files import CacheError, advice
from microslip.theory.kinks import kinks_of

LEAST_PARTS = 4
"""Fewest parts of a round, so that several cores can work on it."""
SMALLEST_PART = 18
"""Points for which a process is worth its start, and more where jobs are asked to be large."""
OF_A_JOB = 6
"""A part has at least this fraction of the points of a job."""
MOST_ROUNDS = 64
"""More than halving all cells to the smallest takes."""


def coordinates_of(map_: CertifiedMap) -> MapCoordinates | DriftCoordinates:
    """The coordinates that a certified map is cut in."""
    motion, pressure = solver_names(map_.sweep)
    if map_.force is not None:
        return DriftCoordinates(motion, map_.force, map_.amplitude)
    kinks = kinks_of(motion, pressure)
    return MapCoordinates(map_.velocity, map_.amplitude, kinks, map_.poisson)


def next_round(map_: CertifiedMap, known: Answers, points_per_job: int) -> dict:
    """The next round: nodes to solve, their requests and the number of parts.

    known: answers of all rounds so far by node; points_per_job: at most so many are a part.
    """
    coordinates = coordinates_of(map_)
    nodes = refined(coordinates, known, map_.error).missing
    smallest = max(SMALLEST_PART, points_per_job // OF_A_JOB)
    parts = max(math.ceil(len(nodes) / points_per_job), min(LEAST_PARTS, len(nodes) // smallest), 1)
    return {
        "nodes": [list(node) for node in nodes],
        "requests": [_request(map_, coordinates, node) for node in nodes],
        "parts": parts if nodes else 0,
    }


def _request(
    map_: CertifiedMap, coordinates: MapCoordinates | DriftCoordinates, node: tuple[float, ...]
) -> dict:
    """The request for a node, as of a sweep that has it."""
    place = dict(zip(coordinates.directions, coordinates.place(node), strict=True))
    point: dict = {"velocity": (0.0,)}
    if "force" in place:
        point = {"velocity": (), "drives": (("force", (place.pop("force"),), True),)}
    point |= {name: (value,) for name, value in place.items()}
    return PointRequests(replace(map_.sweep, tolerance=map_.tolerance, **point))[0]


def part_of(round_: dict, part: int) -> list[dict]:
    """Requests of a part of a round; what takes long lies close together, so each gets some."""
    return round_["requests"][part :: round_["parts"]]


def answers_in(rounds: Iterable[dict], records: Iterable[dict]) -> dict:
    """Friction and its error by node, from rounds and the records that answer them.

    Under a force it is the scaled velocity in its place.  NaN and infinity where a point did not
    converge.
    """
    results = {record["key"]: record["result"] for record in records}
    found = {}
    for round_ in rounds:
        for node, request in zip(round_["nodes"], round_["requests"], strict=True):
            found[tuple(node)] = _answer(request, results[key_of(request)])
    return found


def _answer(request: dict, result: dict) -> tuple[float, float]:
    if not result.get("converged", False):
        return math.nan, math.inf
    if "force" in request:
        return scaled_velocity(result["velocity"], result["velocity_error"])
    return result["mu_macro"], result["mu_macro_error"]


def refinement_of(map_: CertifiedMap, known: Answers) -> Refinement:
    """The Refinement of a certified map with these answers."""
    return refined(coordinates_of(map_), known, map_.error)


def text_of(round_: dict) -> bytes:
    """Content of the file of a round: one line of JSON, then the checksum of that line."""
    return batch_files.with_checksum(f"{canonical_json(round_)}\n".encode())


def round_in(content: bytes) -> dict | None:
    """The round in the content of a file; None if it is damaged."""
    line, _ = batch_files.without_checksum(content)
    return json.loads(line) if line else None


def why_not_whole(path: str | Path) -> str:
    """Why the file of a round or of a part of one has to be made again; "" if it has not.

    Raises CacheError if there is no such file or reading is not allowed.
    """
    if Path(path).stem.isdecimal():
        return "" if round_in(_content(path)) else "it is damaged"
    return batch_files.why_not_whole(path)


def read_round(path: str | Path) -> dict:
    """The round in a file; raises CacheError, one line, if it is damaged or cannot be read."""
    round_ = round_in(_content(path))
    if round_ is None:
        raise CacheError(f"{path} is damaged; run again: it is made again from finished points")
    return round_


def read_rounds(paths: Sequence[str | Path]) -> list[dict]:
    """The rounds in files, in their order; raises CacheError as `read_round`."""
    return [read_round(path) for path in paths]


def _content(path: str | Path) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise CacheError(advice("read", path, error)) from error
