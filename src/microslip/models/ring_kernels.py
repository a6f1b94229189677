"""One Coulomb step on rings, solved by a semismooth Newton method (ring_factors: the linear part).

A step starts from a guess whose slipping rings are mostly right, so Newton steps come first.  Where
one helps little a projected Gauss-Seidel sweep settles which rings slip; where one does not help at
all over-relaxed sweeps take over, and these always converge.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from microslip.friction import JIT, shrink
from microslip.models.ring_factors import factorise, subtract

MAX_ITERATIONS = 200
RESCUE_SWEEPS = 12
RESCUE_RELAXATION = 1.4
GOOD_STEP = 0.3
"""A Newton step that leaves more than this share of the residual is followed by a sweep."""


@njit(**JIT)
def weighted_slip(stiffness, imposed, q, out):
    """out = imposed - B q; all (2, n)."""
    n = q.shape[1]
    forward, lateral = out[0], out[1]
    for i in range(n):
        forward[i], lateral[i] = imposed[0, i], imposed[1, i]
    for k in range(n):
        row, x, y = stiffness[k], q[0, k], q[1, k]
        for i in range(n):
            forward[i] -= row[i] * x
            lateral[i] -= row[i] * y


@njit(**JIT)
def step_residual(stiffness, q, slip, bound, weight):
    """friction.coulomb_residual for weighted slips on rings."""
    total = 0.0
    for i in range(q.shape[1]):
        scale = 1.0 / stiffness[i, i]
        x, y = q[0, i] + slip[0, i] * scale, q[1, i] + slip[1, i] * scale
        f = shrink(x, y, bound[i])
        x, y = x * f - q[0, i], y * f - q[1, i]
        total += weight[i] * np.sqrt(x * x + y * y)
    return total


@njit(**JIT)
def _sweep(stiffness, bound, q, slip, relaxation):
    """One projected Gauss-Seidel sweep; keeps slip = imposed - B q up to date."""
    for i in range(q.shape[1]):
        scale = relaxation / stiffness[i, i]
        x, y = q[0, i] + slip[0, i] * scale, q[1, i] + slip[1, i] * scale
        f = shrink(x, y, bound[i])
        dx, dy = x * f - q[0, i], y * f - q[1, i]
        if dx != 0.0 or dy != 0.0:
            q[0, i] += dx
            q[1, i] += dy
            subtract(slip[0], dx, stiffness[i])
            subtract(slip[1], dy, stiffness[i])


@njit(**JIT)
def _newton_step(slip, stick, factors):
    """Fill factors.change (in the order of the factors) with the Newton step against ``slip``."""
    upper, matrix = factors.upper, factors.tangent
    order, direction = factors.order, factors.direction
    forward, lateral = factors.change[0], factors.change[1]
    n = len(order)
    for p in range(n):
        forward[p], lateral[p] = slip[0, order[p]], slip[1, order[p]]
    for j in range(stick):
        row = upper[j]
        x, y = forward[j] * row[j], lateral[j] * row[j]
        forward[j], lateral[j] = x, y
        for p in range(j + 1, n):
            forward[p] -= x * row[p]
            lateral[p] -= y * row[p]
    turn = forward[stick:]  # the angle's part; forward and lateral follow from it
    for p in range(stick, n):
        turn[p - stick] = direction[0, p] * forward[p] + direction[1, p] * lateral[p]
    slipping = n - stick
    for j in range(slipping):
        turn[j] *= matrix[j, j]
        subtract(turn[j + 1 :], turn[j], matrix[j, j + 1 : slipping])
    for j in range(slipping - 1, -1, -1):
        total = turn[j]
        for s in range(j + 1, slipping):
            total -= matrix[j, s] * turn[s]
        turn[j] = total * matrix[j, j]
    for p in range(stick, n):
        lateral[p] = direction[1, p] * turn[p - stick]
        forward[p] = direction[0, p] * turn[p - stick]
    for j in range(stick - 1, -1, -1):
        x, y = forward[j], lateral[j]
        row = upper[j]
        for p in range(j + 1, n):
            x -= row[p] * forward[p]
            y -= row[p] * lateral[p]
        forward[j], lateral[j] = x * row[j], y * row[j]


@njit(**JIT)
def solve_step(stiffness, whole, imposed, bound, weight, q, slip, tolerance, factors):
    """Solve one Coulomb step on rings in place.

    stiffness: B, (n, n); whole: its Cholesky factor; imposed: weighted displacement, (2, n); q:
    start and result, (2, n), within the bound; slip: receives imposed - B q.  Returns (iterations,
    residual); the caller compares the residual with the tolerance.
    """
    n = len(bound)
    trial, trial_slip = factors.trial, factors.trial_slip
    weighted_slip(stiffness, imposed, q, slip)
    residual = step_residual(stiffness, q, slip, bound, weight)
    failures = 0
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        trial_residual = np.inf
        stick = factorise(stiffness, whole, bound, q, slip, factors)
        if stick >= 0:
            _newton_step(slip, stick, factors)
            for p in range(n):
                i = factors.order[p]
                x, y = q[0, i] + factors.change[0, p], q[1, i] + factors.change[1, p]
                f = shrink(x, y, bound[i])
                if p >= stick:  # a slipping traction ends on the bound
                    f = bound[i] / np.sqrt(x * x + y * y)
                trial[0, i], trial[1, i] = x * f, y * f
            weighted_slip(stiffness, imposed, trial, trial_slip)
            trial_residual = step_residual(stiffness, trial, trial_slip, bound, weight)
        good = trial_residual <= max(GOOD_STEP * residual, tolerance)
        if trial_residual < residual:
            q[:] = trial
            slip[:] = trial_slip
            residual = trial_residual
        else:
            failures += 1
        if not good:
            sweeps = RESCUE_SWEEPS if failures > 1 else 1
            for _ in range(sweeps):
                _sweep(stiffness, bound, q, slip, RESCUE_RELAXATION if sweeps > 1 else 1.0)
            weighted_slip(stiffness, imposed, q, slip)
            residual = step_residual(stiffness, q, slip, bound, weight)
    return MAX_ITERATIONS, residual
