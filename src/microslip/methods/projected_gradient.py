"""Projected gradient with a fixed step: safe up to twice the reciprocal of the largest eigenvalue.

Short enough to be safe it is slow, since smooth tractions yield far more than rough ones.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from microslip.friction import JIT
from microslip.method import Method
from microslip.methods._dense import DenseContact, judge, project_in_place

MAX_ITERATIONS = 3000


def _step_length(matrix, scale, step):
    """``step`` in units of the reciprocal of the largest eigenvalue."""
    return step / np.abs(np.linalg.eigvals(matrix)).max()


@njit(**JIT)
def _solve(matrix, scale, bound, weight, b, q, slip, tolerance, length):
    residual = judge(matrix, scale, bound, weight, b, q, slip)
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        q += length * slip
        project_in_place(q, bound)
        residual = judge(matrix, scale, bound, weight, b, q, slip)
    return MAX_ITERATIONS, residual


def _dress(contact, step):
    return DenseContact(contact, _solve, _step_length, step=step)


METHOD = Method("projected gradient, fixed step", dress=_dress, parameters={"step": 1.0})
