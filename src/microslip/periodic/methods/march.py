"""Plain integration in time, period after period, until the state is periodic."""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import StepFailure
from microslip.periodic.method import Method
from microslip.periodic.search import AT_REST, Goal, PeriodicState, PeriodMap

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two successive changes used in an extrapolation.  Rounding errors can make the
ratio 1."""


def plain_march(
    period_map: PeriodMap, start: np.ndarray, goal: Goal, place: np.ndarray = AT_REST
) -> PeriodicState:
    """Find the periodic state by plain marches over (half) periods.

    The distance is estimated as in the shipped search, with one exception.  The remaining changes
    of the state are extrapolated as a geometric series, whose ratio is the ratio of the last two
    changes.
    """
    state, march, last, distance, iterations = start, None, np.nan, np.inf, 0
    for marches in range(1, goal.most_marches + 1):
        march = period_map.march(state, goal.step_tolerance, march)
        iterations += march.iterations
        image, change = period_map.step(state, march)
        residual = period_map.norm(change)
        if not np.isfinite(residual):
            raise StepFailure("diverged: tractions are not finite")
        if marches > 1:
            ratio = min(residual / last, SLOWEST) if last > 0.0 else 0.0
            mean = float(period_map.path.mean(march.forces[:, 0]))
            distance = max(residual / (1.0 - ratio), period_map.drift_rate.error(mean, residual))
        if distance <= goal.tolerance or marches == goal.most_marches:
            break
        state, last = image, residual
    assert march is not None  # there is at least one march
    converged = distance <= goal.tolerance
    return PeriodicState(march, state, residual, distance, marches, iterations, converged)


METHOD = Method("plain march to the periodic state", search=plain_march, prepared=False)
