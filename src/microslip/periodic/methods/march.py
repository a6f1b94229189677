"""Plain integration in time, period after period, until the state is periodic."""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import Contact, StepFailure, energy_norm
from microslip.contact.path import Path
from microslip.periodic.method import Method
from microslip.periodic.run import Budget, Effort
from microslip.periodic.search import Goal, PeriodicState

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two successive changes used in an extrapolation.  Rounding errors can make the
ratio 1."""


def plain_march(
    contact: Contact,
    path: Path,
    start: np.ndarray,
    goal: Goal,
    *,
    mirror: bool = True,
    budget: Budget | None = None,
) -> PeriodicState:
    """Find the periodic state by plain marches over (half) periods.

    The distance is estimated as in the shipped search, except for one difference.  The remaining
    changes of the state are extrapolated as a geometric series.  The ratio of the series is the
    ratio of the last two changes.
    """
    state, march, last, distance, iterations = start, None, np.nan, np.inf, 0
    for marches in range(1, goal.most_marches + 1):
        march = contact.march(path, state, goal.step_tolerance, march)
        iterations += march.iterations
        if budget is not None:
            budget.take(march.solves, march.iterations, state.size)
        image = contact.mirrored(march.state) if mirror else march.state
        residual = energy_norm(contact, image - state)
        if not np.isfinite(residual):
            raise StepFailure("diverged: tractions are not finite")
        if marches > 1:
            ratio = min(residual / last, SLOWEST) if last > 0.0 else 0.0
            mean = float(path.weights @ march.forces[:, 0])
            distance = max(residual / (1.0 - ratio), goal.drift_error(mean, residual))
        if distance <= goal.tolerance or marches == goal.most_marches:
            break
        state, last = image, residual
    assert march is not None  # there is at least one march
    effort = Effort.of(marches * march.solves, iterations, state.size)
    converged = distance <= goal.tolerance
    return PeriodicState(march, state, residual, distance, marches, effort, converged)


METHOD = Method("plain march to the periodic state", search=plain_march, prepared=False)
