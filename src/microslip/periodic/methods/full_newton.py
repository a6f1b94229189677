"""Semismooth Newton method for q = P(q + slip / scale), with full steps.

The method converges in a few steps near the solution.  Far from the solution, points can switch
between stick and slip forever.  Points with a very small bound are the first to switch.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import project
from microslip.periodic.method import Method
from microslip.periodic.methods._dense import Points, dense

MAX_ITERATIONS = 60


def _solve(
    points: Points, b: np.ndarray, q: np.ndarray, tolerance: float, settings: None
) -> tuple[np.ndarray, np.ndarray, int, float]:
    matrix, count = points.matrix, 0
    slip, residual = points.judged(b, q)
    while residual > tolerance and count < MAX_ITERATIONS:
        target = q + slip / points.scale
        size = np.maximum(np.hypot(*target), 1e-300)
        # slipping points: dq = D (dq + dslip / scale), D the derivative of the projection
        across = np.stack([-target[1], target[0]]) / size
        derivative = points.bound / size * across[:, None] * across
        blocks = np.einsum("cdk,kl->cdkl", derivative, np.eye(len(size)))
        factor = np.moveaxis(blocks, 1, 2).reshape(matrix.shape)
        system = np.eye(len(matrix)) - factor + (factor / np.tile(points.scale, 2)) @ matrix
        known = np.einsum("cdk,dk->ck", derivative, (b - slip) / points.scale - q)
        right = project(target, points.bound) + known
        sticks = np.tile(size <= points.bound, 2)
        system[sticks], right = matrix[sticks], np.where(size <= points.bound, b, right)
        q, count = np.linalg.solve(system, right.ravel()).reshape(b.shape), count + 1
        slip, residual = points.judged(b, q)
    if not residual <= tolerance:
        q = project(q, points.bound)
        slip, residual = points.judged(b, q)
    return q, slip, count, residual


METHOD = Method("semismooth Newton, full steps", dress=dense(_solve))
