"""Pareto fronts, cheapest trials, and fitted cost exponents."""

import numpy as np
from numpy.typing import ArrayLike

AS_CHEAP = 1.5
"""Two measured times count as equal if their ratio is below this number."""


def on_front(cost: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Return a bool array, shape (n,): True for trials on the Pareto front of cost and error.

    A trial is on the front if every other trial is more expensive, less accurate, or equal in both.
    cost, error: arrays of shape (n,). Trials with values that are not finite are not on the front.
    """
    cost, error = np.asarray(cost, float), np.asarray(error, float)
    front = np.isfinite(cost) & np.isfinite(error)
    best, best_cost = np.inf, np.inf
    # From cheap to expensive; among equal costs, the more accurate trial comes first.
    for i in np.lexsort((error, cost)):
        if not front[i]:
            continue
        if error[i] < best:
            best, best_cost = error[i], cost[i]
        else:
            front[i] = error[i] == best and cost[i] == best_cost
    return front


def cheapest(cost: ArrayLike, error: ArrayLike, tolerance: float) -> int | None:
    """Return the index of the cheapest trial within the tolerance, or None if there is none.

    Times are uncertain, so costs within a factor AS_CHEAP of the lowest cost count as equal. The
    first of these trials is returned.
    """
    cost, error = np.asarray(cost, float), np.asarray(error, float)
    good = np.flatnonzero(np.isfinite(cost) & (error <= tolerance))
    if not good.size:
        return None
    return int(good[np.argmax(cost[good] <= AS_CHEAP * cost[good].min())])


def confirmed(models: list[str], error: ArrayLike, exact: str) -> np.ndarray:
    """Return confirmed errors: for each level, the largest error at this and all finer levels.

    Only levels of the same model are compared. A coarse run's error can be small by chance, where
    the error changes sign. The finest level of a model cannot be confirmed, so its error is
    infinite. The exception is the model `exact`, which converges to the reference. models: model of
    each level, from coarse to fine.
    """
    out = np.asarray(error, float).copy()
    for model in dict.fromkeys(models):
        levels = [k for k, name in enumerate(models) if name == model]
        out[levels] = np.maximum.accumulate(out[levels][::-1])[::-1]
        if model != exact:
            out[levels[-1]] = np.inf
    return out
