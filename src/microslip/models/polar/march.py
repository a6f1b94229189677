"""A march of rings times angles, compiled: every stage is solved by over-relaxed ADMM.

The quadratic part goes through the blocks of the elastic operator (angular_modes.py), factorised
once; the friction bound is kept to point by point.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import coulomb_residual, extended, shrink
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.path import LoadingPath
from microslip.models.point_fields import add, copy, rigid_displacement, sum_forces
from microslip.models.polar.angular_modes import Sectors, apply_sectors
from microslip.models.polar.folding import fold, unfold

MAX_ITERATIONS = 4000
RELAXATION = 1.7
FEWEST_BETWEEN, MOST_BETWEEN = 2, 12
"""Iterations between two looks at the residual, which costs more than an iteration."""
SLOWEST_RATE = -0.05
"""Of the logarithm of the residual in an iteration: as if it fell at least so fast."""


class Points(NamedTuple):
    """The points of a contact, N rings times M angles on half the disc or 2 M on all of it, for
    compiled code.

    Attributes
    ----------
    influence, inverse : angular_modes.Sectors
        A and (A + penalty)^-1.
    penalty : np.ndarray, shape (N,)
        Of ADMM, which is also the scale of the residual.
    weight : np.ndarray, shape (N,)
        Area of a point of each ring.
    positions : tuple of np.ndarray, shape (M, N) each
        Forward and lateral.
    parts : int
        Of folded tractions: 4, or 8 of a whole disc, which has 2 M angles.
    """

    influence: Sectors
    inverse: Sectors
    penalty: np.ndarray
    weight: np.ndarray
    positions: tuple
    parts: int


class Stages(NamedTuple):
    """What every stage of a march adds to the tractions, and its dual: for the next march.

    Attributes
    ----------
    added, duals : np.ndarray, shape (steps, stages, 2, M, N)
        Filled by a march.
    known : bool
        Whether they are those of another march already, and to be read as first guesses.
    """

    added: np.ndarray
    duals: np.ndarray
    known: bool


class Unknowns(NamedTuple):
    """What a step changes.

    Attributes
    ----------
    q : np.ndarray, shape (2, M, N)
        Tractions, start and result; within the bound.
    dual : np.ndarray, shape (2, M, N)
        Slip over penalty, kept from step to step.
    """

    q: np.ndarray
    dual: np.ndarray


class Scratch(NamedTuple):
    """Room for folded tractions and for full ones.

    Attributes
    ----------
    folded, image : np.ndarray, shape (4, M/2, N)
        See `folding.fold`.
    free : np.ndarray, shape (2, M, N)
        Tractions before they are projected.
    """

    folded: np.ndarray
    image: np.ndarray
    free: np.ndarray


@kernel
def fill_slip(
    influence: Sectors,
    b: np.ndarray,
    q: np.ndarray,
    folded: np.ndarray,
    image: np.ndarray,
    slip: np.ndarray,
) -> None:
    """slip = b - A q; folded, image: room for folded tractions."""
    fold(q, folded)
    apply_sectors(influence, folded, image)
    unfold(image, slip)
    for c in range(2):
        for j in range(q.shape[1]):
            for i in range(q.shape[2]):
                slip[c, j, i] = b[c, j, i] - slip[c, j, i]


@kernel
def project_relaxed(free: np.ndarray, bound: np.ndarray, q: np.ndarray, dual: np.ndarray) -> None:
    """Over-relaxed projection on the friction bound, the remainder kept in `dual`; in place."""
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward = RELAXATION * free[0, j, i] + (1 - RELAXATION) * q[0, j, i] + dual[0, j, i]
            lateral = RELAXATION * free[1, j, i] + (1 - RELAXATION) * q[1, j, i] + dual[1, j, i]
            f = shrink(forward, lateral, bound[i])
            q[0, j, i] = f * forward
            q[1, j, i] = f * lateral
            dual[0, j, i] = forward - f * forward
            dual[1, j, i] = lateral - f * lateral


class Step(NamedTuple):
    """A Coulomb step to be solved.

    Attributes
    ----------
    b : np.ndarray, shape (2, M, N)
        Imposed displacement.
    bound : np.ndarray, shape (N,)
        Friction bound of each ring.
    tolerance : float
        Of the residual, a force over mu F_z.
    """

    b: np.ndarray
    bound: np.ndarray
    tolerance: float


@kernel
def solve_step(
    points: Points, step: Step, unknowns: Unknowns, slip: np.ndarray, scratch: Scratch
) -> tuple[int, float]:
    """Solve one Coulomb step by over-relaxed ADMM, in place.

    Parameters
    ----------
    points : Points
        The contact.
    step : Step
        What is asked for.
    unknowns : Unknowns
        Start and result.
    slip : np.ndarray, shape (2, M, N)
        Receives b - A q.
    scratch : Scratch
        Room.

    Returns
    -------
    tuple
        Iterations and residual; -1 iterations: interrupted.
    """
    b, bound, tolerance = step.b, step.bound, step.tolerance
    q, dual, weight, penalty = unknowns.q, unknowns.dual, points.weight, points.penalty
    folded, image, free = scratch
    angles, n = q.shape[1], q.shape[2]
    fill_slip(points.influence, b, q, folded, image, slip)
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
            apply_sectors(points.inverse, folded, image)
            unfold(image, free)
            project_relaxed(free, bound, q, dual)
        iterations += between
        spent += between * 8.0 * angles * n * n
        if spent > BETWEEN_LOOKS:
            spent = 0.0
            if interrupted():
                return -1, residual
        fill_slip(points.influence, b, q, folded, image, slip)
        before, residual = residual, coulomb_residual(q, slip, bound, weight, penalty)
        # the residual falls geometrically: the next look is due where it should be small enough
        rate = np.log(max(residual, 1e-300) / before) / between
        due = np.log(tolerance / max(residual, 1e-300)) / min(rate, SLOWEST_RATE)
        between = int(min(max(np.ceil(due), FEWEST_BETWEEN), MOST_BETWEEN))
    return iterations, residual


@kernel
def shrink_onto(q: np.ndarray, bound: np.ndarray) -> None:
    """q projected on the friction bound, which may have become smaller; in place."""
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            f = shrink(q[0, j, i], q[1, j, i], bound[i])
            q[0, j, i] *= f
            q[1, j, i] *= f


@kernel
def march(
    points: Points,
    path: LoadingPath,
    state: np.ndarray,
    tolerance: float,
    known: Stages,
    forces: np.ndarray,
) -> tuple:
    """March along a path.

    Parameters
    ----------
    points : Points
        The contact.
    path : models.path.LoadingPath
        What is imposed; bounds (1 + steps stages, N) or (1, N).
    state : np.ndarray, shape (2, M, N)
        Tractions at the start.
    tolerance : float
        Of every stage, a force over mu F_z.
    known : Stages
        First guesses, and filled with what this march finds.
    forces : np.ndarray, shape (steps + 1, 3)
        Filled.

    Returns
    -------
    tuple
        State at the end, residual sum, iterations, whether it was interrupted.
    """
    weight, positions, bounds = points.weight, points.positions, path.bounds
    angles, n = state.shape[1], state.shape[2]
    stages = path.stages.shape[1]
    q, at_end, before = state.copy(), state.copy(), np.empty_like(state)
    rigid, z, b = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    slips = np.empty((stages, 2, angles, n))
    unknowns = Unknowns(q, np.zeros_like(q))
    folded = np.empty((points.parts, 2 * angles // points.parts, n))
    scratch = Scratch(folded, np.empty_like(folded), np.empty_like(q))
    rigid_displacement(path.positions[0], positions, rigid)
    fill_slip(points.influence, rigid, q, folded, scratch.image, z)
    add(z, -2.0, z)
    sum_forces(q, weight, positions, forces[0])
    total, iterations, spent = 0.0, 0, 0.0
    for k in range(path.stages.shape[0]):
        for s in range(stages):
            rigid_displacement(path.stages[k, s], positions, rigid)
            copy(b, z)
            add(b, 1.0, rigid)
            for j in range(s):
                add(b, -path.carry[s, j], slips[j])
            copy(before, q)
            if known.known:
                add(q, 1.0, known.added[k, s])
                copy(unknowns.dual, known.duals[k, s])
            elif k > 0:
                copy(unknowns.dual, known.duals[k - 1, s])
            bound = bounds[min(1 + k * stages + s, len(bounds) - 1)]
            shrink_onto(q, bound)
            step = Step(b, bound, tolerance)
            count, residual = solve_step(points, step, unknowns, slips[s], scratch)
            spent += count * 8.0 * angles * n * n
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return at_end, total, iterations, True
            spent = 0.0 if spent > BETWEEN_LOOKS else spent
            copy(known.added[k, s], q)
            add(known.added[k, s], -1.0, before)
            copy(known.duals[k, s], unknowns.dual)
            iterations += count
            total += residual
        for c in range(2):
            for j in range(angles):
                for i in range(n):
                    now = b[c, j, i] - (slips[stages - 1, c, j, i] + rigid[c, j, i])
                    z[c, j, i] = extended(z[c, j, i], now, path.end)
                    at_end[c, j, i] = extended(at_end[c, j, i], q[c, j, i], path.end)
        sum_forces(at_end, weight, positions, forces[k + 1])
    return at_end, total, iterations, False
