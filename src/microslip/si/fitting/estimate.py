"""Least squares of two positive numbers, with intervals from the profile of the sum of squares.

Both are looked for by their logarithms, theta = (ln mu, ln scale).  An interval holds all values of
one number for which the other one can be chosen so that the sum of squares stays below a threshold:
the least one plus a quantile of chi square where the errors of the rows are given, and else of F
times the mean square that is left.  It does not depend on how the numbers are written, and it may
be open to one side, which is how rows say that they cannot tell a number.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

SCANNED = 61
"""Values of the scale between its bounds from which the best one is looked for."""
MOST_STARTS = 3
GUESSED_MU = 0.3
PASSES = 3
STILL = 1e-10
"""Change of theta that is none."""
FIRST_STEP = 0.1
DOUBLINGS = 12


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows that a model is fitted to: value = mu weight ratio + error.

    Attributes
    ----------
    ratios : callable
        thetas, shape (k, 2), to an array, shape (k, n).
    value, weight, error : np.ndarray, shape (n,)
        error: the standard error, or what all rows have in common, in any unit.
    absolute : bool
        Whether the errors are known; else they tell no more than how rows compare.
    lower, upper : np.ndarray, shape (2,)
        Bounds of theta.
    """

    ratios: Callable
    value: np.ndarray
    weight: np.ndarray
    error: np.ndarray
    absolute: bool
    lower: np.ndarray
    upper: np.ndarray

    def residuals(self, theta: np.ndarray) -> np.ndarray:
        """Value minus model over the error, shape (n,)."""
        (ratio,) = self.ratios(theta[None])
        return (self.value - np.exp(theta[0]) * self.weight * ratio) / self.error


@dataclass(frozen=True, eq=False)
class Best:
    """A least sum of squares.

    Attributes
    ----------
    theta : np.ndarray, shape (2,)
        Where it is.
    squares : float
        Its value.
    slopes : np.ndarray, shape (n, 2)
        Derivatives of the residuals.
    """

    theta: np.ndarray
    squares: float
    slopes: np.ndarray


def best_near(rows: Rows, theta: np.ndarray) -> Best:
    """The least sum of squares next to a start."""
    from scipy.optimize import least_squares

    inside = np.clip(theta, rows.lower + STILL, rows.upper - STILL)
    settings = {"bounds": (rows.lower, rows.upper), "xtol": STILL, "ftol": STILL, "gtol": STILL}
    found = least_squares(rows.residuals, inside, diff_step=1e-5, **settings)
    return Best(found.x, 2.0 * float(found.cost), found.jac)


def starts(rows: Rows) -> list[np.ndarray]:
    """Initial guesses: the best places of a scan over all scales, the best one first."""
    thetas = np.empty((SCANNED, 2))
    thetas[:, 0] = np.clip(np.log(GUESSED_MU), rows.lower[0], rows.upper[0])
    thetas[:, 1] = np.linspace(rows.lower[1], rows.upper[1], SCANNED)
    measured = rows.value / rows.error
    for _ in range(PASSES):  # mu by linear least squares, for the ratios that belong to the last mu
        slopes = rows.weight / rows.error * rows.ratios(thetas)
        mu = slopes @ measured / np.maximum((slopes * slopes).sum(axis=1), np.finfo(float).tiny)
        mu = np.maximum(mu, np.finfo(float).tiny)
        thetas[:, 0] = np.clip(np.log(mu), rows.lower[0], rows.upper[0])
    squares = ((measured - np.exp(thetas[:, :1]) * slopes) ** 2).sum(axis=1)
    padded = np.pad(squares, 1, constant_values=np.inf)
    lowest = np.flatnonzero((squares <= padded[:-2]) & (squares <= padded[2:]))
    order = lowest[np.argsort(squares[lowest], kind="stable")][:MOST_STARTS]
    return [thetas[k] for k in order]


def threshold(rows: Rows, best: Best, confidence: float, model: np.ndarray) -> float:
    """How much above the least one a sum of squares may be.

    Parameters
    ----------
    model : np.ndarray, shape (n,)
        Largest error of the model, over the error of the row: what is less than it in one row
        tells nothing.
    """
    from scipy.stats import chi2, f

    if rows.absolute:
        noise = float(chi2.ppf(confidence, 1))
    else:
        free = len(rows.value) - 2
        noise = float(f.ppf(confidence, 1, free)) * best.squares / free
    return max(noise, float(np.mean(model**2)), np.finfo(float).tiny)


def interval(rows: Rows, best: Best, which: int, allowed: float) -> tuple[float, float]:
    """Both ends of one number of theta, infinite where the rows leave it open.

    Parameters
    ----------
    which : int
        0 for mu, 1 for the scale.
    allowed : float
        What `threshold` says.
    """
    return _end(rows, best, which, allowed, -1.0), _end(rows, best, which, allowed, 1.0)


def _end(rows: Rows, best: Best, which: int, allowed: float, side: float) -> float:
    from scipy.optimize import brentq

    other = 1 - which
    last = [best.theta[other]]

    def above(value: float) -> float:
        """Sum of squares above what is allowed, with the other number as good as it can be."""
        last[0], squares = _other_best(rows, which, value, last[0])
        return squares - best.squares - allowed

    start = float(best.theta[which])
    bound = float((rows.lower if side < 0.0 else rows.upper)[which])
    step, inner = _first_step(best, which, allowed), start
    for _ in range(DOUBLINGS):
        outer = start + side * step if step < abs(bound - start) else bound
        if above(outer) > 0.0:
            return float(brentq(above, inner, outer, xtol=1e-6)) if inner != outer else start
        if outer == bound:
            return side * np.inf
        inner, step = outer, 2.0 * step
    return side * np.inf


def _first_step(best: Best, which: int, allowed: float) -> float:
    """Half width of the interval of a linear model."""
    curvature = best.slopes.T @ best.slopes
    if np.linalg.cond(curvature) > 1e12:
        return FIRST_STEP
    return float(np.clip(np.sqrt(allowed * np.linalg.inv(curvature)[which, which]), 1e-6, 1.0))


def _other_best(rows: Rows, which: int, value: float, start: float) -> tuple[float, float]:
    """The other number where one is held, and the sum of squares there."""
    from scipy.optimize import least_squares

    other = 1 - which

    def theta(x: np.ndarray) -> np.ndarray:
        both = np.empty(2)
        both[which], both[other] = value, x[0]
        return both

    bounds = rows.lower[other], rows.upper[other]
    inside = np.clip(start, bounds[0] + STILL, bounds[1] - STILL)
    found = least_squares(
        lambda x: rows.residuals(theta(x)), [inside], bounds=bounds, diff_step=1e-5
    )
    return float(found.x[0]), 2.0 * float(found.cost)


def shifts(best: Best, model: np.ndarray, told: list[int]) -> np.ndarray:
    """How far errors of the model can move the numbers that are told, to first order.

    Parameters
    ----------
    model : np.ndarray, shape (n,)
        Largest error of the model in each row, over the error of the row.
    told : list of int
        Which of theta are told; the others are held.

    Returns
    -------
    np.ndarray, shape (2,)
        0 for those that are not.
    """
    moved = np.zeros(2)
    moved[told] = np.abs(np.linalg.pinv(best.slopes[:, told])) @ model
    return moved
