"""Requests for the study of accuracy and cost.

At each point, every model is run with the shipped method at all levels of its ladder. Every other
method is run at the levels of the model that `model="auto"` selects. Each point also has a
reference, and solves at given tolerances. For two motions, there are also maps, with trials of all
models on a grid of points. The cost of a step is measured for a series of sizes.

Requests are grouped into pieces, one for each job. Computing a piece takes much longer than
starting a job. Adding a method to the configuration adds pieces and does not change the existing
ones.
"""

from collections.abc import Iterator
from itertools import groupby

from microslip.config.settings import Accuracy
from microslip.solver.method_names import SHIPPED
from microslip.studies import requests
from microslip.studies.ladders import ladder, models_for
from microslip.studies.requests import AnyPoint, Point

CHOICE_TOLERANCES = (1e-2, 1e-3, 1e-4)
MAP_MOTIONS = ("transverse", "bore")
MAP_LEVELS, MAP_REPEATS = 5, 3
MAP_SQUARES = 16
"""Largest number of squares along a side in a map. Even this mesh costs more than rings, which are
far more accurate."""
TRUTH_SHARE = 0.1
"""Tolerance of a map's references, divided by the map's tightest tolerance."""

LARGE = 64
"""A run with at least this many squares along a side takes as long as all coarser runs together."""


def trials(study: Accuracy, point: AnyPoint) -> Iterator[tuple[int, dict]]:
    """Yield (level, request) for the trials of one point, then for its solves at a tolerance.

    The level of a solve is the index of its tolerance in CHOICE_TOLERANCES.
    """
    for method in study.methods:
        for model in models_for(method, point.motion, point.poisson):
            for k, level, tolerance in ladder(model, method, study.levels):
                yield (k, requests.trial(point, model, method, level, tolerance, study.repeats))
    if SHIPPED in study.methods:
        for k, tolerance in enumerate(CHOICE_TOLERANCES):
            yield k, requests.choice(point, tolerance, study.repeats)


def truth(point: AnyPoint) -> dict | None:
    """Return the request for the reference of a point, or None if Eq 21 is exact there."""
    return requests.reference(point) if point.amplitude is not None else None


def map_points(study: Accuracy, motion: str) -> list[Point]:
    """Return the points of a map. The velocity varies fastest."""
    return [
        Point(motion, velocity, amplitude)
        for amplitude in study.map.amplitude[motion]
        for velocity in study.map.velocity
    ]


def map_trials(study: Accuracy, point: Point) -> list[dict]:
    """Return the trials at one point of a map, for all models with the shipped method."""
    repeats = min(study.repeats, MAP_REPEATS)
    return [
        requests.trial(point, model, SHIPPED, level, tolerance, repeats)
        for model in models_for(SHIPPED, point.motion, point.poisson)
        for _, level, tolerance in ladder(model, SHIPPED, min(study.levels, MAP_LEVELS))
        if model != "cartesian" or level.cells <= MAP_SQUARES
    ]


def map_truth(study: Accuracy, point: Point) -> dict:
    """Return the request for the reference of a point of a map."""
    return requests.reference(point, TRUTH_SHARE * min(study.map.tolerance))


def pieces(study: Accuracy) -> tuple[list, list]:
    """Return the slow jobs and the fast jobs as two lists. A job is a list of requests."""
    places = study.points.values()
    long = [[request] for request in map(truth, places) if request is not None]
    shipped: list[list[dict]] = []
    others: dict[str, list[dict]] = {}
    for point in places:
        by_length: dict[bool, list[dict]] = {True: [], False: []}
        for _, request in trials(study, point):
            if request.get("method", SHIPPED) == SHIPPED:
                by_length[_takes_long(request)].append(request)
            else:
                others.setdefault(request["method"], []).append(request)
        long.append(by_length[True])
        shipped.append(by_length[False])
    rows = [
        _map_row(study, list(row))
        for motion in MAP_MOTIONS
        for _, row in groupby(map_points(study, motion), key=lambda point: point.amplitude)
    ]
    short = [*shipped, *others.values(), *rows]
    return [piece for piece in long if piece], [piece for piece in short if piece]


def _takes_long(request: dict) -> bool:
    return request.get("model") == "cartesian" and request.get("cells", 0) >= LARGE


def _map_row(study: Accuracy, points: list[Point]) -> list[dict]:
    return [
        request
        for point in points
        for request in (map_truth(study, point), *map_trials(study, point))
    ]
