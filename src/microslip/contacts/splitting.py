"""Douglas-Rachford splitting of a Coulomb step, for contacts with a resolvent (A + s)^-1.

With one field y as its state, P the projection on the discs |q| <= g and s the penalty,

    q = P(y),    t = 2 q - y,    v = (A + s)^-1 (b + s t),    y <- y + RELAXATION (v - q),

until Sum weight |v - q|, a force, is within the tolerance.  Then b - A v = s (v - t): the slip
comes without applying A.  Any relaxation below 2 converges (Lions and Mercier 1979; Eckstein and
Bertsekas 1992).  Anderson acceleration of y with three differences halves the iterations on few
rings and takes a third on many.  With a driven body v answers to its displacement d by d times a
field that is the same in every step, so that the equation of the body is a division.
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
"""Within 1.5 to 1.8, the usual range of over-relaxation (Eckstein and Bertsekas 1992)."""
BALANCED_RINGS = 12
"""Rings at which the best penalty is the self-influence of a ring; calibrated by
benchmarks/splitting.py."""
RIDGE = 1e-10
"""Added to the diagonal of the normal equations, over their largest entry: rounding."""

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
    changes, images : np.ndarray, shape (3, *field)
        Scratch of the acceleration: differences of the changes of y, and of its images.
    last : np.ndarray, shape (2, *field)
        Scratch: the last change of y and its image.
    """

    inverse: NamedTuple
    penalty: np.ndarray
    area: float
    changes: np.ndarray
    images: np.ndarray
    last: np.ndarray


def resolvent(inverse: NamedTuple, penalty: np.ndarray, weight: np.ndarray, rows: int) -> Resolvent:
    """The Resolvent of fields of so many rows, with scratch of its own."""
    field = (2, rows, len(penalty))
    scratch = (np.empty((count, *field)) for count in (3, 3, 2))
    return Resolvent(inverse, penalty, float(rows * weight.sum()), *scratch)


def best_penalty(scale: np.ndarray, rings: int) -> np.ndarray:
    """Penalty of each ring, from the self-influence `scale` of the rings of a contact.

    The splitting converges fastest between the least and the largest eigenvalue of A, at their
    geometric mean: these are those of a narrow ring and of the contact as a whole, whose ratio is
    proportional to the number of rings.
    """
    return scale * np.sqrt(rings / BALANCED_RINGS)


class Shares(NamedTuple):
    """Shares of the three last differences in an accelerated y, the newest first."""

    first: float
    second: float
    third: float


@kernel(**QUICK, inline="always")
def right_side(
    system: System, step: Step, fields: Fields, right: np.ndarray, shares: Shares, count: int
) -> None:
    """y from its last image and the differences before, q = P(y), right = b + s (2 q - y)."""
    y, q, b, bound, penalty = fields.y, fields.q, step.imposed, step.bound, system.solver.penalty
    images, last = system.solver.images, system.solver.last
    first, second, third = (count + 2) % 3, (count + 1) % 3, count % 3
    for c in range(2):
        for j in range(y.shape[1]):
            for i in range(y.shape[2]):
                combined = shares.first * images[first, c, j, i]
                combined += shares.second * images[second, c, j, i]
                combined += shares.third * images[third, c, j, i]
                y[c, j, i] = last[1, c, j, i] - combined
    for j in range(y.shape[1]):
        for i in range(y.shape[2]):
            forward, lateral = y[0, j, i], y[1, j, i]
            f = shrink(forward, lateral, bound[0, i])
            q[0, j, i], q[1, j, i] = f * forward, f * lateral
            f = (2.0 * f - 1.0) * penalty[i]
            right[0, j, i] = b[0, j, i] + f * forward
            right[1, j, i] = b[1, j, i] + f * lateral


@kernel(**QUICK, inline="always")
def distance(system: System, a: np.ndarray, b: np.ndarray) -> float:
    """Upper bound on Sum weight |a - b|, by Schwarz's inequality."""
    total = 0.0
    for j in range(a.shape[1]):
        for i in range(a.shape[2]):
            ahead, aside = a[0, j, i] - b[0, j, i], a[1, j, i] - b[1, j, i]
            total += system.weight[i] * (ahead * ahead + aside * aside)
    return np.sqrt(system.solver.area * total)


@kernel(inline="always")
def forget(solver: Resolvent) -> None:
    """Start the acceleration from nothing."""
    for a in range(3):
        for c in range(2):
            for j in range(solver.changes.shape[2]):
                for i in range(solver.changes.shape[3]):
                    solver.changes[a, c, j, i] = solver.images[a, c, j, i] = 0.0


@kernel(**QUICK, inline="always")
def accelerate(system: System, fields: Fields, v: np.ndarray, count: int) -> Shares:
    """Note the change RELAXATION (v - q) of y and its image; returns the shares of the differences
    with the least change.  count: of changes noted since `forget`."""
    y, q, solver, weight = fields.y, fields.q, system.solver, system.weight
    changes, images, last = solver.changes, solver.images, solver.last
    slot, second, third = count % 3, (count + 2) % 3, (count + 1) % 3
    is_first = count == 0
    aa = ab = ac = bb = bc = cc = ra = rb = rc = 0.0
    for c in range(2):
        for j in range(y.shape[1]):
            for i in range(y.shape[2]):
                change = RELAXATION * (v[c, j, i] - q[c, j, i])
                image = y[c, j, i] + change
                x = 0.0 if is_first else change - last[0, c, j, i]
                changes[slot, c, j, i] = x
                images[slot, c, j, i] = 0.0 if is_first else image - last[1, c, j, i]
                last[0, c, j, i], last[1, c, j, i] = change, image
                metric = weight[i] * solver.penalty[i]
                u, w = changes[second, c, j, i], changes[third, c, j, i]
                mx, mu, mw = metric * x, metric * u, metric * w
                aa += mx * x
                ab += mx * u
                ac += mx * w
                bb += mu * u
                bc += mu * w
                cc += mw * w
                ra += mx * change
                rb += mu * change
                rc += mw * change
    # normal equations, by elimination; a difference of no length has no share
    ridge = RIDGE * max(aa, bb, cc) + 1e-300
    aa, bb, cc = aa + ridge, bb + ridge, cc + ridge
    bb, bc, rb = bb - ab * ab / aa, bc - ab * ac / aa, rb - ab * ra / aa
    cc, rc = cc - ac * ac / aa, rc - ac * ra / aa
    of_third = (rc - bc * rb / bb) / (cc - bc * bc / bb)
    of_second = (rb - bc * of_third) / bb
    return Shares((ra - ab * of_second - ac * of_third) / aa, of_second, of_third)


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
    right, v, _ = fields.scratch
    solver, none = system.solver, Shares(0.0, 0.0, 0.0)
    displacement, residual, before, spent = 0.0, np.inf, np.inf, 0.0
    iterations, count, shares = 0, 0, none
    forget(solver)
    copy(solver.last[1], fields.y)
    while iterations < MOST_ITERATIONS:
        right_side(system, step, fields, right, shares, count)
        multiply(solver.inverse, right, v)
        if balance is not None:
            excess = balance.load - forward_force(system, v)
            displacement = excess / (balance.stiffness + balance.slope)
            add(v, displacement, balance.response)
        iterations += 1
        residual = distance(system, v, fields.q)
        if count > 1 and not residual <= before:  # back to the plain step, which never fails
            forget(solver)
            count, shares = 0, none
            continue
        if not residual > step.tolerance:
            break
        before = residual
        shares = accelerate(system, fields, v, count)
        count += 1
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
