"""The Coulomb step at a point: projection on the friction disc and what is left to be solved.

One time step asks for tractions q with slip s = b - A q (b: the displacement that the rigid motion
and the history impose, A: the influence operator) such that |q| <= g everywhere, slip occurs only
where |q| = g, and there q is parallel to s and along it.  That is the optimality condition of a
convex problem, so "q is a fixed point of the projected step" says all of it:

    q = P_g(q + s / d)      for any d > 0;  P_g projects on the disc |q| <= g.

Kernels on floats and flat arrays, dimensionless; no knowledge of grids, motion or time.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel


@kernel(inline="always")
def shrink(forward: float, lateral: float, bound: float) -> float:
    """Factor in 0..1 that brings the traction (forward, lateral) onto the disc |q| <= bound."""
    size = np.sqrt(forward * forward + lateral * lateral)
    return min(1.0, bound / max(size, 1e-300))  # no branch: the compiler can vectorise it


@kernel(inline="always")
def extended(start: float, stage: float, end: float) -> float:
    """Value at the end of a step, given that at its start and that at its share `end`."""
    return stage if end == 1.0 else start + (stage - start) / end


@kernel
def coulomb_residual(
    q: np.ndarray, slip: np.ndarray, bound: np.ndarray, weight: np.ndarray, scale: np.ndarray
) -> float:
    """How far tractions are from Coulomb's law, as a force over mu F_z.

    q, slip: forward and lateral components, shape (2, n, m); bound, weight (area of a point) and
    scale (the diagonal of the influence operator): shape (m,), the same for every n.  Returns
    Sum weight |P_g(q + slip/scale) - q|, zero exactly for a solution.
    """
    rows = np.zeros(q.shape[2])  # summed ring by ring, which the compiler can vectorise
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward = q[0, j, i] + slip[0, j, i] / scale[i]
            lateral = q[1, j, i] + slip[1, j, i] / scale[i]
            f = shrink(forward, lateral, bound[i])
            forward = forward * f - q[0, j, i]
            lateral = lateral * f - q[1, j, i]
            rows[i] += weight[i] * np.sqrt(forward * forward + lateral * lateral)
    return rows.sum()


def project(q: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Tractions shrunk onto |q| <= bound; q has shape (2, ...), bound broadcasts to q[0]."""
    size = np.hypot(q[0], q[1])
    return q * np.where(size > bound, bound / np.maximum(size, 1e-300), 1.0)
