"""Douglas-Rachford splitting of a Coulomb step, for contacts with a resolvent (A + s)^-1.

The state is one field y.  With the projection P on the discs |q| <= g and the penalty s,

    q = P(y),    t = 2 q - y,    v = (A + s)^-1 (b + s t),    y <- y + RELAXATION (v - q),

until the force Sum weight |v - q| is within the tolerance.  The slip is b - A v = s (v - t), so A
itself is never applied.  The iteration converges for any relaxation below 2 (Lions and Mercier
1979; Eckstein and Bertsekas 1992).  The response of v to the displacement d of a driven body is d
times a constant field, so the equation of the body is solved by a division.  After every
BETWEEN_BALANCES iterations, `rebalance` solves the equation of the body for the tractions P(y).

A small penalty is best for points that stick, and a large penalty is best for points that slip.
Let D be the derivative of the projection, averaged over the points and both directions.  It is 1
for a point that sticks, and |q| / (2 |y|) for a point that slips.  The best penalty is about
(1 - D) / D times the best penalty for D = 1/2.  Each step uses the nearest of PENALTIES.
"""

from __future__ import annotations

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
"""Largest number of iterations of a step."""
RELAXATION = 1.7
"""Relaxation factor; 1.5 to 1.8 is usual (Eckstein and Bertsekas 1992)."""
BETWEEN_BALANCES = 32
"""Number of iterations in a driven step between calls of `rebalance`.  It is above the mean numbers
of iterations printed by benchmarks/splitting.py, so `rebalance` is rarely called."""
FIRST_ADVANCE, LONGEST_ADVANCE, HALVINGS = 1e-3, 1e6, 40
"""Parameters of the search for the displacement at which the forces balance: first and largest
trial in u_lim (each trial is four times the previous one), and number of bisections."""
BALANCED_RINGS = 12
"""Number of rings at which the best penalty equals a ring's self-influence, if half of the points
stick.  Calibrated by benchmarks/splitting.py."""
PENALTIES = 2.0 ** (np.arange(LEVELS) - 0.5 * (LEVELS - 1))
"""Possible penalties of a step divided by `best_penalty`, from 1/sqrt(8) to sqrt(8)."""


class Resolvent(NamedTuple):
    """Step solver of a contact with resolvents.

    Operator 1 + l of the contact is (A + PENALTIES[l] penalty)^-1.

    Attributes
    ----------
    penalty : np.ndarray, shape (points,)
        Penalty s (displacement divided by traction) for a contact in which half of the points
        stick.
    factors : np.ndarray, shape (levels,)
        Copy of PENALTIES.
    area : float
        Sum of the weights.
    count : float
        Number of points that have an area.
    """

    penalty: np.ndarray
    factors: np.ndarray
    area: float
    count: float  # type: ignore[assignment]  # replaces a method of tuples

    def own(self) -> Resolvent:
        """Return the object itself, which has no scratch arrays."""
        return self


def resolvent(penalty: np.ndarray, weight: np.ndarray) -> Resolvent:
    """Create the Resolvent for points with these penalties and areas, shape (points,)."""
    return Resolvent(penalty, PENALTIES, float(weight.sum()), float(np.count_nonzero(weight)))


def best_penalty(scale: np.ndarray, rings: int) -> np.ndarray:
    """Best penalty of each ring if half of the points stick.

    The splitting converges fastest if the penalty is the geometric mean of the smallest and the
    largest eigenvalue of A.  The smallest eigenvalue belongs to a narrow ring, and the largest
    belongs to the whole contact.  Their ratio is proportional to the number of rings.

    Parameters
    ----------
    scale : np.ndarray
        Self-influence of each ring.
    rings : int
        Number of rings.
    """
    return scale * np.sqrt(rings / BALANCED_RINGS)


@kernel
def squared_distance(weight: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """Return Sum weight |a - b|^2 for two fields a and b."""
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
    """Fill q = P(y), and return D (see the module) times the number of points."""
    for i in range(len(bound)):
        f = shrink(y[0, i], y[1, i], bound[i])
        q[0, i], q[1, i], factors[i] = f * y[0, i], f * y[1, i], f
    share = 0.0
    for i in range(len(bound)):
        share += factors[i] if factors[i] == 1.0 else 0.5 * factors[i]
    return share


@kernel(inline="always")
def level_of(solver: Resolvent, stuck: float) -> int:
    """Return the index of the penalty nearest to (1 - D) / D.  stuck: D times the number of
    points."""
    level, ratio = 0, 0.5
    while level < len(solver.factors) - 1 and solver.count - stuck > ratio * stuck:
        level, ratio = level + 1, 2.0 * ratio
    return level


@kernel
def _respond(system: System, fields: Fields, response: np.ndarray, slope: np.ndarray) -> None:
    """For each penalty, compute the tractions v for d = 1, and their forward force."""
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
    d = displacement + advance.

    The advance is added to the slip of points that slip.
    """
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
    """Shift y, in place, to the displacement at which the forces on the body balance.

    The splitting alone converges slowly if nearly all points slip and the drive is soft. If the
    shift would exceed LONGEST_ADVANCE, y does not change.
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


@kernel  # inlining would save a few per cent for rings, and cost seconds of compiling
def _iterate(
    system: System, balance: Balance, step: Step, fields: Fields, most: int
) -> tuple[int, float, float]:
    """Solve a Coulomb step from the initial guess fields.y, with at most `most` iterations.

    On entry and return, fields.y belongs to the penalty `Resolvent.penalty`, even if the iteration
    uses another penalty.
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
        residual = squared_distance(weight, v, q)  # bounds the force by Schwarz's inequality
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
    """Solve a Coulomb step of a driven contact from the initial guess fields.y; see
    step.solve_driven_step."""
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
    """Solve a Coulomb step from the initial guess fields.y; see step.solve_step."""
    return _iterate(system, balance, step, fields, MOST_ITERATIONS)
