"""Performance profiles: how often a model or a method is how much dearer than the best.

E. D. Dolan and J. J. More, Math. Program. 91 (2002) 201-213, doi:10.1007/s101070100263. A case is a
point and a tolerance; a competitor's cost there is the least among its runs that are within the
tolerance, and its ratio that cost over the least of all competitors of its contest.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.datasets.variables import variable
from microslip.solver.method_names import SHIPPED, method_named

MODELS = "models"
CHOSEN = "auto"


def contest_of(method: str) -> str:
    """The contest that a method takes part in, by the part of a run that it exchanges.

    Parameters
    ----------
    method : str
        Name of a method, numbers may follow.

    Returns
    -------
    str
        "models" for what ships and what replaces the whole run, else "integrators", "solvers of a
        step" or "searches".
    """
    parts, shipped = method_named(method), method_named(SHIPPED)
    if method == SHIPPED or parts.run is not None:
        return MODELS
    if parts.dress is not None:
        return "solvers of a step"
    if parts.extrapolated or parts.integrator != shipped.integrator:
        return "integrators"
    return "searches"


class Trial(NamedTuple):
    """A run of a contest.

    Attributes
    ----------
    point, name, model : str
        Point, competitor and contact model.
    level : int
        The finer, the larger.
    cost : float
        Seconds.
    error : float
        Distance from the reference, dimensionless; NaN where there is no result.
    """

    point: str
    name: str
    model: str
    level: int
    cost: float
    error: float

    def is_finer_than(self, other: Trial) -> bool:
        """Whether it is of the same series of runs, and as fine as another or finer."""
        return self[:3] == other[:3] and self.level >= other.level


def ratios(trials: list, tolerance: float) -> tuple[list, list, np.ndarray]:
    """Least cost of every competitor at every point over the least of all.

    A run counts if it and all finer ones of its model and competitor are within the tolerance,
    since a coarse one may be right by chance.

    Parameters
    ----------
    trials : sequence of Trial
        The runs of a contest.
    tolerance : float
        Dimensionless.

    Returns
    -------
    tuple
        Names of the competitors in the order in which they appear, names of the points, and ratios
        of shape (competitors, points), infinite where no run counts.
    """
    of_point = list(dict.fromkeys(trial.point for trial in trials))
    of_name = list(dict.fromkeys(trial.name for trial in trials))
    least = np.full((len(of_name), len(of_point)), np.inf)
    for trial in trials:
        finer = [other.error for other in trials if other.is_finer_than(trial)]
        known = [error for error in finer if np.isfinite(error)]
        if np.isfinite(trial.error) and np.isfinite(trial.cost) and max(known) <= tolerance:
            place = of_name.index(trial.name), of_point.index(trial.point)
            least[place] = min(least[place], trial.cost)
    best = least.min(axis=0, initial=np.inf)
    solved = np.isfinite(least)
    return of_name, of_point, np.divide(least, best, out=np.full_like(least, np.inf), where=solved)


def variables(columns: dict, points: list[str], tolerances: Sequence[float]) -> dict:
    """Variables of the dataset: a row for each competitor of each contest.

    Parameters
    ----------
    columns : dict of list
        Columns of the table of trials: trial_point, trial_model, trial_method, trial_level, error,
        seconds, converged.
    points : list of str
        Names of all points.
    tolerances : sequence of float
        Dimensionless.

    Returns
    -------
    dict
        competitor_contest, competitor and profile_ratio, as xarray.Dataset takes them.
    """
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    contests, names, table = [], [], []
    for contest, entries in _entries(rows).items():
        found = []
        trials = [
            Trial(
                row["trial_point"],
                name,
                row["trial_model"],
                row["trial_level"],
                row["seconds"],
                row["error"] if row["converged"] else np.nan,
            )
            for row, name in entries
        ]
        for tolerance in tolerances:
            known, at, values = ratios(trials, tolerance)
            every = np.full((len(known), len(points)), np.inf)
            every[:, [points.index(point) for point in at]] = values
            found.append(every)
        contests += [contest] * len(known)
        names += known
        table.append(np.stack(found, axis=1))
    empty = np.empty((0, len(tolerances), len(points)))
    every_ratio = np.concatenate(table) if table else empty
    about = "least CPU time within the tolerance over that of the contest's best, infinite: never"
    return {
        "competitor_contest": variable("competitor", contests, "what is compared", str),
        "competitor": variable("competitor", names, "model or method", str),
        "profile_ratio": variable(("competitor", "map_tolerance", "point"), every_ratio, about),
    }


def _entries(rows: list[dict]) -> dict[str, list[tuple[dict, str]]]:
    """Rows of each contest with the name that each competes under."""
    methods = sorted({row["trial_method"] for row in rows} - {SHIPPED})
    contests = {method: contest_of(method) for method in methods}
    found = {
        MODELS: [
            (row, row["trial_model" if row["trial_method"] == SHIPPED else "trial_method"])
            for row in rows
            if contests.get(row["trial_method"], MODELS) == MODELS
        ]
    }
    for contest in dict.fromkeys(contests.values()):
        if contest != MODELS:
            mine = {method for method in methods if contests[method] == contest}
            own = [row for row in rows if row["trial_method"] in mine]
            # What ships is compared where the others were run.
            places = {(row["trial_point"], row["trial_model"]) for row in own}
            found[contest] = [
                (row, row["trial_method"])
                for row in rows
                if row["trial_method"] in mine | {SHIPPED}
                and (row["trial_point"], row["trial_model"]) in places
            ]
    return {contest: entries for contest, entries in found.items() if entries}
