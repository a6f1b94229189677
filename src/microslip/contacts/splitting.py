"""Douglas-Rachford splitting of a Coulomb step, for contacts with a resolvent (A + s)^-1.

With one field y as its state, P the projection on the discs |q| <= g and s the penalty,

    q = P(y),    t = 2 q - y,    v = (A + s)^-1 (b + s t),    y <- y + RELAXATION (v - q),

until Sum weight |v - q|, a force, is within the tolerance.  Then b - A v = s (v - t): the slip
comes without applying A.  Any relaxation below 2 converges (Lions and Mercier 1979; Eckstein and
Bertsekas 1992).  With a driven body v answers to its displacement d by d times a field that is the
same in every step, so that the equation of the body is a division.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.interrupts import BETWEEN_LOOKS, interrupted
from microslip.contacts.operators import multiply
from microslip.contacts.step import Balance, Fields, Step, step_solver
from microslip.contacts.system import System, add, copy, forward_force
from microslip.foundation.compiled import kernel

MOST_ITERATIONS = 4000
RELAXATION = 1.7
"""Calibrated by benchmarks/splitting.py."""

BALANCED_RINGS = 12
"""Rings at which the best penalty is the self-influence of a ring; calibrated by
benchmarks/splitting.py."""

QUICK = {"fastmath": {"contract", "nsz", "arcp"}}
"""Fused multiply-add, reciprocals in place of divisions, no signed zeros: sums keep their order."""


class Resolvent(NamedTuple):
    """The solver of a contact whose shifted operator can be inverted.

    Attributes
    ----------
    inverse : operator
        (A + penalty)^-1.
    penalty : np.ndarray, shape (columns,)
        s, displacement over traction.
    area : float
        Sum of the weights.
    """

    inverse: NamedTuple
    penalty: np.ndarray
    area: float


def best_penalty(scale: np.ndarray, rings: int) -> np.ndarray:
    """Penalty of each ring, from the self-influence `scale` of the rings of a contact.

    The splitting converges fastest between the least and the largest eigenvalue of A, at their
    geometric mean: these are those of a narrow ring and of the contact as a whole, whose ratio is
    proportional to the number of rings.
    """
    return scale * np.sqrt(rings / BALANCED_RINGS)


@kernel(**QUICK, inline="always")
def advance(
    system: System, step: Step, relaxation: float, fields: Fields, v: np.ndarray, right: np.ndarray
) -> float:
    """y += relaxation (v - q), q = P(y), right = b + s (2 q - y); returns Sum weight |v - q|^2."""
    y, q, total = fields.y, fields.q, 0.0
    b, bound, penalty = step.imposed, step.bound, system.solver.penalty
    for j in range(y.shape[1]):
        for i in range(y.shape[2]):
            ahead, aside = v[0, j, i] - q[0, j, i], v[1, j, i] - q[1, j, i]
            total += system.weight[i] * (ahead * ahead + aside * aside)
            forward = y[0, j, i] + relaxation * ahead
            lateral = y[1, j, i] + relaxation * aside
            f = shrink(forward, lateral, bound[0, i])
            y[0, j, i], y[1, j, i] = forward, lateral
            q[0, j, i], q[1, j, i] = f * forward, f * lateral
            f = (2.0 * f - 1.0) * penalty[i]
            right[0, j, i] = b[0, j, i] + f * forward
            right[1, j, i] = b[1, j, i] + f * lateral
    return total


@kernel
def _respond(system, fields, response):
    """Tractions v that answer to d = 1, and their force."""
    unit = fields.scratch[0]
    for c in range(2):
        for j in range(unit.shape[1]):
            for i in range(unit.shape[2]):
                unit[c, j, i] = 1.0 - c
    multiply(system.solver.inverse, unit, response)
    return forward_force(system, response)


@step_solver(Resolvent, _respond)
@kernel(**QUICK)
def split(
    system: System, balance: Balance | None, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step from fields.y on; see step.solve_step."""
    right, other, v = fields.scratch
    copy(fields.q, fields.y)
    copy(v, fields.y)
    advance(system, step, 0.0, fields, v, other)
    displacement, residual, spent = 0.0, np.inf, 0.0
    iterations = 0
    while residual > step.tolerance and iterations < MOST_ITERATIONS:
        right, other = other, right
        multiply(system.solver.inverse, right, v)
        if balance is not None:
            excess = balance.load - forward_force(system, v)
            displacement = excess / (balance.stiffness + balance.slope)
            add(v, displacement, balance.response)
        iterations += 1
        # by Schwarz's inequality no less than Sum weight |v - q|
        residual = np.sqrt(system.solver.area * advance(system, step, RELAXATION, fields, v, other))
        spent += 8.0 * v.size * v.shape[2]
        if spent > BETWEEN_LOOKS:
            spent = 0.0
            if interrupted():
                return -1, residual, displacement
    b, penalty, slip = step.imposed, system.solver.penalty, fields.slip
    for c in range(2):
        for j in range(v.shape[1]):
            for i in range(v.shape[2]):
                slip[c, j, i] = b[c, j, i] - right[c, j, i] + penalty[i] * v[c, j, i]
    return iterations, residual, displacement
