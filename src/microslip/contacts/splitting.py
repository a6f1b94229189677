"""Douglas-Rachford splitting of a Coulomb step, for contacts with a resolvent (A + s)^-1.

With one field y as its state, P the projection on the discs |q| <= g and s the penalty,

    q = P(y),    t = 2 q - y,    v = (A + s)^-1 (b + s t),    y <- y + RELAXATION (v - q),

until Sum weight |v - q|, a force, is within the tolerance.  Then b - A v = s (v - t): the slip
comes without applying A.  Any relaxation below 2 converges (Lions and Mercier 1979; Eckstein and
Bertsekas 1992).  With a driven body v answers to its displacement d by d times a field that is the
same in every step, so that the equation of the body is a division.  Every BETWEEN_BALANCES
iterations `rebalance` solves the equation of the body with the tractions P(y).

Points that stick want a small penalty, points that slip a large one.  Let D be the mean derivative
of the projection over the points and the two directions: 1 where all stick, and |q| / (2 |y|) for
a point that slips.  The best penalty is about (1 - D) / D times the one of a contact that sticks
and slips in equal shares, so each step picks the nearest of PENALTIES.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.interrupts import BETWEEN_LOOKS, interrupted
from microslip.contacts.lanes import NOTHING, four, minus, plus, sum_of, times
from microslip.contacts.operators import multiply
from microslip.contacts.step import LEVELS, Balance, Fields, Step, step_solver
from microslip.contacts.system import System, add, forward_force
from microslip.foundation.compiled import kernel

MOST_ITERATIONS = 4000
RELAXATION = 1.7
"""Within 1.5 to 1.8, the usual range of over-relaxation (Eckstein and Bertsekas 1992)."""
BETWEEN_BALANCES = 32
"""Iterations of a driven step between two calls of `rebalance`: more than the means that
benchmarks/splitting.py prints, so that few steps get there."""
FIRST_ADVANCE, LONGEST_ADVANCE, HALVINGS = 1e-3, 1e6, 40
"""Search for the balanced displacement: first trial and largest one, in u_lim (it grows fourfold),
and number of bisections."""
BALANCED_RINGS = 12
"""Rings at which the best penalty is the self-influence of a ring, where half of the points stick;
calibrated by benchmarks/splitting.py."""
PENALTIES = 2.0 ** (np.arange(LEVELS) - 0.5 * (LEVELS - 1))
"""Penalties that a step picks from, over `best_penalty`: 1/sqrt(8) to sqrt(8)."""


class Resolvent(NamedTuple):
    """The solver of a contact whose shifted operator can be inverted.

    Operator 1 + l of the contact is (A + PENALTIES[l] penalty)^-1.

    Attributes
    ----------
    penalty : np.ndarray, shape (points,)
        s where half of the points stick, displacement over traction.
    factors : np.ndarray, shape (levels,)
        PENALTIES.
    area : float
        Sum of the weights.
    count : float
        Number of points that have an area.
    """

    penalty: np.ndarray
    factors: np.ndarray
    area: float
    count: float  # type: ignore[assignment]  # hides a method of tuples that nobody needs

    def own(self) -> Resolvent:
        """Return the object itself, which has no scratch arrays."""
        return self

    @staticmethod
    def joined(each: Sequence[Resolvent], extents: np.ndarray, weight: np.ndarray) -> Resolvent:
        """The solver of several contacts on one body, see models/side_by_side.py."""
        penalties = [one.penalty * extent for one, extent in zip(each, extents, strict=True)]
        return resolvent(np.concatenate(penalties), weight)


def resolvent(penalty: np.ndarray, weight: np.ndarray) -> Resolvent:
    """The Resolvent of points with these penalties and areas."""
    return Resolvent(penalty, PENALTIES, float(weight.sum()), float(np.count_nonzero(weight)))


def best_penalty(scale: np.ndarray, rings: int) -> np.ndarray:
    """Penalty of each ring where half of the points stick, from the self-influence `scale` of the
    rings of a contact.

    The splitting converges fastest between the least and the largest eigenvalue of A, at their
    geometric mean: these are those of a narrow ring and of the contact as a whole, whose ratio is
    proportional to the number of rings.
    """
    return scale * np.sqrt(rings / BALANCED_RINGS)


@kernel
def squared_distance(weight: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """Sum weight |a - b|^2 of two fields."""
    totals, points = NOTHING, len(weight)
    forward, lateral, other_forward, other_lateral = a[0], a[1], b[0], b[1]
    for group in range(points // 4):
        at = 4 * group
        ahead = minus(four(forward, at), four(other_forward, at))
        aside = minus(four(lateral, at), four(other_lateral, at))
        squares = plus(times(ahead, ahead), times(aside, aside))
        totals = plus(totals, times(four(weight, at), squares))
    total = sum_of(totals)
    for i in range(points - points % 4, points):
        ahead, aside = a[0, i] - b[0, i], a[1, i] - b[1, i]
        total += weight[i] * (ahead * ahead + aside * aside)
    return total


@kernel
def stuck_share(y: np.ndarray, bound: np.ndarray, q: np.ndarray, factors: np.ndarray) -> float:
    """Fill q = P(y) and return the sum over the points of the mean derivative of P."""
    for i in range(len(bound)):
        f = shrink(y[0, i], y[1, i], bound[i])
        q[0, i], q[1, i], factors[i] = f * y[0, i], f * y[1, i], f
    share = 0.0
    for i in range(len(bound)):
        share += factors[i] if factors[i] == 1.0 else 0.5 * factors[i]
    return share


@kernel(inline="always")
def level_of(solver: Resolvent, stuck: float) -> int:
    """Number of the penalty nearest to (1 - D) / D, from D times the number of points."""
    level, ratio = 0, 0.5
    while level < len(solver.factors) - 1 and solver.count - stuck > ratio * stuck:
        level, ratio = level + 1, 2.0 * ratio
    return level


@kernel
def _respond(system: System, fields: Fields, response: np.ndarray, slope: np.ndarray) -> None:
    """Tractions v that answer to d = 1, and their force, for each penalty."""
    unit = fields.scratch[0]
    for i in range(unit.shape[1]):
        unit[0, i], unit[1, i] = 1.0, 0.0
    for level in range(len(slope)):
        multiply(system.operators, 1 + level, unit, response[level])
        slope[level] = forward_force(system, response[level])


@kernel
def _imbalance(
    system: System, balance: Balance, step: Step, y: np.ndarray, displacement: float, advance: float
) -> float:
    """Residual of the equation of the body, stiffness d + forward force - load, at the displacement
    d = displacement + advance.  The slip of points that slip grows by the advance."""
    force = balance.stiffness * (displacement + advance) - balance.load
    for i in range(len(step.bound)):
        forward = y[0, i] + advance / system.solver.penalty[i]
        f = shrink(forward, y[1, i], step.bound[i])
        force += system.weight[i] * f * forward
    return force


@kernel
def rebalance(
    system: System, balance: Balance, step: Step, y: np.ndarray, displacement: float
) -> None:
    """Shift y, in place, to the displacement at which the body is in balance.

    The splitting alone gets there slowly if nearly all points slip and the drive is soft.  y stays
    as it is if that displacement is beyond LONGEST_ADVANCE.
    """
    imbalance = _imbalance(system, balance, step, y, displacement, 0.0)
    if not abs(imbalance) > step.tolerance:
        return
    near, far = 0.0, np.copysign(FIRST_ADVANCE, -imbalance)
    while imbalance * _imbalance(system, balance, step, y, displacement, far) > 0.0:
        near, far = far, 4.0 * far
        if abs(far) > LONGEST_ADVANCE:
            return
    for _ in range(HALVINGS):
        middle = 0.5 * (near + far)
        if imbalance * _imbalance(system, balance, step, y, displacement, middle) > 0.0:
            near = middle
        else:
            far = middle
    for i in range(len(step.bound)):
        y[0, i] += near / system.solver.penalty[i]


@kernel(inline="always")
def _iterate(
    system: System, balance: Balance, step: Step, fields: Fields, most: int
) -> tuple[int, float, float]:
    """Solve a Coulomb step from fields.y on, with at most `most` iterations.

    fields.y is the y of the penalty `Resolvent.penalty`, whichever one the step is solved with.
    """
    guess, q, slip, b, bound = fields.y, fields.q, fields.slip, step.imposed, step.bound
    right, v, y = fields.scratch
    solver, weight, points = system.solver, system.weight, len(bound)
    level = level_of(solver, stuck_share(guess, bound, q, right[0]))
    factor = solver.factors[level]
    inverse = 1.0 / factor
    for c in range(2):
        for i in range(points):
            y[c, i] = q[c, i] + inverse * (guess[c, i] - q[c, i])
        for i in range(points):
            right[c, i] = b[c, i] + factor * solver.penalty[i] * (2.0 * q[c, i] - y[c, i])
    accepted = step.tolerance * step.tolerance / solver.area
    displacement, residual, spent, iterations = 0.0, np.inf, 0.0, 0
    while True:
        multiply(system.operators, 1 + level, right, v)
        if len(balance.slope) > 0:
            excess = balance.load - forward_force(system, v)
            displacement = excess / (balance.stiffness + balance.slope[level])
            add(v, displacement, balance.response[level])
        iterations += 1
        residual = squared_distance(weight, v, q)  # by Schwarz's inequality
        if not residual > accepted or iterations == most:
            break
        for i in range(points):
            forward = y[0, i] + RELAXATION * (v[0, i] - q[0, i])
            lateral = y[1, i] + RELAXATION * (v[1, i] - q[1, i])
            f = shrink(forward, lateral, bound[i])
            y[0, i], y[1, i] = forward, lateral
            q[0, i], q[1, i] = f * forward, f * lateral
            f = (2.0 * f - 1.0) * factor * solver.penalty[i]
            right[0, i], right[1, i] = b[0, i] + f * forward, b[1, i] + f * lateral
        spent += 100.0 * points
        if spent > BETWEEN_LOOKS:
            spent = 0.0
            if interrupted():
                return -1, residual, displacement
    for c in range(2):
        for i in range(points):
            slip[c, i] = b[c, i] - right[c, i] + factor * solver.penalty[i] * v[c, i]
        for i in range(points):
            guess[c, i] = q[c, i] + factor * (y[c, i] - q[c, i])
    return iterations, np.sqrt(solver.area * residual), displacement


@kernel(inline="always")
def split_driven(
    system: System, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step of a driven contact from fields.y on; see step.solve_driven_step."""
    iterations = 0
    while True:
        count, residual, displacement = _iterate(system, balance, step, fields, BETWEEN_BALANCES)
        iterations += count
        if count < BETWEEN_BALANCES or iterations >= MOST_ITERATIONS:
            return (iterations if count >= 0 else -1), residual, displacement
        rebalance(system, balance, step, fields.y, displacement)


@step_solver(Resolvent, split_driven, _respond)
@kernel(inline="always")
def split(system: System, balance: Balance, step: Step, fields: Fields) -> tuple[int, float, float]:
    """Solve a Coulomb step from fields.y on; see step.solve_step."""
    return _iterate(system, balance, step, fields, MOST_ITERATIONS)
