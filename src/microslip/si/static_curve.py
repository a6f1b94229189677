"""The static limit at many amplitudes, interpolated between a few solved amplitudes."""

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
"""The static limit is solved at these quantiles of the drawn amplitudes, given in standard
deviations of a normal distribution.  The ends of a 95 % interval are at 1.96."""
REFINEMENTS = 3
"""Number of additional solved amplitudes with a static limit close to the force.  Also the number
of bisections for the smallest amplitude with a static limit of 0."""
CLOSEST = 64
"""One draw in 64 counts as close to the force.  Each refinement solves the static limit at the
median amplitude of these draws."""
SAME_AMPLITUDE, SAME_POISSON = 1e-9, 1e-9
"""Variations below these values count as rounding errors: relative range of the amplitude, and
standard deviation of Poisson's ratio."""


def static_limits(
    request: Request,
    centre: tuple[float, float],
    amplitudes: np.ndarray,
    poisson: np.ndarray,
    forces: tuple[np.ndarray, np.ndarray] | None,
) -> tuple[np.ndarray, np.ndarray]:
    """mu_static for all draws, and its error estimate.  Poisson's ratio is included to first order.

    Parameters
    ----------
    request : request.Request
        The request for the central values.
    centre : tuple of float
        mu_static and its error estimate for the central values, dimensionless.
    amplitudes, poisson : np.ndarray, shape (draws,)
        Dimensionless amplitude and Poisson's ratio of each draw.
    forces : tuple of np.ndarray or None
        Friction without vibration and the prescribed force of each draw, N.  Additional amplitudes
        are solved near the draws whose friction is close to the force.

    Returns
    -------
    tuple of np.ndarray, shape (draws,)
        mu_static and its error estimate.
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.special import ndtr

    limit, amplitude, ratio = _limits_of(request), request.groups[1], request.contact.poisson
    assert amplitude is not None  # the motion oscillates
    # The interpolation variable is x = A / (A + centre).  For a small amplitude A, x is
    # proportional to A.  For a large one, 1 - x is proportional to 1 / A.  So the static limit is
    # a smooth function of x at both ends.
    nodes: dict[float, tuple[float, float]] = {0.5: centre}
    where = np.minimum(amplitudes, LARGEST["amplitude"])
    where = where / (where + amplitude)

    def solve_at(place: float) -> None:
        if place <= 0.0:
            nodes[0.0] = 1.0, 0.0  # friction without vibration
            return
        answer = limit(amplitude * place / (1.0 - place), ratio)
        if answer is not None:
            nodes[place] = answer

    def interpolated() -> tuple[np.ndarray, np.ndarray]:
        places = np.array(sorted(nodes))
        if places.size == 1:
            value, error = nodes[places[0]]
            return np.full(where.shape, value), np.full(where.shape, error)
        within = np.clip(where, places[0], places[-1])
        values, errors = np.array([nodes[place] for place in places]).T
        return PchipInterpolator(places, values)(within), np.interp(within, places, errors)

    if np.ptp(where) > SAME_AMPLITUDE:
        for place in np.quantile(where, ndtr(DEVIATIONS)):
            solve_at(float(place))
    for _ in range(REFINEMENTS):
        pairs = pairwise(sorted(nodes.items()))
        ends = [
            (a, b) for (a, one), (b, other) in pairs if one[0] > one[1] and other[0] <= other[1]
        ]
        if ends:
            solve_at(0.5 * sum(ends[-1]))
    for _ in range(REFINEMENTS if len(nodes) > 1 else 0):
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
    """Slope of mu_static over Poisson's ratio.  deviation: standard deviation of this ratio."""
    if deviation < SAME_POISSON:
        return 0.0
    ends = [min(max(ratio + sign * deviation, 0.0), 0.5) for sign in (-1, 1)]
    low, high = (limit(amplitude, end) for end in ends)
    if low is None or high is None:
        return 0.0
    return (high[0] - low[0]) / (ends[1] - ends[0])


def _limits_of(request: Request) -> Callable[[float, float], tuple[float, float] | None]:
    """The function limit(amplitude, poisson) -> (mu_static, error).  It returns None if the solver
    fails."""
    tolerance = tolerance_of(request, TOLERANCE)

    @cache
    def limit(amplitude: float, poisson: float) -> tuple[float, float] | None:
        answer = request.solve(0.0, tolerance, amplitude=amplitude, poisson=poisson)
        finite = math.isfinite(answer.mu_macro) and math.isfinite(answer.mu_macro_error)
        return (answer.mu_macro, answer.mu_macro_error) if finite else None

    return limit
