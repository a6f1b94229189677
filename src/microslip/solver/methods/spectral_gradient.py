"""Projected gradient method with Barzilai-Borwein steps on the dense matrix.

The squares model also uses this step solver.  The step length is the inverse curvature along the
previous step.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.solver.method import Method
from microslip.solver.methods._dense import (
    Points,
    Stage,
    dense,
    judge,
    project_in_place,
    safe_length,
)
from microslip.solver.methods._searches import accelerated

MAX_ITERATIONS = 2000
PATIENCE = 60
"""Number of iterations within which long steps must halve the residual.  Otherwise the steps become
short."""


def _shortest(matrix: np.ndarray, scale: np.ndarray) -> float:
    return safe_length(matrix)


@kernel
def _solve(points: Points, stage: Stage, shortest: float) -> tuple[int, float]:
    b, q, slip, tolerance = stage
    bound, weight = points.bound, points.weight
    residual = judge(points, b, q, slip)
    length, best, best_at = shortest, residual, 0
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        step, changed = -q, slip.copy()
        q += length * slip
        project_in_place(q, bound)
        residual = judge(points, b, q, slip)
        step += q
        changed -= slip
        share = (weight * step * changed).sum()
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration - best_at > PATIENCE or not share > 0.0:
            length = shortest
        else:
            length = (weight * step * step).sum() / share
    return MAX_ITERATIONS, residual


METHOD = Method(
    "projected gradient, Barzilai-Borwein steps",
    dress=dense(_solve, _shortest),
    search=accelerated,
)
