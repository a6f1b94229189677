"""Richardson extrapolation of three levels, each twice as fine as the previous one, with an error
estimate.

The methods are of second order, f(n) = f + C / n^2 + ..., and the difference D of the last two
levels gives the correction D / 3.  The difference of the first two levels, divided by four, is
another estimate of D.  The error estimate uses the larger one: two coarse levels can agree by
chance, but then the third one differs.  This is the grid convergence index of Roache (J. Fluids
Eng. 116, 1994) with both pairs of levels.

If the differences decrease more slowly than at first order, the levels are too coarse.  Then D is
used instead of D / 3, as for a first-order method.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

ORDER = 2
"""Order of convergence of rings, angles and time steps."""
SAFETY = 1.5
"""Safety factor on the correction.  A factor of 2 would cover first-order convergence.  Calibrated
by `benchmarks/error_estimates.py --seed 3 --safety FACTOR`."""


WEIGHTS = 0.0, -1.0 / (2**ORDER - 1), 2**ORDER / (2**ORDER - 1)
"""Weights of the levels n/4, n/2 and n in the extrapolated value."""


class Extrapolation(NamedTuple):
    """Limit of a sequence of levels.  Arrays are extrapolated element by element.

    Attributes
    ----------
    value : float or np.ndarray
        Limit at infinite n.
    error : float or np.ndarray
        Estimated error of the limit.
    difference : float or np.ndarray
        Difference between the last two levels, or a quarter of the previous difference if that is
        larger.  It covers the error of the last level for first-order convergence.
    order : float or np.ndarray
        Observed order of convergence.  It is infinite if the last two levels agree, and NaN if all
        three agree.
    """

    value: Any
    error: Any
    difference: Any
    order: Any


def extrapolate(values: Sequence[Any]) -> Extrapolation:
    """Richardson extrapolation of the values at levels n/4, n/2 and n."""
    coarse, middle, fine = values
    before, last = np.abs(middle - coarse), np.abs(fine - middle)
    difference = np.maximum(last, before / 2**ORDER)
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log2(np.divide(before, last))
    error = SAFETY * difference / (2 ** np.where(order < 1.0, 1, ORDER) - 1)
    return Extrapolation(np.tensordot(WEIGHTS, values, 1), error, difference, order)
