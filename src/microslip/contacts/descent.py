"""Spectral projected gradient method for the Coulomb steps of contacts without a cheap resolvent
(squares).

Gradient steps have Barzilai-Borwein lengths without a line search, because rounding errors of the
energy are much larger than those of the tractions.  If the residual does not decrease for a number
of iterations, shorter steps that always lower the energy are used until the residual decreases.

For a driven body, the secant method finds the displacement d at which the forces balance.  The
forward force never decreases as d increases, and its slope is at most the stiffness of the contact.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.interrupts import BETWEEN_LOOKS, interrupted
from microslip.contacts.operators import multiply
from microslip.contacts.step import Balance, Fields, Step, step_solver
from microslip.contacts.system import (
    COMPLIANCE,
    System,
    copy,
    forward_force,
    move_forward,
    project,
)
from microslip.foundation.compiled import kernel

MOST_ITERATIONS = 5000
"""Largest number of iterations of a step."""
PATIENCE = 60
"""Default of Descent.patience, calibrated by benchmarks/splitting.py."""
SHORT_STEP_BELOW = 0.3
"""Ratio of the two Barzilai-Borwein lengths below which the shorter one is used; usual values are
0.1 to 0.5 (Zhou, Gao and Dai 2006)."""
MOST_DISPLACEMENTS = 60
"""Largest number of trial displacements of a driven body in each step."""
FLATTEST = 1e-3
"""Smallest slope of a secant, divided by the largest possible slope."""
INNER = 0.3
"""Allowed residual at a trial displacement, divided by the tolerance of the driven step."""


class Descent(NamedTuple):
    """The solver of a contact without a resolvent.

    Attributes
    ----------
    largest : float
        Upper bound on the eigenvalues of A.
    patience : int
        Number of iterations in which Barzilai-Borwein steps must halve the residual.
    length : np.ndarray, shape (1,)
        Length of the last gradient step.  The next Coulomb step begins with the same length.
    sums : np.ndarray, shape (3, columns)
        Scratch array with a separate sum for each column, so that the compiler can vectorise the
        sums.
    """

    largest: float
    patience: int
    length: np.ndarray
    sums: np.ndarray

    def own(self) -> Descent:
        """Return a copy of this solver with separate scratch arrays."""
        return self._replace(length=self.length.copy(), sums=np.empty_like(self.sums))


@kernel
def _respond(system: System, fields: Fields, response: np.ndarray, slope: np.ndarray) -> None:
    """Fill the slope with its upper bound, the stiffness.  The response is not used."""
    slope[0] = system.stiffness


@kernel
def descend_driven(
    system: System, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step of a driven contact from the initial guess fields.y; see
    step.solve_driven_step."""
    copy(fields.q, fields.y)
    project(fields.q, step.bound)
    steepest = balance.stiffness + balance.slope[0]
    b, place, slope = step.imposed.copy(), 0.0, steepest
    inner = Step(b, step.bound, INNER * step.tolerance)
    low, high, before, last_gap = -np.inf, np.inf, np.nan, np.nan
    iterations, error = 0, np.inf
    for _ in range(MOST_DISPLACEMENTS):
        copy(b, step.imposed)
        move_forward(place, b)
        count, residual = _descend(system, inner, fields)
        if count < 0:
            return -1, residual, place
        iterations += count
        gap = balance.load - balance.stiffness * place - forward_force(system, fields.q)
        error = residual + abs(gap)
        if error <= step.tolerance:
            break
        if gap > 0.0:
            low = max(low, place)
        else:
            high = min(high, place)
        if place != before and not np.isnan(before):
            slope = (last_gap - gap) / (place - before)
            slope = min(max(slope, FLATTEST * steepest), steepest)
        before, last_gap = place, gap
        place += gap / slope
        if not low < place < high:
            place = 0.5 * (low + high)
    copy(fields.y, fields.q)
    return iterations, error, place


@step_solver(Descent, descend_driven, _respond)
@kernel
def descend(
    system: System, balance: Balance, step: Step, fields: Fields
) -> tuple[int, float, float]:
    """Solve a Coulomb step from the initial guess fields.y; see step.solve_step."""
    copy(fields.q, fields.y)
    project(fields.q, step.bound)
    count, residual = _descend(system, step, fields)
    copy(fields.y, fields.q)
    return count, residual, 0.0


@kernel
def _descend(system: System, step: Step, fields: Fields) -> tuple[int, float]:
    """Solve a step at a fixed displacement of the body.

    Returns the number of iterations (-1 after an interrupt) and the residual.
    """
    q, solver = fields.q, system.solver
    trial, elastic = fields.scratch[0], fields.scratch[1]
    copy(trial, q)
    between = int(BETWEEN_LOOKS / (100.0 * q.size)) + 1
    best, best_at, residual = np.inf, 0, np.inf
    for iteration in range(MOST_ITERATIONS):
        multiply(system.operators, COMPLIANCE, trial, elastic)
        dd, ds, ss = _replace(system, step, fields, trial, elastic)
        if iteration == 0:
            length = solver.length[0]  # of the previous Coulomb step
        elif iteration - best_at > solver.patience or not ds > 0.0:
            length = 1.0 / solver.largest
        elif ds * ds < SHORT_STEP_BELOW * dd * ss:
            length = ds / ss
        else:
            length = dd / ds
        solver.length[0] = length
        residual = _projected_step(system, step, fields, length, trial)
        if residual <= step.tolerance:
            return iteration, residual
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration % between == between - 1 and interrupted():
            return -1, residual
    return MOST_ITERATIONS, residual


@kernel
def _projected_step(
    system: System, step: Step, fields: Fields, length: float, trial: np.ndarray
) -> float:
    """Fill `trial` with P(q + length * slip).  Returns the residual, see
    coulomb.coulomb_residual."""
    q, slip, sums = fields.q, fields.slip, system.solver.sums[0]
    scale, bound, weight, columns = system.scale, step.bound, system.weight, len(sums)
    sums[:] = 0.0
    for first in range(0, q.shape[1], columns):
        for j in range(columns):
            i = first + j
            forward, lateral = q[0, i] + length * slip[0, i], q[1, i] + length * slip[1, i]
            f = shrink(forward, lateral, bound[i])
            trial[0, i], trial[1, i] = f * forward, f * lateral
            forward, lateral = q[0, i] + slip[0, i] / scale[i], q[1, i] + slip[1, i] / scale[i]
            f = shrink(forward, lateral, bound[i])
            forward, lateral = f * forward - q[0, i], f * lateral - q[1, i]
            sums[j] += weight[i] * np.sqrt(forward * forward + lateral * lateral)
    return sums.sum()


@kernel
def _replace(
    system: System, step: Step, fields: Fields, trial: np.ndarray, elastic: np.ndarray
) -> tuple[float, float, float]:
    """Set q = trial and slip = b - A q.

    Returns <dq, dq>, -<dq, ds> and <ds, ds> of the changes of q and slip, weighted with the areas.
    """
    q, slip, sums, b, bound = fields.q, fields.slip, system.solver.sums, step.imposed, step.bound
    weight, columns = system.weight, sums.shape[1]
    sums[:] = 0.0
    for c in range(2):
        for first in range(0, q.shape[1], columns):
            for j in range(columns):
                i = first + j
                dq = trial[c, i] - q[c, i]
                now = b[c, i] - elastic[c, i]
                ds = slip[c, i] - now if bound[i] > 0.0 else 0.0
                sums[0, j] += weight[i] * dq * dq
                sums[1, j] += weight[i] * dq * ds
                sums[2, j] += weight[i] * ds * ds
                q[c, i], slip[c, i] = trial[c, i], now
    return sums[0].sum(), sums[1].sum(), sums[2].sum()
