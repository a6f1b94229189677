"""Coulomb's law at points: projection on the friction disc, and the residual of a Coulomb step.

The unknowns of a Coulomb step are tractions q with |q| <= g.  The slip is s = b - A q, where A is
the influence operator and b is the displacement imposed by the rigid motion and the history.  Slip
occurs only where |q| = g, in the direction of q.  This is the optimality condition of a convex
problem, and is equivalent to the fixed point

    q = P_g(q + s / d) for any d > 0; P_g projects onto the disc |q| <= g.

All quantities are dimensionless.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel


@kernel(inline="always")
def shrink(forward: float, lateral: float, bound: float) -> float:
    """Factor between 0 and 1 that projects the traction (forward, lateral) onto the disc |q| <=
    bound."""
    size = np.sqrt(forward * forward + lateral * lateral)
    # without a branch, so that the compiler can vectorise it
    return min(1.0, bound / max(size, 1e-300))


def project(q: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Project tractions q (2, ...) onto |q| <= bound; bound broadcasts to the shape of q[0]."""
    return q * np.minimum(1.0, bound / np.maximum(np.hypot(q[0], q[1]), 1e-300))


def coulomb_residual(
    q: np.ndarray, slip: np.ndarray, bound: np.ndarray, weight: np.ndarray, scale: np.ndarray
) -> float:
    """Residual of Coulomb's law, Sum weight |P_g(q + slip/scale) - q|, as a force divided by mu
    F_z.

    Parameters
    ----------
    q, slip : np.ndarray, shape (2, ...)
        Forward and lateral components of tractions and slip.
    bound, weight, scale : np.ndarray
        Friction bound, area of a point, and diagonal of the influence operator; they broadcast to
        the shape of q[0].
    """
    change = project(q + slip / scale, bound) - q
    return float(np.sum(weight * np.hypot(change[0], change[1])))
