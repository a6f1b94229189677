"""Time integration along a path (the march), for all contacts and drives.

With the rigid displacement w and z = A q - w, stage i of a step is a Coulomb step (step.py) for
tractions q_i and slip r_i,

    A q_i + r_i = b_i,     b_i = z + w(t + c_i h) - Sum_{j<i} (a_ij / gamma) r_j.

The last stage is the end of the step, after which z = b - r - w.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.contacts.coulomb import extended
from microslip.contacts.drive import Drive, stage_balance, starting_place
from microslip.contacts.interrupts import BETWEEN_LOOKS, interrupted
from microslip.contacts.operators import multiply
from microslip.contacts.step import (
    LEVELS,
    Balance,
    Fields,
    Step,
    response_to_drive,
    solve_driven_step,
    solve_step,
)
from microslip.contacts.system import (
    COMPLIANCE,
    System,
    add,
    add_displacement,
    copy,
    move_forward,
    sum_forces,
)
from microslip.foundation.compiled import kernel


class Loading(NamedTuple):
    """Motion and friction bounds imposed on the contacts along a path, and coefficients of the
    integrator.

    Attributes
    ----------
    motion : np.ndarray, shape (1 + steps stages, contacts, 3)
        Forward, lateral and angular displacement at the start and at every stage.
    bound : np.ndarray, shape (1 + steps stages or 1, points)
        Friction bound at the start and at every stage; a single row for a constant normal load.
    carry : np.ndarray, shape (stages, stages)
        Factors a_ij / gamma of the slips of earlier stages.
    end : float
        Time of the last stage divided by the length of the step.  If it is below 1, the state at
        the end of the step is extrapolated.
    """

    motion: np.ndarray
    bound: np.ndarray
    carry: np.ndarray
    end: float


class Trace(NamedTuple):
    """The result of a march: final state, forces and effort.

    Attributes
    ----------
    state : np.ndarray, field
        Tractions at the end of the path.
    fields : np.ndarray, shape (1 + steps stages, *field)
        Unknown of the step solver at the start and after every stage.  Its projection on the bound
        is the traction.
    forces : np.ndarray, shape (1 + steps, 3)
        Forward force, lateral force and torque at the start and after every step.
    body : np.ndarray, shape (1 + steps, 2)
        x and x' of the driven body; 0 without a drive.
    residual : float
        Sum of the residual forces of all stages, divided by mu F_z.
    iterations : int
        Number of iterations of the step solver.
    broken : bool
        Whether the march was interrupted; the other attributes are then invalid.
    """

    state: np.ndarray
    fields: np.ndarray
    forces: np.ndarray
    body: np.ndarray
    residual: float
    iterations: int
    broken: bool


@kernel
def march(
    system: System,
    loading: Loading,
    drive: Drive | None,
    state: np.ndarray,
    guess: np.ndarray,
    tolerance: float,
) -> Trace:
    """March along a path.

    Parameters
    ----------
    system : System
        The contact.
    loading : Loading
        The path.
    drive : drive.Drive or None
        Equation of the driven body; None if the contact follows the path.
    state : np.ndarray, field
        Tractions at the start of the path.
    guess : np.ndarray
        Trace.fields of a march from a similar state, or an array of shape (0, ...) if there is
        none.
    tolerance : float
        Largest allowed residual of a stage, as a force divided by mu F_z.

    Returns
    -------
    Trace
    """
    carry, stages, shape = loading.carry, len(loading.carry), state.shape
    steps = (len(loading.motion) - 1) // stages
    y, q, at_end = state.copy(), state.copy(), state.copy()
    scratch = (np.empty_like(state), np.empty_like(state), np.empty_like(state))
    slips, b, z = np.empty((stages,) + shape), np.empty_like(state), np.empty_like(state)
    history = np.empty((1 + steps * stages,) + shape)
    forces, body = np.zeros((steps + 1, 3)), np.zeros((steps + 1, 2))
    advances, gains = np.zeros(stages), np.zeros(stages)
    multiply(system.operators, COMPLIANCE, state, z)
    add_displacement(system, -1.0, loading.motion[0], z)
    sum_forces(system, state, forces[0])
    copy(history[0], y)
    levels = 0 if drive is None else LEVELS
    response, slope = np.empty((levels,) + shape), np.zeros(levels)
    if drive is not None:
        response_to_drive(system, Fields(y, q, slips[0], scratch), response, slope)
        body[0, 0], body[0, 1] = starting_place(drive, forces[0, 0]), drive.start[1]
        move_forward(-body[0, 0], z)
    total, spent, iterations = 0.0, 0.0, 0
    for k in range(steps):
        past_place, past_rate = body[k, 0], body[k, 1]
        for s in range(stages):
            at = 1 + k * stages + s
            copy(b, z)
            add_displacement(system, 1.0, loading.motion[at], b)
            for j in range(s):
                add(b, -carry[s, j], slips[j])
            if len(guess) > 0:
                if at == 1:
                    copy(y, guess[1])
                else:  # add the other march's change between stages
                    add(y, 1.0, guess[at])
                    add(y, -1.0, guess[at - 1])
            elif k > 1:
                last, earlier = history[at - stages], history[at - 2 * stages]
                for c in range(2):
                    for i in range(shape[1]):
                        y[c, i] = 2.0 * last[c, i] - earlier[c, i]
            step = Step(b, loading.bound[min(at, len(loading.bound) - 1)], tolerance)
            fields = Fields(y, q, slips[s], scratch)
            stiffness = load = 0.0
            if drive is not None:
                past_place, past_rate = body[k, 0], body[k, 1]
                for j in range(s):
                    past_place += carry[s, j] * advances[j]
                    past_rate += carry[s, j] * gains[j]
                move_forward(past_place, b)
                stiffness, load = stage_balance(drive, k, past_place, past_rate)
            balance = Balance(stiffness, load, response, slope)
            if drive is None:
                count, residual, advances[s] = solve_step(system, balance, step, fields)
            else:
                count, residual, advances[s] = solve_driven_step(system, balance, step, fields)
                gains[s] = advances[s] / drive.lengths[k] - past_rate
            spent += count * 100.0 * q.size
            if count < 0 or (spent > BETWEEN_LOOKS and interrupted()):
                return Trace(at_end, history, forces, body, total, iterations, True)
            spent = 0.0 if spent > BETWEEN_LOOKS else spent
            copy(history[at], y)
            iterations += count
            total += residual
        add(b, -1.0, slips[stages - 1])
        add_displacement(system, -1.0, loading.motion[(k + 1) * stages], b)
        if drive is not None:
            move_forward(-past_place, b)
            body[k + 1, 0] = past_place + advances[stages - 1]
            body[k + 1, 1] = advances[stages - 1] / drive.lengths[k]
        for c in range(2):
            for i in range(shape[1]):
                z[c, i] = extended(z[c, i], b[c, i], loading.end)
                at_end[c, i] = extended(at_end[c, i], q[c, i], loading.end)
        sum_forces(system, at_end, forces[k + 1])
    return Trace(at_end, history, forces, body, total, iterations, False)
