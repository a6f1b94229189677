"""ADMM on the dense matrix: it alternates between a linear solve and a projection.

The matrix is factorised once.  The parameter `penalty` is in units of the self-influence of each
point; it changes only the rate of convergence.  The parameter `relaxation` is between 1 (no
relaxation) and 2.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.solver.method import Method
from microslip.solver.methods._dense import Points, Stage, dense, judge, project_in_place
from microslip.solver.methods._searches import accelerated

MAX_ITERATIONS = 2000


def _inverse(
    matrix: np.ndarray, scale: np.ndarray, penalty: float, relaxation: float
) -> tuple[np.ndarray, np.ndarray, float]:
    """(A + penalty)^-1, the penalty of every point, and the relaxation factor."""
    added = penalty * scale
    return np.linalg.inv(matrix + np.diag(np.tile(added, 2))), added, relaxation


@kernel
def _solve(
    points: Points, stage: Stage, settings: tuple[np.ndarray, np.ndarray, float]
) -> tuple[int, float]:
    b, q, slip, tolerance = stage
    inverse, penalty, relaxation = settings
    residual = judge(points, b, q, slip)
    dual = slip / penalty
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        free = (inverse @ (b + penalty * (q - dual)).ravel()).reshape(q.shape)
        dual += relaxation * free + (1.0 - relaxation) * q
        q[:] = dual
        project_in_place(q, points.bound)
        dual -= q
        residual = judge(points, b, q, slip)
    return MAX_ITERATIONS, residual


METHOD = Method(
    "ADMM on the dense matrix",
    dress=dense(_solve, _inverse),
    search=accelerated,
    parameters={"penalty": 1.0, "relaxation": 1.7},
)
