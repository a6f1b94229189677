"""A march of the ring contact along a path, if asked for with its derivative (derivative.py)."""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import extended
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.path import LoadingPath
from microslip.models.rings.derivative import (
    carry_derivative,
    carry_to_stage,
    make_derivative,
    slip_tangent,
    start_derivative,
)
from microslip.models.rings.first_guess import extrapolate, follow, stretch, within
from microslip.models.rings.newton_step import Step, solve_step, weighted_slip
from microslip.models.rings.tangent import RingSystem, copy, factorise, make_factors, subtract


@kernel
def displacements(path: LoadingPath) -> np.ndarray:
    """Forward and lateral displacement at the start and at every stage, (1 + steps stages, 2)."""
    steps, stages = path.stages.shape[0], path.stages.shape[1]
    displacements = np.empty((1 + steps * stages, 2))
    for c in range(2):
        displacements[0, c] = path.positions[0, c]
        for k in range(steps * stages):
            displacements[1 + k, c] = path.stages[k // stages, k % stages, c]
    return displacements


@kernel
def remembered(rings: RingSystem, position: np.ndarray, q: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Weighted displacement z = B q - area w at the start; b: scratch, all (2, n)."""
    z = np.empty_like(q)
    for c in range(2):
        for i in range(q.shape[1]):
            b[c, i] = -rings.weight[i] * position[c]
    weighted_slip(rings.stiffness, b, q, z)
    for c in range(2):
        for i in range(q.shape[1]):
            z[c, i] = 2.0 * b[c, i] - z[c, i]
    return z


@kernel(inline="always")
def bound_at(bounds: np.ndarray, at: int) -> np.ndarray:
    """Friction bound at the start (0) and at the stages (from 1 on), (n,)."""
    return bounds[at if len(bounds) > 1 else 0]


@kernel(inline="always")
def guess(
    q: np.ndarray,
    bounds: np.ndarray,
    displacements: np.ndarray,
    at: int,
    known: np.ndarray,
    tractions: np.ndarray,
) -> None:
    """Move q, the tractions at the end of a stage, to the first guess of those of the next one.

    at: number of that stage from 1 on; known, tractions: of another march, or nothing, and of this
    one.
    """
    bound = bound_at(bounds, at)
    if at == 1 and len(bounds) > 1:
        within(q, bound)
    if len(known) > 0:
        follow(q, bound, known[at], known[at - 1])
    elif at > 1:
        extrapolate(
            q, bound_at(bounds, at - 1), bound, tractions[at - 2], stretch(displacements, at)
        )


@kernel
def march(
    rings: RingSystem,
    path: LoadingPath,
    state: np.ndarray,
    known: np.ndarray,
    tolerance: float,
    tangent: bool,
) -> tuple:
    """March along a path.

    Parameters
    ----------
    rings : tangent.RingSystem
        The contact.
    path : models.path.LoadingPath
        What is imposed; bounds (1 + steps stages, n) or (1, n).
    state : np.ndarray, shape (2, n)
        Tractions at the start.
    known : np.ndarray, shape (1 + steps stages, 2, n)
        Tractions of another march, at its start and after every stage, or empty.
    tolerance : float
        Of every stage, a force over mu F_z.
    tangent : bool
        Whether to take the derivative.

    Returns
    -------
    tuple
        End state, the tractions of this march as in `known`, forces (steps + 1, 3), residual sum,
        iterations, derivative of the end state (2 n, 2 n) or empty, whether it was interrupted,
        which makes the rest worthless.
    """
    n, steps, stages = len(rings.weight), path.stages.shape[0], path.stages.shape[1]
    weight, carry, end = rings.weight, path.carry, path.end
    factors, moved, bounds = make_factors(n), displacements(path), path.bounds
    derivative = make_derivative(n, stages, 2 * n if tangent else 0)
    tractions, forces = np.empty((1 + steps * stages, 2, n)), np.zeros((steps + 1, 3))
    slips, b = np.empty((stages, 2, n)), np.empty((2, n))
    q, at_end = state.copy(), state.copy()
    z = remembered(rings, moved[0], q, b)
    for c in range(2):
        for i in range(n):
            forces[0, c] += weight[i] * q[c, i]
    copy(tractions[0], q)
    total, spent, iterations, at = 0.0, 0.0, 0, 0
    for k in range(steps):
        for s in range(stages):
            at += 1
            for c in range(2):
                for i in range(n):
                    b[c, i] = z[c, i] + weight[i] * moved[at, c]
                for j in range(s):
                    subtract(b[c], carry[s, j], slips[j, c])
            bound = bound_at(bounds, at)
            guess(q, bounds, moved, at, known, tractions)
            step = Step(b, bound, tolerance)
            count, residual = solve_step(rings, step, q, slips[s], factors)
            copy(tractions[at], q)
            iterations += count
            total += residual
            spent += count * 4.0 * n * n + (4.0 * n * n * n if tangent else 0.0)
            if spent > BETWEEN_LOOKS:
                spent = 0.0
                if interrupted():
                    return at_end, tractions, forces, total, iterations, np.empty((0, 0)), True
            if tangent:
                carry_to_stage(derivative, carry, s)
                stick = factorise(rings, bound, q, slips[s], factors)
                for p in range(n):
                    derivative.slipped[s, factors.order[p]] = p >= stick >= 0
                if 0 <= stick < n:
                    slip_tangent(factors, stick, slips[s], bound, derivative, s)
        for c in range(2):
            for i in range(n):
                now = b[c, i] - slips[stages - 1, c, i] - weight[i] * moved[at, c]
                z[c, i] = extended(z[c, i], now, end)
                at_end[c, i] = extended(at_end[c, i], q[c, i], end)
                forces[k + 1, c] += weight[i] * at_end[c, i]
        if tangent:
            carry_derivative(derivative, stages - 1, 1.0 / end)
    found = start_derivative(rings, derivative.displacement) if tangent else np.empty((0, 0))
    return at_end, tractions, forces, total, iterations, found, False
