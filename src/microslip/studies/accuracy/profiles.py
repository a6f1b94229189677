"""Performance profiles: costs of models or methods, relative to the best one in a contest.

E. D. Dolan and J. J. More, Math. Program. 91 (2002) 201-213, doi:10.1007/s101070100263. A case is a
point and a tolerance. The cost of a competitor is the cost of its cheapest run within the
tolerance. The ratio of a competitor is this cost divided by the smallest cost in the contest.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from microslip.datasets.variables import variable
from microslip.solver.method_names import SHIPPED, method_named

MODELS = "models"


def contest_of(method: str) -> str:
    """Return a method's contest. It depends on the part of a run that the method replaces.

    Parameters
    ----------
    method : str
        Name of a method, with or without the values of its parameters.

    Returns
    -------
    str
        "models" for the shipped method and for methods that replace the whole run, else
        "integrators", "solvers of a step" or "searches".
    """
    parts, shipped = method_named(method), method_named(SHIPPED)
    if method == SHIPPED or parts.run is not None:
        return MODELS
    if parts.dress is not None:
        return "solvers of a step"
    if parts.integrator != shipped.integrator:
        return "integrators"
    return "searches"


def variables(rows: list[dict], points: list[str], tolerances: Sequence[float]) -> dict:
    """Return the variables of the dataset, with one row for each competitor in each contest.

    Parameters
    ----------
    rows : list of dict
        Rows of the table of trials: trial_point, trial_model, trial_method, trial_level, error,
        seconds, converged.
    points : list of str
        Names of all points.
    tolerances : sequence of float
        Dimensionless tolerances.

    Returns
    -------
    dict
        Variables competitor_contest, competitor and profile_ratio, as arguments of xarray.Dataset.
    """
    contests: list[str] = []
    names: list[str] = []
    ratios = [np.empty((0, len(tolerances), len(points)))]
    for contest, trials in _contests(rows):
        competitors = list(dict.fromkeys(name for name, _ in trials))
        contests += [contest] * len(competitors)
        names += competitors
        least = _least_costs(trials, competitors, points, np.array(tolerances))
        ratio = np.full_like(least, np.inf)
        np.divide(least, least.min(axis=0), out=ratio, where=np.isfinite(least))
        ratios.append(ratio)
    about = (
        "smallest CPU time within the tolerance over that of the best competitor; infinite: none"
    )
    return {
        "competitor_contest": variable("competitor", contests, "what is compared", str),
        "competitor": variable("competitor", names, "model or method", str),
        "profile_ratio": variable(
            ("competitor", "map_tolerance", "point"), np.concatenate(ratios), about
        ),
    }


def _contests(rows: list[dict]) -> Iterator[tuple[str, list[tuple[str, dict]]]]:
    """Yield the name of each contest, and its trials as pairs (competitor, row)."""
    contests = {method: contest_of(method) for method in sorted({r["trial_method"] for r in rows})}
    for contest in dict.fromkeys([MODELS, *contests.values()]):
        own = [row for row in rows if contests[row["trial_method"]] == contest]
        places = {(row["trial_point"], row["trial_model"]) for row in own}
        trials = []
        for row in rows:
            method = row["trial_method"]
            # The shipped method is included at the points and models of its rivals.
            beside = method == SHIPPED and (row["trial_point"], row["trial_model"]) in places
            if contests[method] == contest or beside:
                is_model = method == SHIPPED and contest == MODELS
                trials.append((row["trial_model"] if is_model else method, row))
        if trials:
            yield contest, trials


def _least_costs(
    trials: list[tuple[str, dict]],
    competitors: list[str],
    points: list[str],
    tolerances: np.ndarray,
) -> np.ndarray:
    """Return the smallest costs within each tolerance, shape (competitors, tolerances, points).

    A cost is infinite if no run is within the tolerance. The error of a coarse run can be small by
    chance. Therefore a run counts only if all finer runs of its competitor and model are also
    within the tolerance.
    """
    least = np.full((len(competitors), len(tolerances), len(points)), np.inf)
    largest: dict[tuple, float] = {}
    for name, row in sorted(trials, key=lambda trial: trial[1]["trial_level"], reverse=True):
        series = name, row["trial_point"], row["trial_model"]
        error = row["error"] if row["converged"] else np.nan
        largest[series] = np.fmax(largest.get(series, 0.0), error)
        if np.isfinite(error) and np.isfinite(row["seconds"]):
            costs = least[competitors.index(name), :, points.index(row["trial_point"])]
            np.minimum(costs, row["seconds"], out=costs, where=largest[series] <= tolerances)
    return least
