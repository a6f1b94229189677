"""Fixed-point stick/slip switching: updates of the points alternate with linear solves.

The traction of a slipping point is on the bound, in the direction of its last slip; sticking points
do not slip.  After the solve, a point slips if its traction is above the bound.  A slipping point
sticks if its slip opposes its traction.  Convergence is not guaranteed, because points can
alternate between stick and slip.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.solver.method import Method
from microslip.solver.methods._dense import Points, Stage, dense, judge
from microslip.solver.methods._searches import accelerated

MAX_ITERATIONS = 200


@kernel
def _solve(points: Points, stage: Stage, settings: float) -> tuple[int, float]:
    b, q, slip, tolerance = stage
    matrix, bound = points.matrix, points.bound
    n = q.shape[1]
    residual = judge(points, b, q, slip)
    sticks = np.zeros(n, np.bool_)
    for i in range(n):
        sticks[i] = q[0, i] ** 2 + q[1, i] ** 2 < (bound[i] * (1.0 - 1e-12)) ** 2
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        # slipping tractions point along the slip; a point without slip keeps its direction
        for i in range(n):
            if sticks[i]:
                continue
            x, y = slip[0, i], slip[1, i]
            if x * q[0, i] + y * q[1, i] <= 0.0:
                x, y = q[0, i], q[1, i]
            size = np.sqrt(x * x + y * y)
            if size > 0.0:
                q[0, i], q[1, i] = bound[i] * x / size, bound[i] * y / size
        indices = np.flatnonzero(sticks)
        both = np.concatenate((indices, indices + n))
        if len(both) > 0:
            flat = q.copy().ravel()
            flat[both] = 0.0
            right = b.copy().ravel() - matrix @ flat
            inner = matrix[both][:, both]
            flat[both] = np.linalg.solve(inner, right[both])
            q[:] = flat.reshape(q.shape)
        residual = judge(points, b, q, slip)
        for i in range(n):
            if sticks[i]:
                size = np.sqrt(q[0, i] ** 2 + q[1, i] ** 2)
                if size > bound[i]:
                    sticks[i] = False
                    slip[0, i], slip[1, i] = q[0, i], q[1, i]  # the direction of its traction
            elif slip[0, i] * q[0, i] + slip[1, i] * q[1, i] < 0.0:
                sticks[i] = True
    return MAX_ITERATIONS, residual


METHOD = Method("fixed-point stick/slip switching", dress=dense(_solve), search=accelerated)
