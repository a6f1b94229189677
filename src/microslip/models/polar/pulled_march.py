"""A march of rings times angles that is pulled (models/pull.py), solved by over-relaxed ADMM.

The unknown of the body joins the quadratic part of an iteration: with M = (A + penalty)^-1, right
side r, e the unit forward displacement of all points and f the forward force,

    free = M (r + e x),   stiffness x + f(free) = load,
    so   x = (load - f(M r)) / (stiffness + f(M e)).

M e is the same in every iteration, so that the body costs a sum and an addition in each.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import coulomb_residual
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.point_fields import add, copy, move_forward, rigid_displacement, sum_forces
from microslip.models.polar.angular_modes import apply_sectors
from microslip.models.polar.folding import fold, unfold
from microslip.models.polar.march import (
    FEWEST_BETWEEN,
    MAX_ITERATIONS,
    MOST_BETWEEN,
    SLOWEST_RATE,
    Points,
    Scratch,
    Step,
    Unknowns,
    fill_slip,
    project_relaxed,
    shrink_onto,
)
from microslip.models.pull import Pull, stage_load, stage_stiffness, starting_place


class Followed(NamedTuple):
    """How the points follow the body.

    Attributes
    ----------
    tractions : np.ndarray, shape (2, M, N)
        M e.
    slope : float
        Forward force of M e.
    """

    tractions: np.ndarray
    slope: float


class Equation(NamedTuple):
    """That of the body in a stage, and the place to begin with.

    Attributes
    ----------
    stiffness, load : float
        Of the body.
    place : float
        First guess of how far it moves.
    """

    stiffness: float
    load: float
    place: float


@kernel(inline="always")
def _forward(weight, q):
    """Forward force of tractions."""
    force = 0.0
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            force += weight[i] * q[0, j, i]
    return force


@kernel
def _followed(points, shape, scratch):
    """The Followed of a contact."""
    tractions = np.zeros(shape)
    tractions[0] = 1.0
    fold(tractions, scratch.folded)
    apply_sectors(points.inverse, scratch.folded, scratch.image)
    unfold(scratch.image, tractions)
    return Followed(tractions, _forward(points.weight, tractions))


@kernel
def _residual(points, step, equation, place, state, scratch) -> float:
    """Fill slip at a place; returns how far both laws are from being kept, as a force."""
    (q, _), slip = state
    fill_slip(points.influence, step.b, q, scratch.folded, scratch.image, slip)
    move_forward(slip, place)
    left = coulomb_residual(q, slip, step.bound, points.weight, points.penalty)
    return left + abs(equation.load - equation.stiffness * place - _forward(points.weight, q))


@kernel
def _iterate(points, step, equation, followed, unknowns, scratch) -> float:
    """One iteration, in place; returns the place of the body."""
    (q, dual), (folded, image, free), penalty = unknowns, scratch, points.penalty
    for c in range(2):
        for j in range(q.shape[1]):
            for i in range(q.shape[2]):
                kept = q[c, j, i] - dual[c, j, i]
                free[c, j, i] = step.b[c, j, i] + penalty[i] * kept
    fold(free, folded)
    apply_sectors(points.inverse, folded, image)
    unfold(image, free)
    left = equation.load - _forward(points.weight, free)
    place = left / (equation.stiffness + followed.slope)
    add(free, place, followed.tractions)
    project_relaxed(free, step.bound, q, dual)
    return place


@kernel
def solve_pulled_step(
    points: Points,
    step: Step,
    equation: Equation,
    followed: Followed,
    state: tuple,
    scratch: Scratch,
) -> tuple:
    """Solve one Coulomb step and for the place of the body, in place.

    Parameters
    ----------
    points : march.Points
        The contact.
    step : march.Step
        What is asked for, at the place 0 of the body.
    equation : Equation
        Of the body.
    followed : Followed
        Of the contact.
    state : tuple
        march.Unknowns, start and result, and slip, shape (2, M, N), which receives b + e x - A q.
    scratch : march.Scratch
        Room.

    Returns
    -------
    tuple
        Iterations, residual, place; -1 iterations: interrupted.
    """
    (unknowns, slip), place, tolerance = state, equation.place, step.tolerance
    residual = _residual(points, step, equation, place, state, scratch)
    iterations, between, spent = 0, FEWEST_BETWEEN, 0.0
    while residual > tolerance and iterations < MAX_ITERATIONS:
        for _ in range(between):
            place = _iterate(points, step, equation, followed, unknowns, scratch)
        iterations += between
        spent += between * 8.0 * slip.shape[1] * slip.shape[2] * slip.shape[2]
        if spent > BETWEEN_LOOKS:
            spent = 0.0
            if interrupted():
                return -1, residual, place
        before = residual
        residual = _residual(points, step, equation, place, state, scratch)
        rate = np.log(max(residual, 1e-300) / before) / between
        due = np.log(tolerance / max(residual, 1e-300)) / min(rate, SLOWEST_RATE)
        between = int(min(max(np.ceil(due), FEWEST_BETWEEN), MOST_BETWEEN))
    return iterations, residual, place


class PulledStages(NamedTuple):
    """What every stage adds, for the next march; see march.Stages.

    Attributes
    ----------
    added, duals : np.ndarray, shape (steps, stages, 2, M, N)
        Filled by a march.
    advances : np.ndarray, shape (steps, stages)
        How far the body moves in a stage, likewise.
    known : bool
        Whether they are those of another march already, and to be read as first guesses.
    """

    added: np.ndarray
    duals: np.ndarray
    advances: np.ndarray
    known: bool


@kernel
def _impose(motion, ahead, positions, out):
    """Fill out with a rigid displacement, and what `ahead` has of each ring besides, if any."""
    rigid_displacement(motion, positions, out)
    forward, lateral = positions
    for i in range(ahead.shape[1]):
        for j in range(out.shape[1]):
            out[0, j, i] += ahead[0, i] + ahead[2, i] * lateral[j, i]
            out[1, j, i] += ahead[1, i] - ahead[2, i] * forward[j, i]


@kernel
def pulled_march(
    points: Points,
    imposed: tuple,
    pull: Pull,
    state: np.ndarray,
    known: PulledStages,
    settings: tuple,
) -> tuple:
    """March along a path from which the contact may stay behind, or run ahead.

    Parameters
    ----------
    points : march.Points
        The contact.
    imposed : tuple
        models.path.LoadingPath, whose integrator ends with the step; what each ring does besides
        (forward, lateral, angle), shape (1 + steps stages, 3, N), at the start and at every stage,
        or (1 + steps stages, 3, 0) where all rings follow the path.
    pull : models.pull.Pull
        What pulls.
    state : np.ndarray, shape (2, M, N)
        Tractions at the start.
    known : PulledStages
        First guesses, and filled with what this march finds.
    settings : tuple
        Tolerance of every stage, a force over mu F_z; forces, shape (steps + 1, 3), and x and x' at
        the phases, shape (steps + 1, 2), to be filled.

    Returns
    -------
    tuple
        State at the end, residual sum, iterations, whether it was interrupted.
    """
    path, ahead = imposed
    weight, positions, bounds = points.weight, points.positions, path.bounds
    (tolerance, forces, body), stages = settings, path.stages.shape[1]
    q, before = state.copy(), np.empty_like(state)
    rigid, z, b = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    slips, rates = np.empty((stages, *q.shape)), np.empty(stages)
    unknowns = Unknowns(q, np.zeros_like(q))
    folded = np.empty((points.parts, 2 * q.shape[1] // points.parts, q.shape[2]))
    scratch = Scratch(folded, np.empty_like(folded), np.empty_like(q))
    followed = _followed(points, q.shape, scratch)
    _impose(path.positions[0], ahead[0], positions, rigid)
    fill_slip(points.influence, rigid, q, folded, scratch.image, z)
    add(z, -2.0, z)
    sum_forces(q, weight, positions, forces[0])
    body[0, 0], body[0, 1] = starting_place(pull, forces[0, 0]), pull.start[1]
    move_forward(z, -body[0, 0])
    total, iterations, spent = 0.0, 0, 0.0
    for k in range(path.stages.shape[0]):
        length = pull.lengths[k]
        for s in range(stages):
            at = 1 + k * stages + s
            _impose(path.stages[k, s], ahead[at], positions, rigid)
            past_place, past_rate = body[k, 0], body[k, 1]
            copy(b, z)
            add(b, 1.0, rigid)
            for j in range(s):
                add(b, -path.carry[s, j], slips[j])
                past_place += path.carry[s, j] * known.advances[k, j]
                past_rate += path.carry[s, j] * rates[j]
            move_forward(b, past_place)
            copy(before, q)
            if known.known:
                add(q, 1.0, known.added[k, s])
                copy(unknowns.dual, known.duals[k, s])
            elif k > 0:
                copy(unknowns.dual, known.duals[k - 1, s])
                known.advances[k, s] = known.advances[k - 1, s]
            else:
                known.advances[k, s] = 0.0
            bound = bounds[min(at, len(bounds) - 1)]
            shrink_onto(q, bound)
            stiffness = stage_stiffness(pull, length)
            load = stage_load(pull, length, past_place, past_rate)
            equation = Equation(stiffness, load, known.advances[k, s])
            count, residual, advance = solve_pulled_step(
                points, Step(b, bound, tolerance), equation, followed, (unknowns, slips[s]), scratch
            )
            spent += count * 8.0 * q.shape[1] * q.shape[2] * q.shape[2]
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return q, total, iterations, True
            spent = 0.0 if spent > BETWEEN_LOOKS else spent
            known.advances[k, s] = advance
            rates[s] = advance / length - past_rate
            copy(known.added[k, s], q)
            add(known.added[k, s], -1.0, before)
            copy(known.duals[k, s], unknowns.dual)
            iterations += count
            total += residual
        body[k + 1, 0], body[k + 1, 1] = past_place + advance, advance / length
        copy(z, b)
        add(z, -1.0, slips[stages - 1])
        add(z, -1.0, rigid)
        move_forward(z, -past_place)
        sum_forces(q, weight, positions, forces[k + 1])
    return q, total, iterations, False
