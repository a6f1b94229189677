"""Newton's method for the fixed point of a period, where a march gives its own derivative.

A derivative costs more than a march, so it is taken once and kept up to date by Broyden's method,
until a correction is no longer much smaller than the one before.  The plain map F does not expand
distances in the energy norm.  Hence its residual falls, or at least does not grow, from a state to
its image, and x - F(x) is monotone, so that damped corrections (damping + 1 - F') dx = F(x) - x are
the more cautious, the larger the damping.  A correction counts only if the residual falls; else it
is damped, and if that does not help the search goes on from the image.
"""

from __future__ import annotations

import numpy as np

from microslip.models.contact import StepFailure
from microslip.solver.period_map import Goal, MarchInterval, PeriodicState, PeriodMap

NEUTRAL = 1e-10
"""Damping of every correction: keeps directions in which nothing ever slips where they are."""
FIRST_DAMPING, DAMPING_FACTOR = 1e-2, 10.0
MOST_DAMPINGS = 6
SLOW = 0.5
"""A correction larger than this share of the last one asks for a new derivative."""
SKEWED = 1e-3
"""Broyden updates that divide by less than this share of a move's square are left out."""


def search(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Find the fixed point of a map by Newton's method.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map, of a contact whose marches give derivatives.
    start : np.ndarray
        Tractions.
    goal : period_map.Goal
        What to reach; without an inverse the first march gives its derivative.

    Returns
    -------
    period_map.PeriodicState
        The last state that was no worse than the one before.
    """
    corrector = Corrector(period_map, start, goal.inverse)
    state, derivative = start, goal.inverse is None
    best, found, last_step, rejected = None, None, np.inf, 0
    while period_map.marches < goal.most_marches:
        interval = period_map(state, goal.step_tolerance, derivative)
        if best is not None and not interval.residual <= best.residual:
            rejected += 1
            derivative = True
            if best.march.sensitivity is not None and rejected <= MOST_DAMPINGS:
                corrector.damp()
                state = corrector(best)
            else:
                state, best, last_step = best.image, None, np.inf
                corrector.damping = 0.0
            continue
        rejected = 0
        corrector.learn(interval, best)
        state = corrector(interval)
        distance = period_map.distance(interval, state)
        converged = distance <= goal.tolerance and not corrector.damping
        found = period_map.result(interval, distance, converged, corrector.inverse)
        if converged:
            break
        derivative = corrector.damping > 0.0 or corrector.step > SLOW * last_step
        best, last_step = interval, corrector.step
    return found


class Corrector:
    """Next states from march intervals, by the inverse of damping + 1 - F' (F: the mirrored march).

    step: size of the last correction before it was projected, in the metric of Broyden's updates.
    """

    def __init__(self, period_map: PeriodMap, state: np.ndarray, inverse: np.ndarray | None = None):
        self.period_map, self.inverse = period_map, inverse
        contact = period_map.contact
        self.damping, self.step = 0.0, np.inf
        self._signs = period_map.image(np.ones_like(state)).reshape(-1, 1)  # points stay in place
        self._metric = np.broadcast_to(contact.weight * contact.compliance, state.shape).ravel()
        self._system = None

    def __call__(self, interval):
        """The corrected state of an interval."""
        correction = self.inverse @ interval.change.ravel()
        self.step = float(np.sqrt(self._metric @ correction**2))
        return self.period_map.admissible(interval.state + correction.reshape(interval.state.shape))

    def learn(self, interval: MarchInterval, before: MarchInterval | None) -> None:
        """Take the derivative from an interval that has one, else update it from the one before."""
        if interval.march.sensitivity is not None:
            self._system = -self._signs * interval.march.sensitivity
            self.damping /= DAMPING_FACTOR
            if self.damping < FIRST_DAMPING:
                self.damping = 0.0
            self._invert()
        elif before is not None:
            self._update(
                (interval.state - before.state).ravel(), (before.change - interval.change).ravel()
            )

    def damp(self) -> None:
        """Damp corrections by the last derivative more than before."""
        self.damping = max(DAMPING_FACTOR * self.damping, FIRST_DAMPING)
        self._invert()

    def _invert(self):
        damped = self._system.copy()
        damped.flat[:: len(damped) + 1] += 1.0 + max(self.damping, NEUTRAL)
        try:
            self.inverse = np.linalg.inv(damped)
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"diverged: {error}") from error

    def _update(self, moved, changed):
        """Broyden's update: the inverse turns `changed` into `moved` from now on."""
        predicted = self.inverse @ changed
        weighted = self._metric * moved
        share = weighted @ predicted
        if abs(share) > SKEWED * (weighted @ moved):
            self.inverse = self.inverse + np.outer(
                (moved - predicted) / share, weighted @ self.inverse
            )
