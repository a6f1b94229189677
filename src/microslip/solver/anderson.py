"""Anderson acceleration for the fixed point of a period, where marches give no derivative.

The start should have too much forward traction rather than too little: from there the mean
tractions relax towards the periodic ones without losing slip on the way, which is what keeps an
accelerated map from settling where nothing moves.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from microslip.solver.period_map import Cycle, PeriodicState

FORCING = 1e-3
LOOSEST = 1e-4
"""While the state is still far from periodic, steps are solved to this share of what the last
period changed, and to LOOSEST at first: more would be wasted on a start that is about to change."""
DEPTH = 12
NOISE = 0.1
"""Share of a period's change that its steps may leave unsolved."""
FORGETFUL = 0.2
"""Contraction of the plain map from the start on below which it is left alone."""


def search(
    cycle: Cycle, start: np.ndarray, tolerance: float, step_tolerance: float, most_laps: int
) -> PeriodicState:
    """Find the fixed point of a map by Anderson acceleration.

    Parameters
    ----------
    cycle : period_map.Cycle
        The map.
    start : np.ndarray
        Tractions.
    tolerance, step_tolerance : float
        Of the state and of a step, forces over mu F_z.
    most_laps : int
        Marches to try.

    Returns
    -------
    period_map.PeriodicState
        The best state seen, if none is good enough.
    """
    accelerate = Anderson(cycle.contact, DEPTH)
    state, best = start, None
    inner = max(step_tolerance, LOOSEST)
    forgets, last_residual = True, np.inf
    while cycle.laps < most_laps:
        lap = cycle(state, inner)
        solved = inner <= step_tolerance
        noisy = not solved and lap.march.residual > NOISE * lap.residual
        ceiling = NOISE * inner if noisy else LOOSEST
        inner = max(step_tolerance, min(FORCING * lap.residual, ceiling))
        if noisy:
            continue  # what is left of the steps hides what the period changed
        forgets = forgets and lap.residual <= FORGETFUL * last_residual
        last_residual = lap.residual
        proposal = accelerate(state, lap.image)
        if forgets:
            proposal = lap.image
        state = cycle.admissible(proposal)
        distance = cycle.distance(lap, state)
        converged = solved and distance <= tolerance
        if best is None or distance < best.distance or converged:
            best = cycle.result(lap, distance, converged)
        if converged:
            break
    return best or cycle.result(lap, lap.residual, False)


class Anderson:
    """Anderson acceleration of a fixed-point map on tractions, least squares in a force metric."""

    def __init__(self, contact, depth):
        self.scale = np.sqrt(contact.weight * contact.compliance)
        self.depth = depth
        self.images, self.changes = [], []

    def __call__(self, state, image):
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
        weights = np.linalg.lstsq(differences, scaled[-1], rcond=1e-9)[0]
        moves = [b - a for a, b in pairwise(self.images)]
        return image - sum(w * move for w, move in zip(weights, moves, strict=True))
