"""A march of squares that is pulled (models/pull.py): a search for the place of the body around
every step.

The forward force does not fall with the place, and never rises by more than the contact's own
stiffness.  So a secant finds the place where the forces balance, kept between places where they are
too large and too small.  Slow and plain: it checks what rings do in one go.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.point_fields import (
    add,
    copy,
    move_forward,
    rigid_displacement,
    sum_forces,
)
from microslip.models.pull import stage_load, stage_stiffness, starting_place
from microslip.models.squares.convolution import convolve
from microslip.models.squares.march import extrapolate, solve_step

MOST_PLACES = 60
FLATTEST = 1e-3
"""Least slope of the balance that a secant may claim, over its largest."""
INNER = 0.3
"""Share of the tolerance that a step at a place may leave."""


class Equation(NamedTuple):
    """That of the body in a stage, and where to begin.

    Attributes
    ----------
    stiffness, load : float
        Of the body.
    holding : float
        Of the contact without slip, at most.
    place : float
        First guess of how far the body moves.
    """

    stiffness: float
    load: float
    holding: float
    place: float


@kernel
def solve_pulled_step(squares, b, state, equation, tolerance) -> tuple:
    """Solve one Coulomb step and for the place of the body, in place.

    Parameters
    ----------
    squares : march.Squares
        The contact.
    b : np.ndarray, shape (2, n, n)
        Displacement imposed at the place 0.
    state : tuple
        Tractions, start and result, and slip, which receives b + e x - A q, shape (2, n, n) both;
        length of the first gradient step to try.
    equation : Equation
        Of the body.
    tolerance : float
        Of the residual of both laws, a force over mu F_z.

    Returns
    -------
    tuple
        Iterations, residual, last length, place; -1 iterations: interrupted.
    """
    (q, slip, length), steepest = state, equation.stiffness + equation.holding
    imposed, place, slope = np.empty_like(b), equation.place, steepest
    low, high, before, last_gap = -np.inf, np.inf, np.nan, np.nan
    iterations, left = 0, np.inf
    for _ in range(MOST_PLACES):
        copy(imposed, b)
        move_forward(imposed, place)
        count, residual, length = solve_step(squares, imposed, q, slip, length, INNER * tolerance)
        if count < 0:
            return -1, residual, length, place
        iterations += count
        gap = equation.load - equation.stiffness * place - squares.area * q[0].sum()
        left = residual + abs(gap)
        if left <= tolerance:
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
    return iterations, left, length, place


@kernel
def pulled_march(squares, positions, path, pull, state, settings) -> tuple:
    """March along a path from which the contact may stay behind, or run ahead.

    Parameters
    ----------
    squares : march.Squares
        The contact.
    positions : tuple of np.ndarray, shape (n, n) each
        Forward and lateral.
    path : models.path.LoadingPath
        Its integrator ends with the step; the bounds in it are not looked at.
    pull : models.pull.Pull
        What pulls.
    state : np.ndarray, shape (2, n, n)
        Tractions at the start.
    settings : tuple of float
        Tolerance of every stage, a force over mu F_z; stiffness of the contact without slip.

    Returns
    -------
    tuple
        State at the end, x and x' at the phases (steps + 1, 2), forces (steps + 1, 3), residual
        sum, iterations, whether it was interrupted.
    """
    steps, stages, (tolerance, holding) = path.stages.shape[0], path.stages.shape[1], settings
    bound, weight = squares.bound, np.full(state.shape[2], squares.area)
    q = state.copy()
    rigid, z, b = np.empty_like(q), np.empty_like(q), np.empty_like(q)
    slips, forces = np.empty((stages, *q.shape)), np.empty((steps + 1, 3))
    before, body = np.empty((2, stages, *q.shape)), np.empty((steps + 1, 2))
    advances, rates = np.zeros(stages), np.zeros(stages)
    length = 1.0 / squares.scale
    convolve(squares.operator, squares.workspace, q, z)
    rigid_displacement(path.positions[0], positions, rigid)
    add(z, -1.0, rigid)
    sum_forces(q, weight, positions, forces[0])
    body[0, 0], body[0, 1] = starting_place(pull, forces[0, 0]), pull.start[1]
    move_forward(z, -body[0, 0])
    total, iterations, spent = 0.0, 0, 0.0
    for k in range(steps):
        for s in range(stages):
            rigid_displacement(path.stages[k, s], positions, rigid)
            past_place, past_rate = body[k, 0], body[k, 1]
            copy(b, z)
            add(b, 1.0, rigid)
            for j in range(s):
                add(b, -path.carry[s, j], slips[j])
                past_place += path.carry[s, j] * advances[j]
                past_rate += path.carry[s, j] * rates[j]
            move_forward(b, past_place)
            if k > 1:
                extrapolate(before[0, s], before[0, s], before[1, s], bound, q)
            equation = Equation(
                stage_stiffness(pull, pull.lengths[k]),
                stage_load(pull, pull.lengths[k], past_place, past_rate),
                holding,
                advances[s],
            )
            count, residual, length, advances[s] = solve_pulled_step(
                squares, b, (q, slips[s], length), equation, tolerance
            )
            rates[s] = advances[s] / pull.lengths[k] - past_rate
            spent += count * 100.0 * q.size
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return q, body, forces, total, iterations, True
            if spent > BETWEEN_LOOKS:
                spent = 0.0
            iterations += count
            total += residual
            copy(before[1, s], before[0, s])
            copy(before[0, s], q)
        body[k + 1, 0] = past_place + advances[stages - 1]
        body[k + 1, 1] = advances[stages - 1] / pull.lengths[k]
        copy(z, b)
        add(z, -1.0, slips[stages - 1])
        add(z, -1.0, rigid)
        move_forward(z, -past_place)
        sum_forces(q, weight, positions, forces[k + 1])
    return q, body, forces, total, iterations, False
