"""Richardson extrapolation of three levels, each twice as fine as the previous one, with an error
estimate.

The methods are of second order, f(n) = f + C / n^2 + ..., and the difference D of the last two
levels gives the correction D / 3.  If the differences decrease with another order p, the levels
beyond the last one add up to D / (2^p - 1), and the extrapolated value is wrong by
D (1 / (2^p - 1) - 1 / 3).  The error estimate is this error for the observed order, times a safety
factor.  It is at least the correction and at most D, both times the safety factor.

Two levels can agree by chance.  Therefore D is at least a quarter of the difference of the first
two levels, which second order leads to expect.  This is the grid convergence index of Roache (J.
Fluids Eng. 116, 1994) with both pairs of levels.  Two cases show that the last two levels agree by
chance: the differences change sign, or the observed order is far above 2.  Then the last level is
not better than the one before, and D is the difference of the first two levels.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

ORDER = 2
"""Order of convergence of rings, angles and time steps."""
SAFETY = 1.5
"""Safety factor on the correction.  Calibrated by
`benchmarks/error_estimates.py --seed 3 --safety FACTOR`."""
CHANCE_ORDER = 2 * ORDER
"""Observed order above which the last two levels count as agreeing by chance.  From here on, D
increases linearly as the last difference decreases, up to the first difference if the last two
levels are equal.  `benchmarks/attacks.py` searches for points that this rule does not cover."""


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
    order : float or np.ndarray
        Observed order of convergence.  It is infinite if the last two levels agree, and NaN if all
        three agree.
    """

    value: Any
    error: Any
    order: Any


def extrapolate(values: Sequence[Any]) -> Extrapolation:
    """Richardson extrapolation of the values at levels n/4, n/2 and n."""
    coarse, middle, fine = values
    swings = (middle - coarse) * (fine - middle) < 0.0
    before, last = np.abs(middle - coarse), np.abs(fine - middle)
    chance = before - 2.0**CHANCE_ORDER * (1.0 - 2.0**-ORDER) * last
    least = np.where(swings, before, np.maximum(chance, before / 2**ORDER))
    with np.errstate(divide="ignore", invalid="ignore"):
        order = np.log2(np.divide(before, last))
        beyond = np.where(order > 0.0, 1.0 / (2.0**order - 1.0), np.inf)
    correction = 1.0 / (2**ORDER - 1)
    share = np.clip(beyond - correction, correction, 1.0)
    error = SAFETY * share * np.maximum(last, least)
    return Extrapolation(np.tensordot(WEIGHTS, values, 1), error, order)
