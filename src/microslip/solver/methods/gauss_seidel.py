"""Projected Gauss-Seidel iteration over the points.

Every update of a point lowers the energy, so the iteration converges for relaxation factors between
0 and 2.
"""

from __future__ import annotations

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.foundation.compiled import kernel
from microslip.solver.method import Method
from microslip.solver.methods._dense import Points, Stage, dense, judge
from microslip.solver.methods._searches import accelerated

MAX_ITERATIONS = 1000


def _columns(matrix: np.ndarray, scale: np.ndarray, relaxation: float) -> tuple[np.ndarray, float]:
    """The transposed matrix, for contiguous access to columns, and the relaxation factor."""
    return np.ascontiguousarray(matrix.T), relaxation


@kernel
def _solve(points: Points, stage: Stage, settings: tuple[np.ndarray, float]) -> tuple[int, float]:
    b, q, slip, tolerance = stage
    columns, relaxation = settings
    scale, bound = points.scale, points.bound
    n = q.shape[1]
    residual = judge(points, b, q, slip)
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        for i in range(n):
            x = q[0, i] + relaxation * slip[0, i] / scale[i]
            y = q[1, i] + relaxation * slip[1, i] / scale[i]
            f = shrink(x, y, bound[i])
            dx, dy = f * x - q[0, i], f * y - q[1, i]
            if dx != 0.0 or dy != 0.0:
                q[0, i] += dx
                q[1, i] += dy
                for c in range(2):
                    for j in range(n):
                        k = c * n + j
                        slip[c, j] -= columns[i, k] * dx + columns[n + i, k] * dy
        residual = judge(points, b, q, slip)
    return MAX_ITERATIONS, residual


METHOD = Method(
    "projected Gauss-Seidel",
    dress=dense(_solve, _columns),
    search=accelerated,
    parameters={"relaxation": 1.0},
)
