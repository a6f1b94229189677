"""Plain march, period after period, until the state is periodic."""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import StepFailure
from microslip.solver.method import Method
from microslip.solver.search import AT_REST, Goal, PeriodicState, PeriodMap, result_of

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two successive changes used in an extrapolation.  Rounding can make it 1."""


def plain_march(
    period_map: PeriodMap, start: np.ndarray, goal: Goal, place: np.ndarray = AT_REST
) -> PeriodicState:
    """Search by the plain march, with the distance estimate of the shipped search.

    The remaining changes are extrapolated as a geometric series, using the ratio of the last two
    changes.
    """
    contact, path = period_map.contact, period_map.path
    state, previous, last, distance, iterations = start, None, np.nan, np.inf, 0
    for marches in range(1, goal.most_marches + 1):
        march = previous = contact.march(path, state, goal.step_tolerance, previous)
        iterations += march.iterations
        image, moved = period_map.following(march)
        residual = period_map.norm(image - state, moved)
        if not np.isfinite(residual):
            raise StepFailure("diverged: tractions are not finite")
        if marches > 1:
            ratio = min(residual / last, SLOWEST) if last > 0.0 else 0.0
            mean = float(path.mean(march.forces[:, 0]))
            distance = max(residual / (1.0 - ratio), period_map.drift_rate.error(mean, residual))
        converged = distance <= goal.tolerance
        if converged or marches == goal.most_marches:
            break
        state, last = image, residual
    counts = {"marches": marches, "iterations": iterations}
    return result_of(march, state, distance, residual, converged=converged, **counts)


METHOD = Method("plain march to the periodic state", search=plain_march, prepared=False)
