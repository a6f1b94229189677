"""Accuracy against cost: what is run, at which points, to see what a digit costs.

At every point (a panel of the figures) every model climbs its ladder with the shipped method and
every other method climbs that of the model that model auto would take. Beside them stand the
tolerance-driven choice of `solve` and a reference. A map of two motions asks which model is the
cheapest that is good enough, and a series of sizes what a step costs.

Requests come in pieces that one job can answer, large enough that the start of a job is a small
part of it, and cut so that another method in the configuration adds pieces and changes none.
"""

from collections.abc import Iterator
from itertools import groupby

from microslip.config.settings import Accuracy
from microslip.solver.method_names import SHIPPED
from microslip.studies import requests
from microslip.studies.ladders import ladder, models_for
from microslip.studies.requests import Point

CHOICE_TOLERANCES = (1e-2, 1e-3, 1e-4)
MAP_MOTIONS = ("transverse", "bore")
MAP_LEVELS, MAP_REPEATS = 5, 3
MAP_SQUARES = 16
"""Along a side: these already cost more than rings that are far better; larger ones never win."""
TRUTH_SHARE = 0.1
"""Tolerance of what a map compares with, over the tightest tolerance that the map asks about."""

SCALING_SIZES = {
    "radial": [(n, 1) for n in (16, 32, 64, 128, 256, 512)],
    "polar": [(n, n) for n in (8, 16, 32, 64)],
    "cartesian": [(n, 1) for n in (16, 32, 64, 128, 256, 512)],
}
"""(cells, angles) by model; as many of them are run as there are levels of ladders."""
SCALING_STEPS = 16
LARGE, LONE_SIZES = 64, 4
"""Squares along a side from which on a run takes as long as all coarser ones, or longer; and how
many of the sizes one job can measure together."""


def points(study: Accuracy) -> dict[str, Point]:
    """Points of the trials by name."""
    return {
        name: Point(given.motion, given.velocity, given.amplitude, given.poisson)
        for name, given in study.points.items()
    }


def trials(study: Accuracy, point: Point) -> Iterator[tuple[int, dict]]:
    """Yield (level, request) for the trials of one point, the choices of `solve` at the end.

    The level of a choice counts its tolerances.
    """
    for method in study.methods:
        for model in models_for(method, point.motion, point.poisson):
            for k, level, tolerance in ladder(model, method, study.levels):
                yield (k, requests.trial(point, model, method, level, tolerance, study.repeats))
    if SHIPPED in study.methods:
        for k, tolerance in enumerate(CHOICE_TOLERANCES):
            yield k, requests.choice(point, tolerance, study.repeats)


def truth(point: Point) -> dict | None:
    """The request that the trials of a point are compared with; None where Eq 21 is exact."""
    return requests.reference(point) if point.amplitude is not None else None


def map_points(study: Accuracy, motion: str) -> list[Point]:
    """Points of a map, amplitude by amplitude, the velocity fastest."""
    return [
        Point(motion, velocity, amplitude)
        for amplitude in study.map.amplitude[motion]
        for velocity in study.map.velocity
    ]


def map_trials(study: Accuracy, point: Point) -> list[dict]:
    """Requests of the trials at one point of a map, all models with the shipped method."""
    repeats = min(study.repeats, MAP_REPEATS)
    return [
        requests.trial(point, model, SHIPPED, level, tolerance, repeats)
        for model in models_for(SHIPPED, point.motion, point.poisson)
        for _, level, tolerance in ladder(model, SHIPPED, min(study.levels, MAP_LEVELS))
        if model != "cartesian" or level.cells <= MAP_SQUARES
    ]


def map_truth(study: Accuracy, point: Point) -> dict:
    """The request that the trials at a point of a map are compared with."""
    return requests.reference(point, TRUTH_SHARE * min(study.map.tolerance))


def scaling(study: Accuracy, model: str) -> list[dict]:
    """Requests for the sizes of a model, two at least."""
    sizes = SCALING_SIZES[model][: max(study.levels, 2)]
    return [requests.scaling(model, cells, angles, SCALING_STEPS) for cells, angles in sizes]


def pieces(study: Accuracy) -> tuple[list, list]:
    """Requests grouped by job: two lists of lists of requests, the slow jobs and the fast ones."""
    places = list(points(study).values())
    long = [[request] for request in map(truth, places) if request is not None]
    for model in SCALING_SIZES:
        sizes = scaling(study, model)
        long += [[request] for request in reversed(sizes[LONE_SIZES:])] + [sizes[:LONE_SIZES]]
    shipped: list[list[dict]] = []
    others: dict[str, list[dict]] = {}
    for point in places:
        asked: dict[bool, list[dict]] = {True: [], False: []}
        for _, request in trials(study, point):
            if request.get("method", SHIPPED) == SHIPPED:
                asked[_takes_long(request)].append(request)
            else:
                others.setdefault(request["method"], []).append(request)
        long.append(asked[True])
        shipped.append(asked[False])
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


def size_label(request: dict) -> str:
    """The size of a grid as text: "64 x 64" angular points or squares, "64" rings."""
    across = {"radial": None, "cartesian": request["cells"]}
    second = across.get(request["model"], request["angles"])
    return f"{request['cells']}" if second is None else f"{request['cells']} x {second}"
