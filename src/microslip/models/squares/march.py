"""A march of squares, compiled.

A step is solved by a projected gradient method with Barzilai-Borwein steps, without line search:
the comparison of energies that a line search needs drowns in rounding long before the tractions
do.  Where the residual does not fall for a while, steps short enough to let the energy fall for
certain take over until it does.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import extended, shrink
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.path import LoadingPath
from microslip.models.point_fields import add, copy, rigid_displacement, sum_forces
from microslip.models.squares.convolution import Convolution, convolve

MAX_ITERATIONS = 5000
PATIENCE = 60
"""Iterations granted to the Barzilai-Borwein steps for halving the residual."""
SHORT_STEP_BELOW = 0.3
"""Ratio of the two Barzilai-Borwein steps below which the shorter one is taken."""


class Squares(NamedTuple):
    """The squares of a contact, n along a side, for compiled code.

    Attributes
    ----------
    operator : convolution.Convolution
        A.
    workspace : tuple of np.ndarray
        Scratch of it, see `convolution.workspace`.
    scale, largest : float
        Self-influence, and an upper bound on the eigenvalues of A.
    bound : np.ndarray, shape (n, n)
        Friction bound.
    area : float
        Of a square.
    """

    operator: Convolution
    workspace: tuple
    scale: float
    largest: float
    bound: np.ndarray
    area: float


class Guide(NamedTuple):
    """Tractions of every stage, of a march near by and of this one.

    Attributes
    ----------
    known : np.ndarray, shape (steps, stages, 2, n, n)
        Of the march near by, read if `given`.
    given : bool
        Whether there is one.
    found : np.ndarray, shape (steps or 1, stages, 2, n, n)
        Filled with those of this march, or only of its last step if there is no room for more.
    """

    known: np.ndarray
    given: bool
    found: np.ndarray


class Trial(NamedTuple):
    """Scratch of the step solver.

    Attributes
    ----------
    q, elastic : np.ndarray, shape (2, n, n)
        Tractions to be tried, and the displacement A q that they cause.
    sums : np.ndarray, shape (3, n)
        Sums go into it column by column, which the compiler turns into vector instructions.
    """

    q: np.ndarray
    elastic: np.ndarray
    sums: np.ndarray


@kernel
def march(
    squares: Squares,
    positions: tuple,
    path: LoadingPath,
    state: np.ndarray,
    tolerance: float,
    guide: Guide,
) -> tuple:
    """March along a path.

    Parameters
    ----------
    squares : Squares
        The contact.
    positions : tuple of np.ndarray, shape (n, n) each
        Forward and lateral.
    path : models.path.LoadingPath
        What is imposed; the bounds in it are not looked at.
    state : np.ndarray, shape (2, n, n)
        Tractions at the start.
    tolerance : float
        Of every stage, a force over mu F_z.
    guide : Guide
        First guesses, and filled with what this march finds.

    Returns
    -------
    tuple
        State at the end, forces (steps + 1, 3), residual sum, iterations, whether it was
        interrupted.
    """
    steps, stages, end = path.stages.shape[0], path.stages.shape[1], path.end
    bound, weight = squares.bound, np.full(state.shape[2], squares.area)
    q, at_end = state.copy(), state.copy()
    rigid, z, b = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    slips, forces = np.empty((stages, *q.shape)), np.empty((steps + 1, 3))
    last_guide = q.copy()
    before = np.empty((2, stages, *q.shape))
    length = 1.0 / squares.scale
    convolve(squares.operator, squares.workspace, q, z)
    rigid_displacement(path.positions[0], positions, rigid)
    add(z, -1.0, rigid)
    sum_forces(q, weight, positions, forces[0])
    total, iterations, spent = 0.0, 0, 0.0
    for k in range(steps):
        for s in range(stages):
            rigid_displacement(path.stages[k, s], positions, rigid)
            copy(b, z)
            add(b, 1.0, rigid)
            for j in range(s):
                add(b, -path.carry[s, j], slips[j])
            if guide.given:  # what the other march added in this stage is added here, too
                extrapolate(q, guide.known[k, s], last_guide, bound, q)
                copy(last_guide, guide.known[k, s])
            elif k > 1:
                extrapolate(before[0, s], before[0, s], before[1, s], bound, q)
            count, residual, length = solve_step(squares, b, q, slips[s], length, tolerance)
            spent += count * 100.0 * q.size
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return at_end, forces, total, iterations, True
            if spent > BETWEEN_LOOKS:
                spent = 0.0
            iterations += count
            total += residual
            copy(before[1, s], before[0, s])
            copy(before[0, s], q)
            copy(guide.found[min(k, len(guide.found) - 1), s], q)
        for c in range(2):
            for i in range(q.shape[1]):
                for j in range(q.shape[2]):
                    now = b[c, i, j] - (slips[stages - 1, c, i, j] + rigid[c, i, j])
                    z[c, i, j] = extended(z[c, i, j], now, end)
                    at_end[c, i, j] = extended(at_end[c, i, j], q[c, i, j], end)
        sum_forces(at_end, weight, positions, forces[k + 1])
    return at_end, forces, total, iterations, False


@kernel
def solve_step(
    squares: Squares,
    b: np.ndarray,
    q: np.ndarray,
    slip: np.ndarray,
    length: float,
    tolerance: float,
) -> tuple[int, float, float]:
    """Solve one Coulomb step in place.

    Parameters
    ----------
    squares : Squares
        The contact.
    b : np.ndarray, shape (2, n, n)
        Imposed displacement.
    q : np.ndarray, shape (2, n, n)
        Tractions, start and result; within the bound.
    slip : np.ndarray, shape (2, n, n)
        Receives b - A q.
    length : float
        Of the first gradient step to try.
    tolerance : float
        Of the residual, a force over mu F_z.

    Returns
    -------
    tuple
        Iterations, residual, last length; -1 iterations: interrupted.
    """
    trial = Trial(q.copy(), np.empty_like(q), np.empty((3, q.shape[2])))
    between = int(BETWEEN_LOOKS / (100.0 * q.size)) + 1
    best, best_at = np.inf, 0
    for iteration in range(MAX_ITERATIONS):
        convolve(squares.operator, squares.workspace, trial.q, trial.elastic)
        dd, ds, ss = _replace(squares.bound, b, q, slip, trial)
        if iteration == 0:
            pass  # nothing is known yet but the length that served the last step well
        elif iteration - best_at > PATIENCE or not ds > 0.0:
            length = 1.0 / squares.largest
        elif ds * ds < SHORT_STEP_BELOW * dd * ss:
            length = ds / ss
        else:
            length = dd / ds
        residual = squares.area * _projected_step(squares, q, slip, length, trial)
        if residual <= tolerance:
            return iteration, residual, length
        if residual < 0.5 * best:
            best, best_at = residual, iteration
        if iteration % between == between - 1 and interrupted():
            return -1, residual, length
    return MAX_ITERATIONS, residual, length


@kernel
def _projected_step(squares, q, slip, length, trial):
    """trial.q = P(q + length slip); returns the residual over the area, as
    coulomb.coulomb_residual."""
    bound, scale, new, room = squares.bound, squares.scale, trial.q, trial.sums[0]
    room[:] = 0.0
    for i in range(q.shape[1]):
        for j in range(q.shape[2]):
            forward = q[0, i, j] + length * slip[0, i, j]
            lateral = q[1, i, j] + length * slip[1, i, j]
            f = shrink(forward, lateral, bound[i, j])
            new[0, i, j], new[1, i, j] = f * forward, f * lateral
            forward, lateral = (
                q[0, i, j] + slip[0, i, j] / scale,
                q[1, i, j] + slip[1, i, j] / scale,
            )
            f = shrink(forward, lateral, bound[i, j])
            forward, lateral = f * forward - q[0, i, j], f * lateral - q[1, i, j]
            room[j] += np.sqrt(forward * forward + lateral * lateral)
    return room.sum()


@kernel
def _replace(bound, b, q, slip, trial):
    """q = trial.q, slip = b - A q; returns <dq, dq>, -<dq, ds> and <ds, ds> of the change."""
    new, elastic, room = trial.q, trial.elastic, trial.sums
    room[:] = 0.0
    for c in range(2):
        for i in range(q.shape[1]):
            for j in range(q.shape[2]):
                dq = new[c, i, j] - q[c, i, j]
                now = b[c, i, j] - elastic[c, i, j]
                ds = slip[c, i, j] - now if bound[i, j] > 0.0 else 0.0
                room[0, j] += dq * dq
                room[1, j] += dq * ds
                room[2, j] += ds * ds
                q[c, i, j], slip[c, i, j] = new[c, i, j], now
    return room[0].sum(), room[1].sum(), room[2].sum()


@kernel
def extrapolate(
    start: np.ndarray, later: np.ndarray, earlier: np.ndarray, bound: np.ndarray, out: np.ndarray
) -> None:
    """out = P(start + later - earlier)."""
    for i in range(bound.shape[0]):
        for j in range(bound.shape[1]):
            forward = start[0, i, j] + later[0, i, j] - earlier[0, i, j]
            lateral = start[1, i, j] + later[1, i, j] - earlier[1, i, j]
            f = shrink(forward, lateral, bound[i, j])
            out[0, i, j], out[1, i, j] = f * forward, f * lateral
