"""Study of the accuracy and the cost of each model and method.

At each point, every model is run with the shipped method, at all levels of the model's ladder.
Every other method is run at the levels of the model that `model="auto"` selects.  For each point,
the study also computes a reference, and solves at several tolerances.  For two motions, the study
computes maps, with trials of all models on a grid of points.

The dataset contains performance profiles (Dolan and More, Math. Program. 91 (2002) 201-213,
doi:10.1007/s101070100263).  A case is a point and a tolerance.  The cost of a competitor is the CPU
time of its cheapest run within the tolerance.  The cost ratio of a competitor is this cost divided
by the smallest cost in the contest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from microslip.periodic.methods import SHIPPED, method_named
from microslip.studies import requests as forms
from microslip.studies.answers import MOTIONS, Answers, Row, columns, number
from microslip.studies.requests import AnyPoint, Point
from microslip.theory import paper

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

    from microslip.config.settings import Accuracy, StudyPoint

CHOICE_TOLERANCES = (1e-2, 1e-3, 1e-4)
"""Tolerances of the timed solves at each point."""
MAP_LEVELS, MAP_REPEATS = 5, 3
"""Largest number of levels in a map, and largest number of repeated measurements."""
MAP_SQUARES = 16
"""Largest number of squares along a side in a map.  Even this mesh is more expensive than rings,
although rings are far more accurate."""
TRUTH_SHARE = 0.1
"""Tolerance of the references of a map, divided by the tightest tolerance of the map."""
LARGE = 64
"""A run with at least this number of squares along a side takes as long as all coarser runs
together."""
AS_CHEAP = 1.5
"""Two measured times count as equal if their ratio is below this value."""
MODELS = "models"
"""Name of the contest in which the models, run with the shipped method, compete with the methods
that replace the whole run."""

TITLE = "Accuracy and cost of methods for the friction of a vibrated Hertz contact"
COMMENT = (
    "seconds are CPU times measured in the runs that made this file: medians of compiled runs, "
    "after one run that is not timed. They depend on the computers in the group machines and vary "
    "a little; all other values are reproducible."
)


# Requests


def trials(study: Accuracy, point: AnyPoint) -> Iterator[tuple[int, dict]]:
    """Yield (level, request) for the trials at a point, then for the solves at each tolerance.

    The level of a solve is the index of its tolerance in CHOICE_TOLERANCES.
    """
    yield from forms.trials(point, study.methods, study.levels, study.repeats)
    if SHIPPED in study.methods:
        for k, tolerance in enumerate(CHOICE_TOLERANCES):
            yield k, forms.of("choice", point, tolerance=tolerance, repeats=study.repeats)


def map_requests(study: Accuracy, motion: str) -> Iterator[tuple[float, dict, list[dict]]]:
    """For each point of a map, yield the amplitude, the reference request and the trial requests.

    The velocity varies fastest.
    """
    sizes = min(study.levels, MAP_LEVELS), min(study.repeats, MAP_REPEATS)
    for amplitude, velocity in product(study.map.amplitude[motion], study.map.velocity):
        point = Point(motion, velocity, amplitude)
        runs = (request for _, request in forms.trials(point, [SHIPPED], *sizes))
        shown = [r for r in runs if r["model"] != "cartesian" or r["cells"] <= MAP_SQUARES]
        yield amplitude, forms.solve(point, TRUTH_SHARE * min(study.map.tolerance)), shown


def requests(study: Accuracy) -> Iterator[tuple[tuple, dict]]:
    """Yield each request with its job.  Methods other than the shipped one have separate jobs."""
    for name, place in study.points.items():
        if place.amplitude is not None:  # else Eq 21 is exact
            yield (0, name, "reference"), forms.reference(place)
        for _, request in trials(study, place):
            method = request.get("method", SHIPPED)
            slow = request.get("model") == "cartesian" and request["cells"] >= LARGE
            yield (0 if slow else 1, name if method == SHIPPED else method), request
    for motion in MOTIONS:
        for amplitude, truth, runs in map_requests(study, motion):
            for request in (truth, *runs):
                yield (1, motion, amplitude), request


# The dataset


def values(study: Accuracy, answers: Answers) -> dict[str, Any]:
    """Return the values of all variables of the dataset."""
    points = [_point(name, point, answers) for name, point in study.points.items()]
    runs = _trials(study, points, answers)
    tolerances = study.map.tolerance[::-1]  # from loose to tight
    entries = columns("accuracy", "point", points) | dict(runs)
    entries |= profiles(runs, list(study.points), tolerances) | {"map_tolerance": tolerances}
    for motion in MOTIONS:
        entries |= _map(study, motion, tolerances, answers)
    machines = columns("accuracy", "machine", answers.machines) if answers.machines else {}
    return entries | machines


def report(dataset: xr.Dataset) -> Iterator[str]:
    """Yield a line for each point with the number of trials and the error estimate of the
    reference."""
    for point in dataset["point"].values:
        own = dataset["trial_point"].values == point
        bad = int(own.sum() - dataset["converged"].values[own].sum())
        error = float(dataset["reference_error"].sel(point=point))
        yield (
            f"{point}: {own.sum()} trials, {bad or 'none'} not converged, "
            f"reference within {error:.1e}"
        )


def _point(name: str, point: StudyPoint, answers: Answers) -> Row:
    """Return the row of a point, which includes the reference."""
    if point.amplitude is None:
        result: Row = {"mu_macro": float(paper.bore_forward(point.velocity)), "mu_macro_error": 0.0}
        source = "closed form, Eq 21"
    else:
        result = answers(forms.reference(point))
        source = f"model {result['model']}, tolerance {forms.reference(point)['tolerance']}"
        source += "" if result["converged"] else f", not met: {result.get('reason') or ''}"
    own = {"point": name, "point_title": point.title or name, "reference_source": source}
    return result | point.model_dump() | own


def _trials(study: Accuracy, points: list[Row], answers: Answers) -> pd.DataFrame:
    """Return a table of the trials at all points.  `points` contains the rows of the points."""
    import pandas as pd

    rows: list[Row] = []
    for place, point in zip(points, study.points.values(), strict=True):
        for level, request in trials(study, point):
            row = answers(request)
            if row.get("applies", True):
                own = {
                    "trial_point": place["point"],
                    "trial_model": request.get("model", "auto"),
                    "trial_method": request.get("method", SHIPPED),
                    "trial_level": level,
                    "error": abs(number(row, "mu_macro") - number(place, "mu_macro")),
                }
                rows.append(row | own)
    runs = pd.DataFrame(columns("accuracy", "trial", rows))
    for place in points:
        # Errors below the error of the reference count as equal.
        good = runs[(runs["trial_point"] == place["point"]) & runs["converged"]]
        error = np.maximum(good["error"], number(place, "mu_macro_error"))
        for cost in ("seconds", "effort"):
            runs.loc[good.index, f"front_{cost}"] = on_front(good[cost], error)
    return runs


def _map(study: Accuracy, motion: str, tolerances: Sequence[float], answers: Answers) -> dict:
    """Return the variables of a map: the cheapest model at each point, for each tolerance."""
    import pandas as pd

    rows = []
    for place, (_, truth, runs) in enumerate(map_requests(study, motion)):
        reference = number(answers(truth), "mu_macro")
        for request in runs:
            row = answers(request)
            error = abs(number(row, "mu_macro") - reference) if row.get("converged") else np.inf
            cost = number(row, "seconds")
            rows.append((place, request["model"], request["cells"], cost, error))
    table = pd.DataFrame(rows, columns=["place", "model", "cells", "seconds", "error"])
    exact = forms.exact_model(motion, 0.0)
    best = [cheapest(table, exact, t).to_dict("index") for t in tolerances]
    amplitude, velocity = study.map.amplitude[motion], study.map.velocity
    shape = len(tolerances), len(amplitude), len(velocity)
    chosen = [of_place.get(place, {}) for of_place in best for place in range(shape[1] * shape[2])]
    dims = f"map_tolerance {motion}_amplitude {motion}_velocity"
    axes = {f"{motion}_amplitude": amplitude, f"{motion}_velocity": velocity}
    return columns("accuracy", dims, chosen, *shape) | axes


# Pareto fronts, cheapest runs and performance profiles


def on_front(cost: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Return a boolean array of shape (n,), True for trials on the Pareto front of cost and error.

    A trial is on the front if every other trial is more expensive, less accurate, or equal in both.

    cost, error: arrays of shape (n,).  Trials with infinite or NaN values are not on the front.
    """
    both = np.stack([np.asarray(cost, float), np.asarray(error, float)])
    finite = np.isfinite(both).all(axis=0)
    both = np.where(finite, both, np.inf)
    other, own = both[:, :, None], both[:, None, :]
    return finite & ~((other <= own).all(axis=0) & (other < own).any(axis=0)).any(axis=0)


def largest_from(runs: pd.DataFrame, *series: str) -> pd.Series:
    """For each run, return the largest error among this run and all finer runs of the same series.
    The value is NaN if the run has no error.

    The error of a coarse run can be small by chance, because the error may change its sign as the
    mesh is refined.

    runs: table with the column `error` and rows from coarse to fine. series: names of the columns
    whose values identify a series of levels.
    """
    return runs["error"][::-1].groupby([runs[name] for name in series]).cummax()


def cheapest(runs: pd.DataFrame, exact: str, tolerance: float) -> pd.DataFrame:
    """For each place, return the cheapest run whose error is within the tolerance.

    All finer runs of the same model must also be within the tolerance.  The finest run of a model
    cannot be confirmed in this way, so it does not count.  The model `exact` is an exception,
    because it converges to the reference.  Times are uncertain, so a cost counts as equal to the
    lowest cost if their ratio is at most AS_CHEAP.  If several runs have such a cost, the first one
    is returned.

    runs: table with the columns place, model, cells, seconds and error, from coarse to fine.
    """
    unconfirmed = ~runs.duplicated(["place", "model"], keep="last") & (runs["model"] != exact)
    largest = largest_from(runs, "place", "model")
    good = runs[(largest <= tolerance) & ~unconfirmed & np.isfinite(runs["seconds"])]
    least = good.groupby("place")["seconds"].transform("min")
    return good[good["seconds"] <= AS_CHEAP * least].drop_duplicates("place").set_index("place")


def contest_of(method: str) -> str:
    """Return the name of the contest in which a method takes part.  The contest depends on the part
    of a run that the method replaces.

    The result is "models" for the shipped method and for methods that replace the whole run.  For
    other methods, the result is "integrators", "solvers of a step" or "searches".
    """
    parts, shipped = method_named(method), method_named(SHIPPED)
    if method == SHIPPED or parts.run is not None:
        return MODELS
    if parts.dress is not None:
        return "solvers of a step"
    return "integrators" if parts.integrator != shipped.integrator else "searches"


def profiles(runs: pd.DataFrame, points: list[str], tolerances: Sequence[float]) -> dict:
    """Return the competitors of all contests, and the cost ratios of the competitors.

    A run counts only if all finer runs of the same competitor and model are also within the
    tolerance. A run of the shipped method counts in a contest only if a competitor has a run at the
    same point with the same model.

    runs: table of trials.  points: names of all points.
    """
    import pandas as pd

    place = ["trial_point", "trial_model"]
    runs = runs.assign(error=runs["error"].where(runs["converged"].astype(bool)))
    runs["largest"] = largest_from(runs, "trial_method", *place)
    methods = runs["trial_method"]
    shipped, contest_of_run = methods == SHIPPED, methods.map(contest_of)
    tables = []
    for contest in dict.fromkeys([MODELS, *map(contest_of, sorted(set(methods)))]):
        own = contest_of_run == contest
        beside = own.groupby([runs[name] for name in place]).transform("any")
        names = methods.mask(shipped, runs["trial_model"]) if contest == MODELS else methods
        every = runs.assign(competitor_contest=contest, competitor=names)
        tables.append(every[own | (shipped & beside)])
    entrants = pd.concat(tables)
    pair = ["competitor_contest", "competitor"]
    pairs = pd.MultiIndex.from_frame(entrants[pair].drop_duplicates())
    ratios = []
    for tolerance in tolerances:
        good = entrants[entrants["largest"] <= tolerance]
        costs = good.groupby([*pair, "trial_point"])["seconds"].min().unstack()
        costs = costs.reindex(index=pairs, columns=points)
        least = costs.groupby("competitor_contest").transform("min")
        ratios.append((costs / least).fillna(np.inf))
    return {name: pairs.get_level_values(name) for name in pair} | {
        "profile_ratio": np.stack(ratios, axis=1)
    }
