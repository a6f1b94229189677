"""Anderson acceleration for the fixed point of a period, where marches give no derivative.

The start should have too much forward traction rather than too little: from there the mean
tractions relax towards the periodic ones without losing slip on the way, which is what keeps an
accelerated map from settling where nothing moves.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from microslip.models.contact import StepFailure
from microslip.solver.period_map import Goal, PeriodicState, PeriodMap

FORCING = 1e-3
LOOSEST = 1e-4
"""While the state is still far from periodic, steps are solved to this share of what the last
period changed, and to LOOSEST at first: more would be wasted on a start that is about to change."""
DEPTH = 12
NOISE = 0.1
"""Share of a period's change that its steps may leave unsolved."""
LOOSEST_NEAR, QUIET = 1e-5, 0.25
"""For a start near the periodic state: loosest tolerance of a step, and share of NOISE allowed to
the steps of the next march.  With many steps each must be solved better, or the march is wasted."""
FORGETFUL = 0.2
"""Contraction of the plain map from the start on below which it is left alone."""


def search(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Find the fixed point of a map by Anderson acceleration.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map.
    start : np.ndarray
        Tractions.
    goal : period_map.Goal
        What to reach.

    Returns
    -------
    period_map.PeriodicState
        The best state seen, if none is good enough.
    """
    accelerate, step_tolerance = Anderson(period_map.metric, DEPTH), goal.step_tolerance
    state, best = start, None
    forcing, loosest = FORCING, LOOSEST
    if goal.near:
        forcing = min(FORCING, QUIET * NOISE / len(period_map.path.stages))
        loosest = LOOSEST_NEAR
    inner = max(step_tolerance, loosest)
    forgets, last_residual = True, np.inf
    while period_map.marches < goal.most_marches:
        interval = period_map(state, inner)
        solved = inner <= step_tolerance
        noisy = not solved and interval.march.residual > NOISE * interval.residual
        ceiling = NOISE * inner if noisy else loosest
        inner = max(step_tolerance, min(forcing * interval.residual, ceiling))
        if noisy:
            continue  # what is left of the steps hides what the period changed
        forgets = forgets and interval.residual <= FORGETFUL * last_residual
        last_residual = interval.residual
        proposal = accelerate(state, interval.image)
        if forgets:
            proposal = interval.image
        state = period_map.admissible(proposal)
        distance = period_map.distance(interval, state)
        converged = solved and distance <= goal.tolerance
        if best is None or distance < best.distance or converged:
            best = period_map.result(interval, distance, converged)
        if converged:
            break
    return best or period_map.result(interval, interval.residual, False)


class Anderson:
    """Anderson acceleration of a fixed-point map on tractions, least squares in a force metric."""

    def __init__(self, metric: np.ndarray, depth: int):
        self.scale = np.sqrt(metric)
        self.depth = depth
        self.images: list[np.ndarray] = []
        self.changes: list[np.ndarray] = []

    def __call__(self, state: np.ndarray, image: np.ndarray) -> np.ndarray:
        """Next state from the pairs (state, image) seen so far."""
        self.images.append(image)
        self.changes.append(image - state)
        if len(self.changes) > self.depth + 1:
            self.images.pop(0)
            self.changes.pop(0)
        if len(self.changes) == 1:
            return image
        scaled = [(change * self.scale).ravel() for change in self.changes]
        differences = np.stack([b - a for a, b in pairwise(scaled)], axis=1)
        try:
            weights = np.linalg.lstsq(differences, scaled[-1], rcond=1e-9)[0]
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"diverged: {error}") from error
        moves = [b - a for a, b in pairwise(self.images)]
        return image - sum(w * move for w, move in zip(weights, moves, strict=True))
