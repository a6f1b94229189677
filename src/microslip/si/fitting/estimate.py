"""Least-squares fit of two positive numbers, with intervals from the profile sum of squares.

The unknowns are theta = (ln mu, ln scale).  For each value of one unknown, the sum of squares is
minimised over the other unknown.  The interval contains the values for which this minimum is below
a threshold.  The threshold is the least sum of squares plus a quantile.  If the rows have errors,
this is a quantile of the chi-square distribution.  Otherwise, it is the mean square residual times
a quantile of the F distribution.  Such an interval does not depend on the parametrisation.  An
interval may be infinite on one side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from microslip.si.fitting.friction_models import FrictionModel
from microslip.si.fitting.measured import Measured
from microslip.si.fitting.scales import Points, Scale
from microslip.si.inputs import LARGEST_MU

SCANNED = 61
"""Number of values of the scale in the scan for initial guesses."""
MOST_STARTS = 3
"""Largest number of initial guesses."""
GUESSED_MU = 0.3
"""Coefficient of friction at the start of the scan."""
PASSES = 3
"""Number of linear fits of mu in the scan."""
STILL = 1e-10
"""Changes of theta below this value count as zero."""
FIRST_STEP = 0.1
"""First step from the best fit towards an end of an interval, used if the curvature is singular."""
DOUBLINGS = 12
"""Largest number of steps towards the end of an interval.  Each step is twice as long as the last
one."""


SMALLEST_MU = 1e-5
"""Smallest coefficient of friction of a fit."""


@dataclass(frozen=True, eq=False)
class LeastSquares:
    """The least-squares problem of a fit: measured value = mu * weight * mu_macro + error.

    Attributes
    ----------
    scale : Scale
        The second unknown, with the measured rows.
    model : FrictionModel
        The model of mu_macro.
    """

    scale: Scale
    model: FrictionModel

    @property
    def rows(self) -> Measured:
        return self.scale.rows

    @cached_property
    def error(self) -> np.ndarray:
        """Standard errors in the unit of the values, shape (n,).  If the errors are unknown, all
        are set to the same arbitrary value."""
        value = self.rows.value
        common = max(float(np.abs(value).max()), np.finfo(float).tiny)
        return self.rows.error if self.rows.has_errors else np.full_like(value, common)

    @cached_property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper bounds of theta, shape (2,) each."""
        low, high = self.scale.bounds
        return np.log([SMALLEST_MU, low]), np.log([LARGEST_MU, high])

    def ratios(self, thetas: np.ndarray) -> np.ndarray:
        """mu_macro of all rows, from shape (k, 2) to shape (k, n).  A single call for all guesses
        is faster with a map."""
        parts = zip(*(self.scale.points(*np.exp(theta)) for theta in thetas), strict=True)
        points = Points(*(np.concatenate(part) for part in parts))
        return self.model.at(points).reshape(len(thetas), -1)

    def residuals(self, theta: np.ndarray) -> np.ndarray:
        """Measured value minus model, divided by the error, shape (n,)."""
        (ratio,) = self.ratios(theta[None])
        return (self.rows.value - np.exp(theta[0]) * self.rows.weight * ratio) / self.error


@dataclass(frozen=True, eq=False)
class Best:
    """A minimum of the sum of squares.

    Attributes
    ----------
    theta : np.ndarray, shape (2,)
        Position of the minimum.
    squares : float
        Sum of squares at the minimum.
    slopes : np.ndarray, shape (n, number of free unknowns)
        Derivatives of the residuals.
    """

    theta: np.ndarray
    squares: float
    slopes: np.ndarray


def best_near(problem: LeastSquares, theta: np.ndarray, free: Sequence[int] = (0, 1)) -> Best:
    """Minimise the sum of squares over some of the unknowns, from an initial guess.

    Parameters
    ----------
    theta : np.ndarray, shape (2,)
        The initial guess.
    free : sequence of int
        Indices of the unknowns to fit.  Other unknowns are fixed.
    """
    from scipy.optimize import least_squares

    free = list(free)
    theta = np.array(theta)

    def residuals(values: np.ndarray) -> np.ndarray:
        point = theta.copy()
        point[free] = values
        return problem.residuals(point)

    low, high = problem.bounds
    bounds = low[free], high[free]
    start = np.clip(theta[free], bounds[0] + STILL, bounds[1] - STILL)
    settings = {"xtol": STILL, "ftol": STILL, "gtol": STILL, "diff_step": 1e-5}
    solution = least_squares(residuals, start, bounds=bounds, **settings)
    theta[free] = solution.x
    return Best(theta, 2.0 * float(solution.cost), solution.jac)


def starts(problem: LeastSquares) -> list[np.ndarray]:
    """Initial guesses of theta, the best one first.  They come from a scan over the scale."""
    low, high = problem.bounds
    thetas = np.linspace(low, high, SCANNED)
    thetas[:, 0] = np.clip(np.log(GUESSED_MU), low[0], high[0])
    measured = problem.rows.value / problem.error
    for _ in range(PASSES):  # mu by linear least squares, with the ratios of the last mu
        slopes = problem.rows.weight / problem.error * problem.ratios(thetas)
        mu = slopes @ measured / np.maximum((slopes * slopes).sum(axis=1), np.finfo(float).tiny)
        mu = np.maximum(mu, np.finfo(float).tiny)
        thetas[:, 0] = np.clip(np.log(mu), low[0], high[0])
    squares = ((measured - np.exp(thetas[:, :1]) * slopes) ** 2).sum(axis=1)
    padded = np.pad(squares, 1, constant_values=np.inf)
    lowest = np.flatnonzero((squares <= padded[:-2]) & (squares <= padded[2:]))
    order = lowest[np.argsort(squares[lowest], kind="stable")][:MOST_STARTS]
    return [thetas[k] for k in order]


def threshold(problem: LeastSquares, best: Best, confidence: float, model: np.ndarray) -> float:
    """Largest difference from the least sum of squares inside an interval.

    Parameters
    ----------
    model : np.ndarray, shape (n,)
        Largest error of the model in each row, divided by the row's standard error.  The threshold
        is at least the mean square of these ratios.
    """
    from scipy.stats import chi2, f

    if problem.rows.has_errors:
        noise = float(chi2.ppf(confidence, 1))
    else:
        free = len(problem.rows.value) - 2
        noise = float(f.ppf(confidence, 1, free)) * best.squares / free
    return max(noise, float(np.mean(model**2)), np.finfo(float).tiny)


def end(problem: LeastSquares, best: Best, which: int, side: float, allowed: float) -> float:
    """An end of the interval for one unknown.  It is infinite if the rows do not determine it.

    Parameters
    ----------
    which : int
        Index of the unknown: 0 for mu, 1 for the scale.
    side : float
        -1 for the lower end, 1 for the upper end.
    allowed : float
        The value of `threshold`.
    """
    from scipy.optimize import brentq

    last = best.theta

    def excess(value: float) -> float:
        """Least sum of squares for a fixed value of the unknown, minus the largest sum allowed in
        the interval."""
        nonlocal last
        start = np.where(np.arange(2) == which, value, last)
        minimum = best_near(problem, start, free=[1 - which])
        last = minimum.theta
        return minimum.squares - best.squares - allowed

    start = float(best.theta[which])
    bound = float(problem.bounds[int(side > 0.0)][which])
    step, inner = _first_step(best, which, allowed), start
    for _ in range(DOUBLINGS):
        outer = start + side * step if step < abs(bound - start) else bound
        if excess(outer) > 0.0:
            return float(brentq(excess, inner, outer, xtol=1e-6)) if inner != outer else start
        if outer == bound:
            return side * np.inf
        inner, step = outer, 2.0 * step
    return side * np.inf


def _first_step(best: Best, which: int, allowed: float) -> float:
    """Half the width of the interval in a linear model."""
    curvature = best.slopes.T @ best.slopes
    if np.linalg.cond(curvature) > 1e12:
        return FIRST_STEP
    return float(np.clip(np.sqrt(allowed * np.linalg.inv(curvature)[which, which]), 1e-6, 1.0))


def shifts(best: Best, model: np.ndarray, determined: list[int]) -> np.ndarray:
    """Largest change of theta that model errors cause, to first order, shape (2,).

    Parameters
    ----------
    model : np.ndarray, shape (n,)
        Largest error of the model in each row, divided by the row's standard error.
    determined : list of int
        Indices of the unknowns that the rows determine.  The other unknowns do not change.
    """
    shift = np.zeros(2)
    shift[determined] = np.abs(np.linalg.pinv(best.slopes[:, determined])) @ model
    return shift
