"""A march of rings times angles, compiled: every stage is solved by over-relaxed ADMM.

The quadratic part goes through the blocks of the elastic operator (angular_modes.py), factorised
once; the friction bound is kept to point by point.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import coulomb_residual, extended, shrink
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.point_fields import rigid_displacement, sum_forces
from microslip.models.polar.angular_modes import apply_sectors, fold, unfold

MAX_ITERATIONS = 4000
RELAXATION = 1.7
FEWEST_BETWEEN, MOST_BETWEEN = 2, 12
"""Iterations between two looks at the residual, which costs more than an iteration."""


@kernel
def _slip(influence, b, q, folded, image, slip):
    """slip = b - A q; folded, image: room for folded tractions."""
    fold(q, folded)
    apply_sectors(influence, folded, image)
    unfold(image, slip)
    for c in range(2):
        for j in range(q.shape[1]):
            for i in range(q.shape[2]):
                slip[c, j, i] = b[c, j, i] - slip[c, j, i]


@kernel
def _project(free, bound, q, dual):
    """Over-relaxed projection on the friction bound, the remainder kept in ``dual``; in place."""
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward = RELAXATION * free[0, j, i] + (1 - RELAXATION) * q[0, j, i] + dual[0, j, i]
            lateral = RELAXATION * free[1, j, i] + (1 - RELAXATION) * q[1, j, i] + dual[1, j, i]
            f = shrink(forward, lateral, bound[i])
            q[0, j, i] = f * forward
            q[1, j, i] = f * lateral
            dual[0, j, i] = forward - f * forward
            dual[1, j, i] = lateral - f * lateral


@kernel
def _copy(out, values):
    """out[:] = values for shape (2, M, N); see rings.tangent.copy."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] = values[c, j, i]


@kernel
def _add(out, factor, values):
    """out += factor values for shape (2, M, N)."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] += factor * values[c, j, i]


@kernel
def solve_step(influence, inverse, penalty, bound, weight, b, q, dual, slip, room, tolerance):
    """Solve one Coulomb step by over-relaxed ADMM, in place.

    influence: sectors.Sectors of A; inverse: of (A + penalty)^-1; penalty: (N,), also the scale of
    the residual; b: the imposed displacement (2, M, N); q: start and result, within the bound;
    dual: slip over penalty, kept from step to step; slip: receives b - A q; room: two folded
    arrays and a full one.  Returns (iterations, residual); -1 iterations: interrupted.
    """
    folded, image, free = room
    angles, n = q.shape[1], q.shape[2]
    _slip(influence, b, q, folded, image, slip)
    residual = coulomb_residual(q, slip, bound, weight, penalty)
    iterations, between, spent = 0, FEWEST_BETWEEN, 0.0
    while residual > tolerance and iterations < MAX_ITERATIONS:
        for _ in range(between):
            for c in range(2):
                for j in range(angles):
                    for i in range(n):
                        kept = q[c, j, i] - dual[c, j, i]
                        free[c, j, i] = b[c, j, i] + penalty[i] * kept
            fold(free, folded)
            apply_sectors(inverse, folded, image)
            unfold(image, free)
            _project(free, bound, q, dual)
        iterations += between
        spent += between * 8.0 * angles * n * n
        if spent > BETWEEN_LOOKS:
            spent = 0.0
            if interrupted():
                return -1, residual
        _slip(influence, b, q, folded, image, slip)
        before, residual = residual, coulomb_residual(q, slip, bound, weight, penalty)
        # the residual falls geometrically: the next look is due where it should be small enough
        pace = np.log(max(residual, 1e-300) / before) / between
        due = np.log(tolerance / max(residual, 1e-300)) / min(pace, -0.05)
        between = int(min(max(np.ceil(due), FEWEST_BETWEEN), MOST_BETWEEN))
    return iterations, residual


@kernel
def _shrink(q, bound):
    """q projected on the friction bound, which may have become smaller; in place."""
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            f = shrink(q[0, j, i], q[1, j, i], bound[i])
            q[0, j, i] *= f
            q[1, j, i] *= f


@kernel
def march(
    influence,
    inverse,
    penalty,
    bounds,
    weight,
    positions,
    path,
    state,
    tolerance,
    warm,
    added,
    duals,
    forces,
):
    """March along a path; returns (state, residual sum, iterations, whether it was interrupted).

    path: (positions, stages, carry, end), see path.Path; bounds: at the start and at every stage,
    (1 + steps stages, N), or one that stays, (1, N); added, duals: (steps, stages, 2, M, N), what
    every stage adds to the tractions, and its dual; filled, and read as first guesses if ``warm``.
    """
    way, stages, carry, end = path
    angles, n = state.shape[1], state.shape[2]
    n_stages = stages.shape[1]
    q, held = state.copy(), state.copy()
    rigid = np.empty_like(q)
    slips = np.empty((n_stages, 2, angles, n))
    dual, before = np.zeros_like(q), np.empty_like(q)
    folded = np.empty((4, angles // 2, n))
    room = (folded, np.empty_like(folded), np.empty_like(q))
    rigid_displacement(way[0], positions, rigid)
    z = np.empty_like(q)
    _slip(influence, rigid, q, folded, room[1], z)
    _add(z, -2.0, z)
    sum_forces(q, weight, positions, forces[0])
    total, iterations, spent = 0.0, 0, 0.0
    b = np.empty_like(q)
    for k in range(stages.shape[0]):
        for s in range(n_stages):
            bound = bounds[min(1 + k * n_stages + s, len(bounds) - 1)]
            rigid_displacement(stages[k, s], positions, rigid)
            _copy(b, z)
            _add(b, 1.0, rigid)
            for j in range(s):
                _add(b, -carry[s, j], slips[j])
            _copy(before, q)
            if warm:
                _add(q, 1.0, added[k, s])
                _copy(dual, duals[k, s])
            elif k > 0:
                _copy(dual, duals[k - 1, s])
            _shrink(q, bound)
            count, residual = solve_step(
                influence,
                inverse,
                penalty,
                bound,
                weight,
                b,
                q,
                dual,
                slips[s],
                room,
                tolerance,
            )
            spent += count * 8.0 * angles * n * n
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return held, total, iterations, True
            if spent > BETWEEN_LOOKS:
                spent = 0.0
            _copy(added[k, s], q)
            _add(added[k, s], -1.0, before)
            _copy(duals[k, s], dual)
            iterations += count
            total += residual
        slip = slips[n_stages - 1]
        for c in range(2):
            for j in range(angles):
                for i in range(n):
                    now = b[c, j, i] - (slip[c, j, i] + rigid[c, j, i])
                    z[c, j, i] = extended(z[c, j, i], now, end)
                    held[c, j, i] = extended(held[c, j, i], q[c, j, i], end)
        sum_forces(held, weight, positions, forces[k + 1])
    return held, total, iterations, False
