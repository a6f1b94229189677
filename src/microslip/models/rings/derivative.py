"""The derivative of a march of rings with respect to its start.

All that a contact remembers is its weighted displacement z = B q - area w (w: rigid displacement),
and a ring that sticks keeps its z, so that in the derivative only slipping rings cost anything:

    d slip = db - dz_new   is zero where a ring sticks;  where it slips
    M x = d^T R,   d slip = R - C d x,   R = db_slipping - (B_ls B_ss^-1) db_sticking

(names as in tangent.py; R is what slipping rings feel once the sticking ones have followed), and
the rows of rings that have not slipped so far are still those of the identity.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.rings.tangent import Factors, RingSystem, combine, subtract, turning


class Derivative(NamedTuple):
    """Derivative of a march with respect to the displacement z at its start; 2 n columns, or none.

    Attributes
    ----------
    displacement : np.ndarray, shape (2, n, columns)
        Of the displacement imposed on the stage, to which slips of earlier ones are carried.
    touched : np.ndarray, shape (n,)
        Whether the rows of a ring in it are no longer those of the identity.
    slips : np.ndarray, shape (stages, 2, n, columns)
        Of the slips in the last stages, filled where rings slipped.
    slipped : np.ndarray, shape (stages, n)
        Whether a ring slipped in them.
    transfer : np.ndarray, shape (n, n)
        See `_transfer`.
    work : np.ndarray, shape (2, n, columns)
        Scratch.
    """

    displacement: np.ndarray
    touched: np.ndarray
    slips: np.ndarray
    slipped: np.ndarray
    transfer: np.ndarray
    work: np.ndarray


@kernel
def make_derivative(n: int, stages: int, columns: int) -> Derivative:
    """That of the start itself."""
    displacement = np.zeros((2, n, columns))
    if columns > 0:
        for c in range(2):
            for i in range(n):
                displacement[c, i, c * n + i] = 1.0
    return Derivative(
        displacement,
        np.zeros(n, np.bool_),
        np.empty((stages, 2, n, columns)),
        np.zeros((stages, n), np.bool_),
        np.empty((n, n)),
        np.empty((2, n, columns)),
    )


@kernel
def _solve(upper, n, x, factors):
    """Solve U^T U y = x in place for the columns of x (first n rows); factors: scratch, (n,)."""
    columns = x.shape[1]
    for i in range(n):
        for j in range(i):
            factors[j] = upper[j, i]
        combine(x[i], factors, x, i)
        for c in range(columns):
            x[i, c] *= upper[i, i]
    for i in range(n - 1, -1, -1):
        combine(x[i], upper[i, i + 1 :], x[i + 1 :], n - 1 - i)
        for c in range(columns):
            x[i, c] *= upper[i, i]


@kernel
def _transfer(factors, stick, out):
    """out[:stick, :slipping] = B_ss^-1 B_sl: how sticking rings pass their motion on."""
    n = len(factors.order)
    upper = factors.upper
    for j in range(stick - 1, -1, -1):
        row = out[j, : n - stick]
        for p in range(n - stick):
            row[p] = upper[j, stick + p]
        combine(row, upper[j, j + 1 : stick], out[j + 1 :, : n - stick], stick - 1 - j)
        for p in range(n - stick):
            row[p] *= upper[j, j]
    factors.count[1] = 1


@kernel
def _subtract_passed(out, transfer, p, moved, order, rows):
    """out -= what sticking rings that have slipped before pass on to slipping ring p.

    moved: positions of these in the order; rows: derivative of the displacement, (n, columns).
    """
    k, count = 0, len(moved)
    while k + 4 <= count:
        e, f, g, h = moved[k], moved[k + 1], moved[k + 2], moved[k + 3]
        a, b, c, d = transfer[e, p], transfer[f, p], transfer[g, p], transfer[h, p]
        u, v, w, x = rows[order[e]], rows[order[f]], rows[order[g]], rows[order[h]]
        for j in range(len(out)):
            out[j] -= (a * u[j] + b * v[j]) + (c * w[j] + d * x[j])
        k += 4
    while k < count:
        subtract(out, transfer[moved[k], p], rows[order[moved[k]]])
        k += 1


@kernel(inline="always")
def _fill_felt(order, stick, derivative):
    """derivative.work[c, p] = R of every slipping ring p, see the module's docstring.

    It is its own row less what the sticking rings pass on.
    """
    touched, transfer = derivative.touched, derivative.transfer
    dz, work = derivative.displacement, derivative.work
    n = len(order)
    moved = np.empty(stick, np.int64)
    count = 0
    for k in range(stick):
        if touched[order[k]]:
            moved[count] = k
            count += 1
    for c in range(2):
        for p in range(n - stick):
            own, out = dz[c, order[stick + p]], work[c, p]
            for column in range(len(out)):
                out[column] = own[column]
            _subtract_passed(out, transfer, p, moved[:count], order, dz[c])
            for k in range(stick):  # the identity rows, each of one entry
                if not touched[order[k]]:
                    out[c * n + order[k]] -= transfer[k, p]


@kernel
def slip_tangent(
    factors: Factors,
    stick: int,
    slip: np.ndarray,
    bound: np.ndarray,
    derivative: Derivative,
    stage: int,
) -> None:
    """Derivative of the slips of one solved stage: fills those of the slipping rings.

    slip: weighted slips, (2, n); stick: number of the sticking rings, as `factorise` returns it.
    """
    order, direction, scratch = factors.order, factors.direction, factors.change[0]
    n, columns = len(bound), derivative.work.shape[2]
    slipping = n - stick
    if factors.count[1] == 0:
        _transfer(factors, stick, derivative.transfer)
    _fill_felt(order, stick, derivative)
    turn, across = derivative.work[0], derivative.work[1]
    for p in range(slipping):  # from forward and lateral to along and across the unit tangents
        x, y = direction[0, stick + p], direction[1, stick + p]
        for column in range(columns):
            u, v = turn[p, column], across[p, column]
            turn[p, column] = x * u + y * v
            across[p, column] = y * u - x * v
    _solve(factors.tangent, slipping, turn, scratch)
    dslip = derivative.slips[stage]
    for p in range(slipping):
        i = order[stick + p]
        x, y = direction[0, stick + p], direction[1, stick + p]
        for s in range(slipping):
            schur = factors.upper[stick + min(p, s), stick + max(p, s)]
            scratch[s] = schur * (y * direction[0, stick + s] - x * direction[1, stick + s])
        combine(across[p], scratch, turn, slipping)
        stiff = turning(slip[0, i], slip[1, i], bound[i])
        for column in range(columns):
            u, v = stiff * turn[p, column], across[p, column]
            dslip[0, i, column] = x * u + y * v
            dslip[1, i, column] = y * u - x * v


@kernel
def start_derivative(rings: RingSystem, dz: np.ndarray) -> np.ndarray:
    """Derivative of the end tractions with respect to the first ones, B^-1 dz B, (2 n, 2 n)."""
    n = len(rings.weight)
    out = np.zeros((2 * n, 2 * n))
    scratch = np.empty(n)
    for c in range(2):
        for i in range(n):
            for part in (slice(0, n), slice(n, 2 * n)):
                own = dz[c, i, part]
                for k in range(n):
                    scratch[k] = -own[k]
                combine(out[c * n + i, part], scratch, rings.stiffness, n)
        _solve(rings.whole, n, out[c * n : (c + 1) * n], scratch)
    return out


@kernel(inline="always")
def carry_derivative(derivative: Derivative, stage: int, share: float) -> None:
    """Less `share` of the slips of a stage, where rings slipped in it; these count as touched."""
    slipped, dslip, dz = derivative.slipped[stage], derivative.slips[stage], derivative.displacement
    for i in range(len(slipped)):
        if slipped[i]:
            derivative.touched[i] = True
            subtract(dz[0, i], share, dslip[0, i])
            subtract(dz[1, i], share, dslip[1, i])


@kernel(inline="always")
def carry_to_stage(derivative: Derivative, carry: np.ndarray, stage: int) -> None:
    """The displacement imposed on a stage, from that of the stage before."""
    for j in range(stage):
        share = carry[stage, j] - (carry[stage - 1, j] if j < stage - 1 else 0.0)
        carry_derivative(derivative, j, share)
