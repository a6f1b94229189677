"""A march of the ring contact along a path, with the derivative with respect to its start.

All that a contact remembers is its weighted displacement z = B q - area w (w: rigid displacement),
and a ring that sticks keeps its z, so that in the derivative only slipping rings cost anything:

    d slip = db - dz_new   is zero where a ring sticks;  where it slips
    M x = d^T R,   d slip = R - C d x,   R = db_slipping - (B_ls B_ss^-1) db_sticking

(names as in ring_factors; R is what slipping rings feel once the sticking ones have followed), and
the rows of rings that have not slipped so far are still those of the identity.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import extended
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.rings.first_guess import extrapolate, follow, stretch, within
from microslip.models.rings.newton_step import solve_step, weighted_slip
from microslip.models.rings.tangent import (
    combine,
    copy,
    factorise,
    make_factors,
    subtract,
    turning,
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
def _felt(order, stick, transfer, moved, rows, p, out):
    """out = R of slipping ring p, one component: its own row less what the sticking rings pass on.

    rows: derivative of the displacement, (n, columns), identity rows skipped; moved: positions in
    the order of the sticking rings that have slipped before.
    """
    own = rows[order[stick + p]]
    for column in range(len(out)):
        out[column] = own[column]
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


@kernel
def _slip_tangent(factors, stick, transfer, slip, bound, dz, touched, dslip, work):
    """Derivative of the slips of one solved step: fills the rows of dslip of the slipping rings.

    dz, dslip: (2, n, columns), of the imposed displacement and of the slip; touched: rings whose
    rows of dz are no longer those of the identity; work: like dz.
    """
    order, direction, scratch = factors.order, factors.direction, factors.change[0]
    n, columns = len(bound), dz.shape[2]
    slipping = n - stick
    moved = np.empty(stick, np.int64)
    count = 0
    for k in range(stick):
        if touched[order[k]]:
            moved[count] = k
            count += 1
    for c in range(2):
        for p in range(slipping):
            _felt(order, stick, transfer, moved[:count], dz[c], p, work[c, p])
            for k in range(stick):
                if not touched[order[k]]:
                    work[c, p, c * n + order[k]] -= transfer[k, p]
    turn, across = work[0], work[1]
    for p in range(slipping):
        x, y = direction[0, stick + p], direction[1, stick + p]
        for column in range(columns):
            u, v = turn[p, column], across[p, column]
            turn[p, column] = x * u + y * v
            across[p, column] = y * u - x * v
    _solve(factors.tangent, slipping, turn, scratch)
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
def _start_derivative(stiffness, whole, dz):
    """Derivative of the end tractions with respect to the first ones, B^-1 dz B, (2 n, 2 n)."""
    n = len(stiffness)
    out = np.zeros((2 * n, 2 * n))
    scratch = np.empty(n)
    for c in range(2):
        for i in range(n):
            for part in (slice(0, n), slice(n, 2 * n)):
                own = dz[c, i, part]
                for k in range(n):
                    scratch[k] = -own[k]
                combine(out[c * n + i, part], scratch, stiffness, n)
        _solve(whole, n, out[c * n : (c + 1) * n], scratch)
    return out


@kernel(inline="always")
def _carry_derivative(dz, touched, share, dslip, slid):
    """dz -= share dslip, where rings slipped; notes them as touched."""
    for i in range(len(slid)):
        if slid[i]:
            touched[i] = True
            subtract(dz[0, i], share, dslip[0, i])
            subtract(dz[1, i], share, dslip[1, i])


@kernel
def march(stiffness, whole, bounds, weight, path, state, known, tolerance, tangent):
    """March along a path.

    stiffness, whole: B and its Cholesky factor; bounds: at the start and at every stage, (1 + steps
    stages, n), or (1, n) where they do not change; path: (positions, stages, carry, end), see
    path.Path; state: (2, n); known: tractions of another march, at its start and after every stage,
    (1 + steps stages, 2, n), or empty.  Returns (end state, the tractions of this march, forces
    (steps + 1, 3), residual sum, iterations, derivative of the end state (2 n, 2 n) or empty,
    whether it was interrupted, which makes the rest worthless).
    """
    positions, rigid, carry, end = path
    n, steps, stages = len(weight), rigid.shape[0], rigid.shape[1]
    changes = 1 if len(bounds) > 1 else 0
    columns = 2 * n if tangent else 0
    dz, work = np.zeros((2, n, columns)), np.empty((2, n, columns))
    dslips = np.empty((stages, 2, n, columns))
    slid, touched = np.zeros((stages, n), np.bool_), np.zeros(n, np.bool_)
    transfer = np.empty((n, n))
    factors = make_factors(n)
    tractions, forces = np.empty((1 + steps * stages, 2, n)), np.zeros((steps + 1, 3))
    q, z, b, held = np.empty((2, n)), np.empty((2, n)), np.empty((2, n)), state.copy()
    slips = np.empty((stages, 2, n))
    way = np.empty((1 + steps * stages, 2))
    for c in range(2):
        way[0, c] = positions[0, c]
        for k in range(steps * stages):
            way[1 + k, c] = rigid[k // stages, k % stages, c]
        for i in range(n):
            q[c, i] = state[c, i]
            b[c, i] = -weight[i] * positions[0, c]
            if tangent:
                dz[c, i, c * n + i] = 1.0
    weighted_slip(stiffness, b, q, z)
    for c in range(2):
        for i in range(n):
            z[c, i] = 2.0 * b[c, i] - z[c, i]
            forces[0, c] += weight[i] * q[c, i]
    copy(tractions[0], q)
    total, iterations, at = 0.0, 0, 0
    spent, broken = 0.0, False
    for k in range(steps):
        for s in range(stages):
            at += 1
            for c in range(2):
                for i in range(n):
                    b[c, i] = z[c, i] + weight[i] * way[at, c]
                for j in range(s):
                    subtract(b[c], carry[s, j], slips[j, c])
            bound = bounds[changes * at]
            if changes and at == 1:
                within(q, bound)
            if len(known) > 0:
                follow(q, bound, known[at], known[at - 1])
            elif at > 1:
                last = bounds[changes * (at - 1)]
                extrapolate(q, last, bound, tractions[at - 2], stretch(way, at))
            count, residual = solve_step(
                stiffness, whole, b, bound, weight, q, slips[s], tolerance, factors
            )
            copy(tractions[at], q)
            iterations += count
            total += residual
            spent += count * 4.0 * n * n + (4.0 * n * n * n if tangent else 0.0)
            if spent > BETWEEN_LOOKS:
                spent = 0.0
                broken = interrupted()
                if broken:
                    break
            if tangent:
                for j in range(s):  # dz holds the derivative of b, from stage to stage
                    share = carry[s, j] - (carry[s - 1, j] if j < s - 1 else 0.0)
                    _carry_derivative(dz, touched, share, dslips[j], slid[j])
                stick = factorise(stiffness, whole, bound, q, slips[s], factors)
                for p in range(n):
                    slid[s, factors.order[p]] = p >= stick >= 0
                if 0 <= stick < n:
                    if factors.count[1] == 0:
                        _transfer(factors, stick, transfer)
                    _slip_tangent(
                        factors, stick, transfer, slips[s], bound, dz, touched, dslips[s], work
                    )
        if broken:
            break
        for c in range(2):
            for i in range(n):
                now = b[c, i] - slips[stages - 1, c, i] - weight[i] * way[at, c]
                z[c, i] = extended(z[c, i], now, end)
                held[c, i] = extended(held[c, i], q[c, i], end)
                forces[k + 1, c] += weight[i] * held[c, i]
        if tangent:
            _carry_derivative(dz, touched, 1.0 / end, dslips[stages - 1], slid[stages - 1])
    if tangent and not broken:
        derivative = _start_derivative(stiffness, whole, dz)
    else:
        derivative = np.empty((0, 0))
    return held, tractions, forces, total, iterations, derivative, broken
