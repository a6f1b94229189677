"""Searches for the periodic state that people write first, on a period_map.PeriodMap.

All return a period_map.PeriodicState.
"""

from __future__ import annotations

import numpy as np

from microslip.solver import anderson
from microslip.solver.anderson import DEPTH, Anderson
from microslip.solver.period_map import Goal, PeriodicState, PeriodMap

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two changes that is believed: rounding alone makes it 1."""


def accelerated(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Anderson acceleration of marches that Python calls one by one."""
    return anderson.search(period_map, start, goal)


def march(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """March on until the plain map stands still, as strictly as the shipped search judges it.

    What is left is the geometric tail of the changes, in the ratio of the last two.
    """
    state, last, distance = start, None, float("inf")
    for _ in range(goal.most_marches):
        interval = period_map(state, goal.step_tolerance)
        if last is not None:
            ratio = min(interval.residual / last, SLOWEST) if last > 0.0 else 0.0
            distance = max(
                interval.residual / (1.0 - ratio), period_map.distance(interval, interval.image)
            )
        if distance <= goal.tolerance:
            break
        state, last = interval.image, interval.residual
    return period_map.result(interval, distance, distance <= goal.tolerance)


def equal_means(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """March on until the mean force of two half periods is the same to the tolerance."""
    state, last = start, float("inf")
    for _ in range(goal.most_marches):
        interval = period_map(state, goal.step_tolerance)
        mean = period_map.path.mean(interval.march.forces)[0]
        change = abs(mean - last)
        if change <= goal.tolerance:
            break
        state, last = interval.image, mean
    return period_map.result(interval, change, change <= goal.tolerance)


def residual_alone(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Anderson acceleration, believed as soon as the plain map changes less than the tolerance."""
    accelerate, state = Anderson(period_map.metric, DEPTH), start
    for _ in range(goal.most_marches):
        interval = period_map(state, goal.step_tolerance)
        if interval.residual <= goal.tolerance:
            break
        state = period_map.admissible(accelerate(state, interval.image))
    return period_map.result(interval, interval.residual, interval.residual <= goal.tolerance)
