"""Searches for the periodic state that people write first, on a period_map.Cycle.

All return a period_map.PeriodicState.
"""

from __future__ import annotations

import numpy as np

from microslip.solver import anderson
from microslip.solver.anderson import DEPTH, Anderson
from microslip.solver.period_map import Cycle, PeriodicState

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two changes that is believed: rounding alone makes it 1."""


def accelerated(
    cycle: Cycle,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_laps: int,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """Anderson acceleration, whether or not marches give a derivative.

    Newton's method has nothing to invert where the map keeps what rings in it for ever.
    """
    return anderson.search(cycle, start, tolerance, step_tolerance, most_laps)


def march(
    cycle: Cycle,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_laps: int,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """March on until the plain map stands still, as strictly as the shipped search judges it.

    What is left is the geometric tail of the changes, in the ratio of the last two.
    """
    state, last, distance = start, None, float("inf")
    for _ in range(most_laps):
        lap = cycle(state, step_tolerance)
        if last is not None:
            ratio = min(lap.residual / last, SLOWEST) if last > 0.0 else 0.0
            distance = max(lap.residual / (1.0 - ratio), cycle.distance(lap, lap.image))
        if distance <= tolerance:
            break
        state, last = lap.image, lap.residual
    return cycle.result(lap, distance, distance <= tolerance)


def equal_means(
    cycle: Cycle,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_laps: int,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """March on until the mean force of two half periods is the same to the tolerance."""
    state, last = start, float("inf")
    for _ in range(most_laps):
        lap = cycle(state, step_tolerance)
        mean = cycle.path.mean(lap.march.forces)[0]
        change = abs(mean - last)
        if change <= tolerance:
            break
        state, last = lap.image, mean
    return cycle.result(lap, change, change <= tolerance)


def residual_alone(
    cycle: Cycle,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_laps: int,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """Anderson acceleration, believed as soon as the plain map changes less than the tolerance."""
    accelerate, state = Anderson(cycle.contact, DEPTH), start
    for _ in range(most_laps):
        lap = cycle(state, step_tolerance)
        if lap.residual <= tolerance:
            break
        state = cycle.admissible(accelerate(state, lap.image))
    return cycle.result(lap, lap.residual, lap.residual <= tolerance)
