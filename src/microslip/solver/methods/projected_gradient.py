"""Projected gradient method with a fixed step.

It is stable for steps below twice the inverse of the largest eigenvalue.  With a stable step, it
converges slowly, since the compliance is far larger for smooth tractions than for rough ones.
"""

from __future__ import annotations

import numpy as np

from microslip.solver.method import Method
from microslip.solver.methods._dense import dense, descend, safe_length


def _lengths(matrix: np.ndarray, scale: np.ndarray, step: float) -> np.ndarray:
    """Step length of every point; `step` is in units of the inverse of the largest eigenvalue."""
    return np.full_like(scale, step * safe_length(matrix))


METHOD = Method(
    "projected gradient, fixed step",
    dress=dense(descend, _lengths),
    parameters={"step": 1.0},
)
