"""Spectral projected gradient method for the Coulomb steps of contacts without a cheap resolvent
(squares).

The unknowns are tractions q with |q| <= g.  The slip b - A q occurs only where |q| = g, in the
direction of q.

Gradient steps have Barzilai-Borwein lengths without a line search, because rounding errors of the
energy are much larger than those of the tractions.  If the residual does not decrease for a number
of iterations, shorter steps that always lower the energy are used until the residual decreases.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.convolution import Convolution, convolve
from microslip.contact.coulomb import shrink
from microslip.contact.splitting import BETWEEN_LOOKS, interrupted
from microslip.foundation.compiled import kernel

MOST_ITERATIONS = 5000
"""Largest number of iterations of a step."""
PATIENCE = 60
"""Number of iterations in which Barzilai-Borwein steps must halve the residual, calibrated by
benchmarks/splitting.py."""
SHORT_STEP_BELOW = 0.3
"""Ratio of the two Barzilai-Borwein lengths below which the shorter one is used; usual values are
0.1 to 0.5 (Zhou, Gao and Dai 2006)."""


@kernel
def descend(
    convolution: Convolution,
    cell: tuple[float, float, float],
    fields: tuple,
    scratch: tuple,
    control: tuple[float, float, int],
) -> tuple[int, float, float]:
    """Solve a Coulomb step on equal cells.

    Parameters
    ----------
    convolution : Convolution
        The operator A.
    cell : tuple of float
        Area of a cell, displacement of a cell under a unit traction on the same cell, and upper
        bound on the eigenvalues of A.
    fields : tuple of np.ndarray, shapes (rows, columns) and (2, rows, columns)
        Friction bound; imposed displacement b; tractions, which are the initial guess on entry and
        within the bound on return; slip, which is filled.
    scratch : tuple of np.ndarray
        Arrays of convolution.workspace, and an array of shape (4, rows, columns).
    control : tuple
        Length of the first gradient step; largest allowed residual, as a force divided by mu F_z;
        patience, see PATIENCE.

    Returns
    -------
    iterations : int
        Number of iterations; -1 after an interrupt.
    residual, length : float
        Residual of coulomb.coulomb_residual, and length of the last gradient step.
    """
    weight, scale, largest = cell
    bound, b, q, slip = fields
    length, tolerance, patience = control
    room, values = scratch
    trial, elastic = values[:2], values[2:]
    rows, columns = bound.shape
    sums = np.empty((3, columns))  # one for each column, so that the compiler can vectorise
    for i in range(rows):
        for j in range(columns):
            f = shrink(q[0, i, j], q[1, i, j], bound[i, j])
            trial[0, i, j], trial[1, i, j] = f * q[0, i, j], f * q[1, i, j]
            q[0, i, j], q[1, i, j] = trial[0, i, j], trial[1, i, j]
    between = int(BETWEEN_LOOKS / (rows * columns)) + 1
    best, best_at, residual = np.inf, 0, np.inf
    for iteration in range(MOST_ITERATIONS):
        convolve(convolution, room, trial, elastic)
        sums[:] = 0.0
        for c in range(2):
            for i in range(rows):
                for j in range(columns):
                    dq = trial[c, i, j] - q[c, i, j]
                    now = b[c, i, j] - elastic[c, i, j]
                    ds = slip[c, i, j] - now if bound[i, j] > 0.0 else 0.0
                    sums[0, j] += dq * dq
                    sums[1, j] += dq * ds
                    sums[2, j] += ds * ds
                    q[c, i, j], slip[c, i, j] = trial[c, i, j], now
        dd, ds, ss = sums[0].sum(), sums[1].sum(), sums[2].sum()
        if iteration > 0:
            if iteration - best_at > patience or not ds > 0.0:
                length = 1.0 / largest
            elif ds * ds < SHORT_STEP_BELOW * dd * ss:
                length = ds / ss
            else:
                length = dd / ds
        sums[0] = 0.0
        for i in range(rows):
            for j in range(columns):
                forward, lateral = (
                    q[0, i, j] + length * slip[0, i, j],
                    q[1, i, j] + length * slip[1, i, j],
                )
                f = shrink(forward, lateral, bound[i, j])
                trial[0, i, j], trial[1, i, j] = f * forward, f * lateral
                forward, lateral = (
                    q[0, i, j] + slip[0, i, j] / scale,
                    q[1, i, j] + slip[1, i, j] / scale,
                )
                f = shrink(forward, lateral, bound[i, j])
                forward, lateral = f * forward - q[0, i, j], f * lateral - q[1, i, j]
                sums[0, j] += np.sqrt(forward * forward + lateral * lateral)
        residual = weight * sums[0].sum()
        if residual <= tolerance:
            return iteration, residual, length
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration % between == between - 1 and interrupted():
            return -1, residual, length
    return MOST_ITERATIONS, residual, length
