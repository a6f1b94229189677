"""The tangent problem of a Coulomb step on rings, factorised.

Everything is weighted with the ring areas: the stiff matrix B = diag(area) A is symmetric, and a
weighted displacement is a displacement times the ring's area.  Tractions and displacements are real
arrays (2, n), forward part first.

Where a ring sticks both components of its traction are unknown, where it slips only the angle is.
The sticking rings are eliminated first, and B acts on both components alike, so that nothing larger
than rings x rings is ever factorised:

    B = U^T U  over the sticking rings,  Schur complement C over the slipping ones,
    tangent matrix  M_ik = C_ik (d_i . d_k) + delta_ik |slip_i| / bound_i,   d_i: unit tangents.

A ring that has lost contact (bound 0) counts as slipping, its angle held where it is.

As slip starts at the edge, the sticking rings mostly are the innermost ones, and for these U is
part of the factor of B as a whole, which is computed once.  The products are loops of ours: BLAS
would spread matrices this small over threads, and lose time by it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel

ON_BOUND = 1.0 - 1e-12
"""Share of the bound from which on a traction counts as being on it."""
HELD = 1e30
"""Resistance of a traction to turning where the bound is 0: out of contact a ring slips freely."""


class RingSystem(NamedTuple):
    """The rings of a contact, for compiled code.

    Attributes
    ----------
    stiffness : np.ndarray, shape (n, n)
        B.
    whole : np.ndarray, shape (n, n)
        U of all rings in their order, see `cholesky`.
    weight : np.ndarray, shape (n,)
        Areas.
    """

    stiffness: np.ndarray
    whole: np.ndarray
    weight: np.ndarray


class Factors(NamedTuple):
    """Scratch of the step solver.

    Attributes
    ----------
    order : np.ndarray, shape (n,)
        Sticking rings, then slipping ones.
    count : np.ndarray, shape (2,)
        How many stick (-1: not known), and 1 if what the march derives from them is up to date.
    upper : np.ndarray, shape (n, n)
        U in this order, and C where both rings slip, with the reciprocals of the pivots on the
        diagonal of U.
    tangent : np.ndarray, shape (n, n)
        Cholesky factor of M, likewise.
    direction : np.ndarray, shape (2, n)
        Unit tangents of the slipping rings in this order.
    change, trial, trial_slip : np.ndarray, shape (2, n)
        Newton step in this order; tractions and slips tried.
    """

    order: np.ndarray
    count: np.ndarray
    upper: np.ndarray
    tangent: np.ndarray
    direction: np.ndarray
    change: np.ndarray
    trial: np.ndarray
    trial_slip: np.ndarray


@kernel
def make_factors(n: int) -> Factors:
    """Empty scratch for n rings."""
    return Factors(
        np.zeros(n, np.int64),
        np.full(2, -1),
        np.zeros((n, n)),
        np.zeros((n, n)),
        np.zeros((2, n)),
        np.zeros((2, n)),
        np.zeros((2, n)),
        np.zeros((2, n)),
    )


@kernel
def copy(out: np.ndarray, values: np.ndarray) -> None:
    """out[:] = values for shape (2, n): no shapes are compared, and so none of the compiler's time
    goes into words for those that differ."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] = values[c, i]


@kernel(inline="always")
def subtract(y: np.ndarray, factor: float, x: np.ndarray) -> None:
    """y -= factor x."""
    for k in range(len(y)):
        y[k] -= factor * x[k]


@kernel
def combine(y: np.ndarray, factors: np.ndarray, rows: np.ndarray, count: int) -> None:
    """y -= Sum over k < count of factors[k] rows[k], four rows at a time to spare memory."""
    columns = len(y)
    k = 0
    while k + 4 <= count:
        a, b, c, d = factors[k], factors[k + 1], factors[k + 2], factors[k + 3]
        u, v, w, x = rows[k], rows[k + 1], rows[k + 2], rows[k + 3]
        for j in range(columns):
            y[j] -= (a * u[j] + b * v[j]) + (c * w[j] + d * x[j])
        k += 4
    while k < count:
        a, u = factors[k], rows[k]
        for j in range(columns):
            y[j] -= a * u[j]
        k += 1


@kernel
def _eliminate(matrix, first, last, scratch):
    """Cholesky in place on the upper triangle; returns False if it breaks down.

    Rows before `first` are done already, pivots are those before `last`, and what is left
    beyond is the Schur complement.  Reciprocals of the pivots go on the diagonal.  scratch: (n,).
    """
    for j in range(first, len(matrix)):
        count = min(j, last)
        for k in range(count):
            scratch[k] = matrix[k, j]
        combine(matrix[j, j:], scratch, matrix[:, j:], count)
        if j < last:
            if not matrix[j, j] > 0.0:
                return False
            pivot = 1.0 / np.sqrt(matrix[j, j])
            matrix[j, j] = pivot
            for k in range(j + 1, len(matrix)):
                matrix[j, k] *= pivot
    return True


@kernel
def cholesky(stiffness: np.ndarray) -> np.ndarray:
    """Upper factor U of B = U^T U, reciprocals of its pivots on the diagonal, shape (n, n)."""
    upper = stiffness.copy()
    if not _eliminate(upper, 0, len(upper), np.empty(len(upper))):
        raise ValueError("the influence operator is not positive definite")
    return upper


@kernel(inline="always")
def turning(slip_forward: float, slip_lateral: float, bound: float) -> float:
    """|slip| / bound: how much a traction on the bound resists being turned away from its slip."""
    size = np.sqrt(slip_forward * slip_forward + slip_lateral * slip_lateral)
    return size / bound if bound > 0.0 else HELD


@kernel(inline="always")
def _slips(x, y, slip_forward, slip_lateral, bound):
    """Whether a ring with the traction (x, y) slips: on its bound, and dragged along its slip."""
    limit = bound * ON_BOUND
    along = x * slip_forward + y * slip_lateral
    return x * x + y * y >= limit * limit and (along > 0.0 or limit == 0.0)


@kernel
def _split(q, slip, bound, factors):
    """Put sticking rings before slipping ones, whose unit tangents are filled in.

    Returns how many stick, and whether these are others than before.
    """
    order, slips = factors.order, factors.change[0]  # scratch: 1 where a ring slips
    n = len(bound)
    stick, news = 0, False
    for i in range(n):
        if _slips(q[0, i], q[1, i], slip[0, i], slip[1, i], bound[i]):
            slips[i] = 1.0
        else:
            slips[i] = 0.0
            news = news or order[stick] != i
            order[stick] = i
            stick += 1
    news = news or factors.count[0] != stick
    at = stick
    for i in range(n):
        if slips[i] == 1.0:
            order[at] = i
            if bound[i] > 0.0:
                size = 1.0 / np.sqrt(q[0, i] * q[0, i] + q[1, i] * q[1, i])
                factors.direction[0, at] = -q[1, i] * size
                factors.direction[1, at] = q[0, i] * size
            else:
                factors.direction[0, at], factors.direction[1, at] = 0.0, 1.0
            at += 1
    factors.count[0] = stick
    return stick, news


@kernel
def _factorise_sticking(rings, stick, factors):
    """Eliminate the sticking rings: fills factors.upper.  Returns False if it breaks down.

    Rows of the innermost rings that stick are those of the known factor, their columns reordered.
    """
    stiffness, whole = rings.stiffness, rings.whole
    order, upper, scratch = factors.order, factors.upper, factors.change[0]
    n = len(order)
    known = 0
    while known < stick and order[known] == known:
        known += 1
    for p in range(known):
        for s in range(p, n):
            upper[p, s] = whole[p, order[s]]
    if known == stick and n - stick <= stick:
        _schur_of_outer(whole, stick, upper, scratch)
        return True
    for p in range(known, n):
        for s in range(p, n):
            upper[p, s] = stiffness[order[p], order[s]]
    return _eliminate(upper, known, stick, scratch)


@kernel
def _schur_of_outer(whole, stick, upper, scratch):
    """Schur complement where all rings from `stick` on slip: the rest of the known factor is the
    factor of it, so that a product of what is left does, and nothing is eliminated."""
    n = len(whole)
    for p in range(stick, n):
        row = upper[p, p:]
        row[:] = 0.0
        for k in range(stick, p):
            scratch[k] = -whole[k, p]
        combine(row, scratch[stick:], whole[stick:, p:], p - stick)
        pivot = 1.0 / whole[p, p]
        row[0] += pivot * pivot
        subtract(row[1:], -pivot, whole[p, p + 1 :])


@kernel
def factorise(
    rings: RingSystem, bound: np.ndarray, q: np.ndarray, slip: np.ndarray, factors: Factors
) -> int:
    """Tangent problem at (q, slip), factorised; returns the number of sticking rings, -1 if it
    breaks down.  What belongs to the sticking rings is kept while these stay the same."""
    stick, news = _split(q, slip, bound, factors)
    if news:
        factors.count[1] = 0
        if not _factorise_sticking(rings, stick, factors):
            factors.count[0] = -1
            return -1
    n = len(bound)
    slipping = n - stick
    order, direction = factors.order, factors.direction
    along, across = direction[0, stick:], direction[1, stick:]
    matrix = factors.tangent[:slipping, :slipping]
    for p in range(slipping):
        row, schur = matrix[p], factors.upper[stick + p, stick:]
        x, y = along[p], across[p]
        for s in range(p, slipping):
            row[s] = schur[s] * (x * along[s] + y * across[s])
        i = order[stick + p]  # turning the traction also turns it away from the slip
        row[p] += turning(slip[0, i], slip[1, i], bound[i])
    return stick if _eliminate(matrix, 0, slipping, factors.change[0]) else -1
