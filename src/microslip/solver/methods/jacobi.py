"""Projected Jacobi iteration: every point removes its own slip, independently and undamped.

Neighbouring points overshoot together, since the matrix of a contact is far from diagonal.
"""

from __future__ import annotations

import numpy as np

from microslip.solver.method import Method
from microslip.solver.methods._dense import dense, descend
from microslip.solver.methods._searches import accelerated


def _lengths(matrix: np.ndarray, scale: np.ndarray, damping: float) -> np.ndarray:
    """Step length of every point: `damping` times the length that removes the point's slip."""
    return damping / scale


METHOD = Method(
    "projected Jacobi, undamped",
    dress=dense(descend, _lengths),
    search=accelerated,
    parameters={"damping": 1.0},
)
