"""The static limit at many amplitudes, interpolated between a few at which it is solved."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from itertools import pairwise

import numpy as np

from microslip.foundation.arguments import LARGEST
from microslip.si.request import Request
from microslip.si.static_limit import TOLERANCE, tolerance_of

DEVIATIONS = -3.0, -1.96, -1.3, -0.65, 0.0, 0.65, 1.3, 1.96, 3.0
"""Amplitudes at which the static limit is solved, as quantiles of the drawn amplitudes: standard
deviations of a normal distribution.  1.96 deviations are the ends of a 95 % interval.
tests/si/test_outcomes.py checks the result by Monte Carlo."""
REFINEMENTS = 3
"""Number of further amplitudes, each in the middle of the draws whose threshold is closest to the
force; and of those by which the amplitude is bisected above which the limit is 0."""
CLOSEST = 64
"""One in so many draws is close to the force."""
SAME_AMPLITUDE, SAME_POISSON = 1e-9, 1e-9
"""Range of the amplitude over its central value, and standard deviation of Poisson's ratio, below
which a change is rounding."""


def static_limits(
    request: Request,
    centre: tuple[float, float, float, float],
    amplitudes: np.ndarray,
    poisson: np.ndarray,
    forces: tuple[np.ndarray, np.ndarray] | None,
) -> tuple[np.ndarray, np.ndarray]:
    """mu_static of many draws, and its error estimate: to first order of Poisson's ratio.

    Parameters
    ----------
    request : request.Request
        The request at the central values.
    centre : tuple of float
        Amplitude and Poisson's ratio there, mu_static and its error.
    amplitudes, poisson : np.ndarray, shape (draws,)
        Amplitude as a group, and Poisson's ratio.
    forces : tuple of np.ndarray or None
        Friction without vibration and the prescribed force, N, for the choice of amplitudes.
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.special import ndtr

    limit = _limits_of(request)
    amplitude, ratio, *solved = centre
    # The interpolation variable A / (A + centre) is proportional to small amplitudes A, and its
    # distance from 1 to 1 / A at large ones: the static limit varies smoothly with it at both ends.
    known: dict[float, tuple[float, float]] = {0.5: (solved[0], solved[1])}
    where = np.minimum(amplitudes, LARGEST["amplitude"])
    where = where / (where + amplitude)

    def solve_at(place: float) -> None:
        if place <= 0.0:
            known[0.0] = 1.0, 0.0  # friction without vibration
            return
        answer = limit(amplitude * place / (1.0 - place), ratio)
        if answer is not None:
            known[place] = answer

    def interpolated() -> tuple[np.ndarray, np.ndarray]:
        places = np.array(sorted(known))
        if places.size == 1:
            value, error = known[places[0]]
            return np.full(where.shape, value), np.full(where.shape, error)
        within = np.clip(where, places[0], places[-1])
        values, errors = np.array([known[place] for place in places]).T
        return PchipInterpolator(places, values)(within), np.interp(within, places, errors)

    if np.ptp(where) > SAME_AMPLITUDE:
        for place in np.quantile(where, ndtr(DEVIATIONS)):
            solve_at(float(place))
    for _ in range(REFINEMENTS):
        pairs = pairwise(sorted(known.items()))
        ends = [
            (a, b) for (a, one), (b, other) in pairs if one[0] > one[1] and other[0] <= other[1]
        ]
        if ends:
            solve_at(0.5 * sum(ends[-1]))
    for _ in range(REFINEMENTS if len(known) > 1 else 0):
        if forces is None:
            break
        value, _ = interpolated()
        count = where.size // CLOSEST
        closest = np.argpartition(np.abs(forces[0] * value - forces[1]), count)[:count]
        solve_at(float(np.median(where[closest])))
    value, error = interpolated()
    change = _slope(limit, amplitude, ratio, float(np.std(poisson))) * (poisson - ratio)
    return np.clip(value + change, 0.0, 1.0), error


def _slope(limit: Callable, amplitude: float, ratio: float, deviation: float) -> float:
    """Derivative of mu_static by Poisson's ratio."""
    if deviation < SAME_POISSON:
        return 0.0
    ends = [min(max(ratio + sign * deviation, 0.0), 0.5) for sign in (-1, 1)]
    low, high = (limit(amplitude, end) for end in ends)
    if low is None or high is None:
        return 0.0
    return (high[0] - low[0]) / (ends[1] - ends[0])


def _limits_of(request: Request) -> Callable[[float, float], tuple[float, float] | None]:
    """limit(amplitude, poisson) -> (mu_static, error), or None where the solver has no answer."""
    tolerance = tolerance_of(request, TOLERANCE)

    @cache
    def limit(amplitude: float, poisson: float) -> tuple[float, float] | None:
        answer = request.solve(0.0, tolerance, amplitude=amplitude, poisson=poisson)
        finite = math.isfinite(answer.mu_macro) and math.isfinite(answer.mu_macro_error)
        return (answer.mu_macro, answer.mu_macro_error) if finite else None

    return limit
