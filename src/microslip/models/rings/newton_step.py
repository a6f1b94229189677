"""One Coulomb step on rings, solved by a semismooth Newton method (tangent.py: the linear part).

A step starts from a guess whose slipping rings are mostly right, so Newton steps come first.  Where
one helps little a projected Gauss-Seidel sweep settles which rings slip; where one does not help at
all over-relaxed sweeps take over, and these always converge.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import shrink
from microslip.models.rings.tangent import Factors, RingSystem, copy, factorise, subtract

MAX_ITERATIONS = 200
RESCUE_SWEEPS = 12
RESCUE_RELAXATION = 1.4
GOOD_STEP = 0.3
"""A Newton step that leaves more than this share of the residual is followed by a sweep."""


@kernel
def weighted_slip(
    stiffness: np.ndarray, imposed: np.ndarray, q: np.ndarray, out: np.ndarray
) -> None:
    """out = imposed - B q; all (2, n)."""
    n = q.shape[1]
    for c in range(2):
        for i in range(n):
            out[c, i] = imposed[c, i]
        for k in range(n):
            x = q[c, k]
            for i in range(n):
                out[c, i] -= stiffness[k, i] * x


@kernel
def step_residual(
    stiffness: np.ndarray, q: np.ndarray, slip: np.ndarray, bound: np.ndarray, weight: np.ndarray
) -> float:
    """coulomb.coulomb_residual for weighted slips on rings."""
    total = 0.0
    for i in range(q.shape[1]):
        scale = 1.0 / stiffness[i, i]
        x, y = q[0, i] + slip[0, i] * scale, q[1, i] + slip[1, i] * scale
        f = shrink(x, y, bound[i])
        x, y = x * f - q[0, i], y * f - q[1, i]
        total += weight[i] * np.sqrt(x * x + y * y)
    return total


@kernel
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


@kernel(inline="always")
def _eliminate_sticking(upper, change, stick):
    """Forward substitution with U^T over the sticking rings."""
    for c in range(2):
        for j in range(stick):
            change[c, j] *= upper[j, j]
            x = change[c, j]
            for p in range(j + 1, len(upper)):
                change[c, p] -= x * upper[j, p]


@kernel(inline="always")
def _solve_angles(matrix, change, stick):
    """Solve with the tangent matrix for the angles of the slipping rings, in change[0]."""
    n = len(matrix)
    for j in range(stick, n):
        change[0, j] *= matrix[j - stick, j - stick]
        x = change[0, j]
        for s in range(j + 1, n):
            change[0, s] -= x * matrix[j - stick, s - stick]
    for j in range(n - 1, stick - 1, -1):
        x = change[0, j]
        for s in range(j + 1, n):
            x -= matrix[j - stick, s - stick] * change[0, s]
        change[0, j] = x * matrix[j - stick, j - stick]


@kernel(inline="always")
def _substitute_sticking(upper, change, stick):
    """Back substitution with U over the sticking rings."""
    for j in range(stick - 1, -1, -1):
        x, y = change[0, j], change[1, j]
        for p in range(j + 1, len(upper)):
            x -= upper[j, p] * change[0, p]
            y -= upper[j, p] * change[1, p]
        change[0, j], change[1, j] = x * upper[j, j], y * upper[j, j]


@kernel
def newton_step(slip: np.ndarray, stick: int, factors: Factors) -> None:
    """Fill factors.change (in the order of the factors) with the Newton step against `slip`.

    Sticking rings are eliminated from both components, the angles of the slipping ones are solved
    for, both of their components follow, and then what sticks.
    """
    change, order, direction = factors.change, factors.order, factors.direction
    n = len(order)
    for c in range(2):
        for p in range(n):
            change[c, p] = slip[c, order[p]]
    _eliminate_sticking(factors.upper, change, stick)
    for p in range(stick, n):
        change[0, p] = direction[0, p] * change[0, p] + direction[1, p] * change[1, p]
    _solve_angles(factors.tangent, change, stick)
    for p in range(stick, n):
        change[1, p] = direction[1, p] * change[0, p]
        change[0, p] *= direction[0, p]
    _substitute_sticking(factors.upper, change, stick)


class Step(NamedTuple):
    """A Coulomb step to be solved.

    Attributes
    ----------
    imposed : np.ndarray, shape (2, n)
        Weighted displacement.
    bound : np.ndarray, shape (n,)
        Friction bound of each ring.
    tolerance : float
        Of the residual, a force over mu F_z.
    """

    imposed: np.ndarray
    bound: np.ndarray
    tolerance: float


@kernel(inline="always")
def move(q: np.ndarray, bound: np.ndarray, stick: int, factors: Factors) -> None:
    """Fill factors.trial with q moved by factors.change, within the bound."""
    order, change, trial = factors.order, factors.change, factors.trial
    for p in range(len(bound)):
        i = order[p]
        x, y = q[0, i] + change[0, p], q[1, i] + change[1, p]
        f = shrink(x, y, bound[i])
        if p >= stick and bound[i] > 0.0:  # a slipping traction ends on the bound
            f = bound[i] / np.sqrt(x * x + y * y)
        trial[0, i], trial[1, i] = x * f, y * f


@kernel
def solve_step(
    rings: RingSystem, step: Step, q: np.ndarray, slip: np.ndarray, factors: Factors
) -> tuple[int, float]:
    """Solve one Coulomb step on rings in place.

    Parameters
    ----------
    rings : tangent.RingSystem
        The contact.
    step : Step
        What is asked for.
    q : np.ndarray, shape (2, n)
        Tractions, start and result; within the bound.
    slip : np.ndarray, shape (2, n)
        Receives imposed - B q.
    factors : tangent.Factors
        Scratch.

    Returns
    -------
    tuple
        Iterations and residual; the caller compares the latter with the tolerance.
    """
    stiffness, weight = rings.stiffness, rings.weight
    imposed, bound, tolerance = step
    trial, trial_slip = factors.trial, factors.trial_slip
    weighted_slip(stiffness, imposed, q, slip)
    residual = step_residual(stiffness, q, slip, bound, weight)
    failures = 0
    for iteration in range(MAX_ITERATIONS):
        if residual <= tolerance:
            return iteration, residual
        trial_residual = np.inf
        stick = factorise(rings, bound, q, slip, factors)
        if stick >= 0:
            newton_step(slip, stick, factors)
            move(q, bound, stick, factors)
            weighted_slip(stiffness, imposed, trial, trial_slip)
            trial_residual = step_residual(stiffness, trial, trial_slip, bound, weight)
        good = trial_residual <= max(GOOD_STEP * residual, tolerance)
        if trial_residual < residual:
            copy(q, trial)
            copy(slip, trial_slip)
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
