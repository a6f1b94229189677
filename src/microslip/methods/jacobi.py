"""Every point corrects its own slip as if it were alone, all at once and undamped.

Neighbours answer to the same slip together and overshoot: the matrix of a contact is far from
diagonal.
"""

from __future__ import annotations

from numba import njit

from microslip.friction import JIT
from microslip.method import Method
from microslip.methods._dense import DenseContact, judge, project_in_place

MAX_ITERATIONS = 1000


def _settings(matrix, scale, damping):
    return damping


@njit(**JIT)
def _solve(matrix, scale, bound, weight, b, q, slip, tolerance, damping):
    residual = judge(matrix, scale, bound, weight, b, q, slip)
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        q += damping * slip / scale
        project_in_place(q, bound)
        residual = judge(matrix, scale, bound, weight, b, q, slip)
    return MAX_ITERATIONS, residual


def _dress(contact, damping):
    return DenseContact(contact, _solve, _settings, damping=damping)


METHOD = Method("projected Jacobi, undamped", dress=_dress, parameters={"damping": 1.0})
