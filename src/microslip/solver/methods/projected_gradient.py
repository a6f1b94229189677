"""Projected gradient with a fixed step: safe up to twice the reciprocal of the largest eigenvalue.

Short enough to be safe it is slow, since smooth tractions yield far more than rough ones.
"""

from __future__ import annotations

import numpy as np

from microslip.solver.method import Method
from microslip.solver.methods._dense import dense, descend, safe_length
from microslip.solver.methods._searches import accelerated


def _lengths(matrix: np.ndarray, scale: np.ndarray, step: float) -> np.ndarray:
    """`step` in units of the reciprocal of the largest eigenvalue, for every point."""
    return np.full_like(scale, step * safe_length(matrix))


METHOD = Method(
    "projected gradient, fixed step",
    dress=dense(descend, _lengths),
    search=accelerated,
    parameters={"step": 1.0},
)
