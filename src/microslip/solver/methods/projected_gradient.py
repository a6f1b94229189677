"""Projected gradient with a fixed step, stable below twice the inverse of the largest eigenvalue.

A stable step converges slowly, since the compliance of smooth tractions is far larger than that of
rough ones.
"""

from __future__ import annotations

import numpy as np

from microslip.solver.method import Method
from microslip.solver.methods._dense import dense, descend, safe_length
from microslip.solver.methods._searches import accelerated


def _lengths(matrix: np.ndarray, scale: np.ndarray, step: float) -> np.ndarray:
    """Step of every point; step: in units of the inverse of the largest eigenvalue."""
    return np.full_like(scale, step * safe_length(matrix))


METHOD = Method(
    "projected gradient, fixed step",
    dress=dense(descend, _lengths),
    search=accelerated,
    parameters={"step": 1.0},
)
