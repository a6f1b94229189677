"""Projected gradient method with a fixed step.

The method is stable for steps below twice the inverse of the largest eigenvalue.  With a stable
step, the method converges slowly, since the compliance is far larger for smooth tractions than for
rough ones.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import project
from microslip.periodic.method import Method
from microslip.periodic.methods._dense import Points, dense

MAX_ITERATIONS = 3000


def _length(points: Points, step: float) -> float:
    """Return the length of a gradient step.

    `step` is the length of the step times the largest eigenvalue of the matrix.
    """
    return step / float(np.abs(np.linalg.eigvals(points.matrix)).max())


def _solve(
    points: Points, b: np.ndarray, q: np.ndarray, tolerance: float, length: float
) -> tuple[np.ndarray, np.ndarray, int, float]:
    q, count = project(q, points.bound), 0
    slip, residual = points.judged(b, q)
    while residual > tolerance and count < MAX_ITERATIONS:
        q, count = project(q + length * slip, points.bound), count + 1
        slip, residual = points.judged(b, q)
    return q, slip, count, residual


METHOD = Method(
    "projected gradient, fixed step",
    dress=dense(_solve, _length),
    parameters={"step": 1.0},
)
