"""Semismooth Newton method for q = P(q + slip / scale), with full steps.

It converges in a few steps near the solution.  Further away, points can switch between stick and
slip forever.  The switching starts at points with a very small bound.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.solver.method import Method
from microslip.solver.methods._dense import Points, Stage, dense, judge, project_in_place

MAX_ITERATIONS = 60


@kernel
def _copy(out: np.ndarray, values: np.ndarray) -> None:
    """Copy `values` to `out`, both of shape (2, K).  Array assignments take seconds to compile."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] = values[c, i]


@kernel
def _solve(points: Points, stage: Stage, settings: float) -> tuple[int, float]:
    b, q, slip, tolerance = stage
    matrix, scale, bound = points.matrix, points.scale, points.bound
    n = q.shape[1]
    system, right = np.empty_like(matrix), np.empty(2 * n)
    trial, trial_slip = q.copy(), np.empty_like(q)
    residual = judge(points, b, trial, trial_slip)
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            _copy(q, trial)
            _copy(slip, trial_slip)
            return iteration, residual
        for i in range(n):
            x = trial[0, i] + trial_slip[0, i] / scale[i]
            y = trial[1, i] + trial_slip[1, i] / scale[i]
            size = np.sqrt(x * x + y * y)
            if size <= bound[i]:  # sticks: no slip
                for c in range(2):
                    for j in range(2 * n):
                        system[c * n + i, j] = matrix[c * n + i, j]
                    right[c * n + i] = b[c, i]
                continue
            # slips: dq = D (dq + dslip / scale), D the derivative of the projection
            x, y, f = x / size, y / size, bound[i] / size
            d = ((f * y * y, -f * x * y), (-f * x * y, f * x * x))
            ends = (bound[i] * x, bound[i] * y)
            for c in range(2):
                row = c * n + i
                for j in range(2 * n):
                    system[row, j] = d[c][0] * matrix[i, j] + d[c][1] * matrix[n + i, j]
                    system[row, j] /= scale[i]
                system[row, i] -= d[c][0]
                system[row, n + i] -= d[c][1]
                system[row, row] += 1.0
                right[row] = ends[c] - d[c][0] * trial[0, i] - d[c][1] * trial[1, i]
                right[row] += (d[c][0] * (b[0, i] - trial_slip[0, i])) / scale[i]
                right[row] += (d[c][1] * (b[1, i] - trial_slip[1, i])) / scale[i]
        trial = np.linalg.solve(system, right).reshape((2, n))
        residual = judge(points, b, trial, trial_slip)
    project_in_place(trial, bound)
    _copy(q, trial)
    return MAX_ITERATIONS, judge(points, b, q, slip)


METHOD = Method("semismooth Newton, full steps", dress=dense(_solve))
