"""Fronts and cheapest trials, and exponents fitted to trials."""

import numpy as np
from numpy.typing import ArrayLike

AS_CHEAP = 1.5
"""Ratio of two times up to which they may be the same."""


def on_front(cost: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Mark what nothing beats: nothing costs no more and errs no more, and one of the two less.

    cost, error: arrays (n,); what has no finite value of both takes no part. Returns bool (n,).
    """
    cost, error = np.asarray(cost, float), np.asarray(error, float)
    front = np.isfinite(cost) & np.isfinite(error)
    best, best_cost = np.inf, np.inf
    # From cheap to dear, of equal costs the more accurate first.
    for i in np.lexsort((error, cost)):
        if not front[i]:
            continue
        if error[i] < best:
            best, best_cost = error[i], cost[i]
        else:
            front[i] = error[i] == best and cost[i] == best_cost
    return front


def cheapest(cost: ArrayLike, error: ArrayLike, tolerance: float) -> int | None:
    """Index of the least cost among those within the tolerance, or None if none is.

    Costs that differ by less than clocks do count as equal: then the first one is taken.
    """
    cost, error = np.asarray(cost, float), np.asarray(error, float)
    good = np.flatnonzero(np.isfinite(cost) & (error <= tolerance))
    if not good.size:
        return None
    return int(good[np.argmax(cost[good] <= AS_CHEAP * cost[good].min())])


def confirmed(models: list[str], error: ArrayLike, exact: str) -> np.ndarray:
    """The error that each rung of a ladder is good for: the largest of its own and all finer ones.

    models: of the rungs, each from coarse to fine. A coarse run may be right by chance, where its
    error changes sign; so the last rung has nothing to confirm it and counts as infinitely wrong,
    but for the model `exact`, which is known to converge.
    """
    out = np.asarray(error, float).copy()
    for model in dict.fromkeys(models):
        rungs = [k for k, name in enumerate(models) if name == model]
        out[rungs] = np.maximum.accumulate(out[rungs][::-1])[::-1]
        if model != exact:
            out[rungs[-1]] = np.inf
    return out


def exponent(sizes: np.ndarray, values: np.ndarray) -> float:
    """Exponent p of values ~ sizes^p by least squares of logarithms, over the larger half of sizes.

    sizes, values: arrays (n,). NaN where fewer than two of them are positive numbers.
    """
    sizes, values = np.asarray(sizes, float), np.asarray(values, float)
    good = np.isfinite(sizes) & np.isfinite(values) & (sizes > 0) & (values > 0)
    order = np.argsort(sizes[good])
    sizes, values = sizes[good][order], values[good][order]
    half = slice(min(sizes.size // 2, max(sizes.size - 2, 0)), None)
    if sizes.size < 2:
        return np.nan
    return float(np.polyfit(np.log(sizes[half]), np.log(values[half]), 1)[0])
