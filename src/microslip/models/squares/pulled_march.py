"""A march of squares that is pulled (models/pull.py): a search for the place of the body around
every step.

The forward force does not fall with the place, and never rises by more than the contact's own
stiffness.  So a secant finds the place where the forces balance, kept between places where they are
too large and too small.  Slow and plain: it checks what rings do in one go.

A body may stand on several contacts of one kind, each in its own units: at a place x of the body
one whose u_lim is larger by `extent` is at x / extent, and its forces count by its `share` of the
load.  They are solved one by one, and the body feels the sum.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.path import LoadingPath
from microslip.models.point_fields import copy, move_forward, rigid_displacement, sum_forces
from microslip.models.pull import Pull, stage_load, stage_stiffness, starting_place
from microslip.models.squares.convolution import convolve
from microslip.models.squares.march import Squares, extrapolate, solve_step

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
        Of the contacts without slip, at most.
    place : float
        First guess of how far the body moves.
    """

    stiffness: float
    load: float
    holding: float
    place: float


class Carried(NamedTuple):
    """How a body stands on its C contacts.

    Attributes
    ----------
    shares, extents : np.ndarray, shape (C,)
        Of the load; u_lim over that of the body.
    """

    shares: np.ndarray
    extents: np.ndarray


@kernel
def _forward(squares, carried, q) -> float:
    """Forward force of all contacts."""
    force = 0.0
    for one in range(len(q)):
        force += carried.shares[one] * (squares.area * q[one, 0].sum())
    return force


@kernel
def solve_pulled_step(
    squares: Squares,
    carried: Carried,
    b: np.ndarray,
    state: tuple,
    equation: Equation,
    tolerance: float,
) -> tuple:
    """Solve one Coulomb step and for the place of the body, in place.

    Parameters
    ----------
    squares : march.Squares
        Every contact.
    carried : Carried
        By which of them.
    b : np.ndarray, shape (C, 2, n, n)
        Displacement imposed at the place 0.
    state : tuple
        Tractions, start and result, and slip, which receives b + e x - A q, shape (C, 2, n, n)
        both; length of the first gradient step to try, (C,), replaced by the last one.
    equation : Equation
        Of the body.
    tolerance : float
        Of the residual of both laws, a force over mu F_z.

    Returns
    -------
    tuple
        Iterations, residual, place; -1 iterations: interrupted.
    """
    (q, slip, lengths), steepest = state, equation.stiffness + equation.holding
    imposed, place, slope = np.empty_like(b[0]), equation.place, steepest
    low, high, before, last_gap = -np.inf, np.inf, np.nan, np.nan
    iterations, left = 0, np.inf
    for _ in range(MOST_PLACES):
        residual = 0.0
        for one in range(len(b)):
            copy(imposed, b[one])
            move_forward(imposed, place / carried.extents[one])
            count, own, lengths[one] = solve_step(
                squares, imposed, q[one], slip[one], lengths[one], INNER * tolerance
            )
            if count < 0:
                return -1, own, place
            iterations += count
            residual += carried.shares[one] * own
        gap = equation.load - equation.stiffness * place - _forward(squares, carried, q)
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
    return iterations, left, place


@kernel
def _sum_all(squares, carried, positions, q, one_contact, out):
    """Fill out with the forces of all contacts."""
    weight = np.full(q.shape[3], squares.area)
    out[:] = 0.0
    for one in range(len(q)):
        sum_forces(q[one], weight, positions, one_contact)
        for c in range(3):
            out[c] += carried.shares[one] * one_contact[c]


def pulled_march(
    squares: Squares,
    standing: tuple,
    path: LoadingPath,
    pull: Pull,
    state: np.ndarray,
    settings: tuple,
) -> tuple:
    """March along a path from which the contacts may stay behind, or run ahead.

    It is not compiled, since a step takes milliseconds.

    Parameters
    ----------
    squares : march.Squares
        Every contact.
    standing : tuple
        Positions of its squares, forward and lateral, shape (n, n) each; the Carried; what each
        contact does in its own units (forward, lateral, angle) at the start and at every stage,
        shape (C, 1 + steps stages, 3).
    path : models.path.LoadingPath
        Its integrator ends with the step; the positions and the bounds in it are not looked at.
    pull : models.pull.Pull
        What pulls.
    state : np.ndarray, shape (C, 2, n, n)
        Tractions at the start.
    settings : tuple of float
        Tolerance of every stage, a force over mu F_z; stiffness of the contacts without slip.

    Returns
    -------
    tuple
        State at the end, x and x' at the phases (steps + 1, 2), forces (steps + 1, 3), residual
        sum, iterations, whether it was interrupted.
    """
    steps, stages, (tolerance, holding) = path.stages.shape[0], path.stages.shape[1], settings
    (positions, carried, moved), contacts = standing, len(state)
    q = state.copy()
    rigid, elastic = np.empty_like(q), np.empty_like(q)
    slips, forces = np.empty((stages, *q.shape)), np.empty((steps + 1, 3))
    before, body = np.empty((2, stages, *q.shape)), np.empty((steps + 1, 2))
    advances, rates, force = np.zeros(stages), np.zeros(stages), np.empty(3)
    lengths = np.full(contacts, 1.0 / squares.scale)
    _sum_all(squares, carried, positions, q, force, forces[0])
    body[0] = starting_place(pull, forces[0, 0]), pull.start[1]
    for one in range(contacts):
        convolve(squares.operator, squares.workspace, q[one], elastic[one])
        rigid_displacement(moved[one, 0], positions, rigid[one])
    z = elastic - rigid
    _move_all(z, -body[0, 0], carried)
    total, iterations = 0.0, 0
    for k in range(steps):
        for s in range(stages):
            past_place, past_rate = body[k] + path.carry[s, :s] @ np.stack([advances, rates], 1)[:s]
            for one in range(contacts):
                rigid_displacement(moved[one, 1 + k * stages + s], positions, rigid[one])
                if k > 1:
                    start, earlier = before[0, s, one], before[1, s, one]
                    extrapolate(start, start, earlier, squares.bound, q[one])
            b = z + rigid
            for j in range(s):
                b -= path.carry[s, j] * slips[j]
            _move_all(b, past_place, carried)
            equation = Equation(
                stage_stiffness(pull, pull.lengths[k]),
                stage_load(pull, pull.lengths[k], past_place, past_rate),
                holding,
                advances[s],
            )
            count, residual, advances[s] = solve_pulled_step(
                squares, carried, b, (q, slips[s], lengths), equation, tolerance
            )
            if count < 0:
                return q, body, forces, total, iterations, True
            rates[s] = advances[s] / pull.lengths[k] - past_rate
            iterations, total = iterations + count, total + residual
            before[1, s], before[0, s] = before[0, s], q
        body[k + 1] = past_place + advances[-1], advances[-1] / pull.lengths[k]
        z = b - slips[-1] - rigid
        _move_all(z, -past_place, carried)
        _sum_all(squares, carried, positions, q, force, forces[k + 1])
    return q, body, forces, total, iterations, False


def _move_all(displacement, place, carried):
    """Add to displacements, (C, 2, n, n), that the body moves forward to a place."""
    displacement[:, 0] += (place / carried.extents)[:, None, None]
