"""Every point corrects its own slip as if it were alone, all at once and undamped.

Neighbours answer to the same slip together and overshoot: the matrix of a contact is far from
diagonal.
"""

from __future__ import annotations

import numpy as np

from microslip.solver.method import Method
from microslip.solver.methods._dense import dense, descend
from microslip.solver.methods._searches import accelerated


def _lengths(matrix: np.ndarray, scale: np.ndarray, damping: float) -> np.ndarray:
    """Length of the step that would remove the slip of a single point, times the damping."""
    return damping / scale


METHOD = Method(
    "projected Jacobi, undamped",
    dress=dense(descend, _lengths),
    search=accelerated,
    parameters={"damping": 1.0},
)
