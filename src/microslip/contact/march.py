"""Compiled time integration of a contact on rings along a path, called the march.

With the rigid displacement w and z = A q - w, stage i of a step is a Coulomb step (splitting.py)
for tractions q_i and slips r_i,

    A q_i + r_i = b_i,

where b_i = z + w(t + c_i h) - Sum_{j<i} (a_ij / gamma) r_j.

The last stage is at the end of the step.  At the end of the step, z is b - r - w.

A body of mass m with a dashpot c, which is driven by a constant force or through a spring k, obeys

    m x'' + c x' + k x + f = load,    f: forward force of the contact,

in working units.  x is the displacement of the contact relative to its path, and primes are
derivatives with respect to the phase.  The far end of the spring follows the path.  The integrator
of the contact also integrates the motion of the body.  Let g be the length of the implicit part of
a stage.  The increment of x in the stage is d = g x'.  Then each stage adds the equation

    stiffness d + f(q) = load,    stiffness = k + c / g + m / g^2,

to the Coulomb step.  The solution is unique, because f never decreases as d increases.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.operators import multiply
from microslip.contact.splitting import LEVELS, respond, solve_step
from microslip.foundation.compiled import kernel

STIFFNESS, DAMPING, MASS, LOAD, PLACE, RATE = range(6)
"""Indices of the parameters of a drive.  The parameters are k, c, m, the load, and the values of x
and x' at the start of the path.  The values of x and x' are ignored if both m and c are 0."""


@kernel
def add_displacement(
    factor: float, motion: np.ndarray, positions: np.ndarray, out: np.ndarray
) -> None:
    """Add a factor times a rigid displacement (forward, lateral, angle) to the field `out`."""
    forward, lateral, angle = factor * motion[0], factor * motion[1], factor * motion[2]
    for i in range(out.shape[1]):
        out[0, i] += forward + angle * positions[1, i]
        out[1, i] += lateral - angle * positions[0, i]


@kernel
def add(out: np.ndarray, factor: float, values: np.ndarray) -> None:
    """Add `factor` times `values` to the field `out`."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] += factor * values[c, i]


@kernel
def move_forward(factor: float, out: np.ndarray) -> None:
    """Add the uniform forward displacement `factor` to the field `out`."""
    for i in range(out.shape[1]):
        out[0, i] += factor


@kernel
def combine(out: np.ndarray, first: np.ndarray, factor: float, second: np.ndarray) -> None:
    """Set the field `out` to `first` plus `factor` times the difference `first` - `second`.  With
    the factor 0, `first` is copied."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] = first[c, i] + factor * (first[c, i] - second[c, i])


@kernel
def pack(
    field: np.ndarray, kept: float, first: np.ndarray, factor: float, second: np.ndarray
) -> None:
    """Set `field` to `kept * field + first + factor * second`.  The arguments `first` and `second`
    are states."""
    rows, cells = first.shape[1], first.shape[2]
    width = field.shape[1] // rows
    for c in range(2):
        for row in range(rows):
            for i in range(cells):
                at = row * width + i
                total = first[c, row, i] + factor * second[c, row, i]
                field[c, at] = kept * field[c, at] + total


@kernel
def unpack(state: np.ndarray, field: np.ndarray) -> None:
    """Copy a field to a state, without the padding."""
    rows, cells = state.shape[1], state.shape[2]
    width = field.shape[1] // rows
    for c in range(2):
        for row in range(rows):
            for i in range(cells):
                state[c, row, i] = field[c, row * width + i]


@kernel
def strain_energy(operators: tuple, weight: np.ndarray, state: np.ndarray) -> float:
    """Return <q, A q>, which is twice the elastic energy of tractions q of shape (2, rows,
    cells)."""
    sectors, number, rows = operators[0].shape
    size = len(weight)
    waves = np.empty((2, sectors * number, 2 * size // (sectors * rows)))
    work, energy = np.zeros((2, 2, size)), 0.0
    pack(work[0], 0.0, state, 0.0, state)
    multiply(operators, 0, work[0], work[1], waves)
    for c in range(2):
        for i in range(size):
            energy += weight[i] * work[0, c, i] * work[1, c, i]
    return energy


@kernel
def sum_forces(weight: np.ndarray, positions: np.ndarray, q: np.ndarray, out: np.ndarray) -> None:
    """Fill `out`, of shape (3,), with the forward force, the lateral force and the torque."""
    ahead, aside, torque = 0.0, 0.0, 0.0
    for i in range(q.shape[1]):
        forward, lateral = weight[i] * q[0, i], weight[i] * q[1, i]
        ahead += forward
        aside += lateral
        torque += positions[1, i] * forward - positions[0, i] * lateral
    out[0], out[1], out[2] = ahead, aside, torque


@kernel
def march(
    operators: tuple,
    points: tuple,
    loading: tuple,
    drive: tuple,
    start: tuple,
    tolerance: float,
) -> tuple:
    """Integrate a contact along a path.

    Parameters
    ----------
    operators, points : tuple
        See splitting.solve_step.  The positions of the points have the shape (2, points).
    loading : tuple
        Four values: the rigid displacement at the start and at every stage, of shape (1 + steps
        stages, 3); the friction bound, of shape (1 + steps stages or 1, points); the factors a_ij /
        gamma, of shape (stages, stages); and the time of the last stage divided by the length of
        the step.  If this ratio is below 1, the state at the end of the step is extrapolated.
    drive : tuple
        Parameters of the drive, of shape (6,), and the length g for each step in radians, of shape
        (steps,).  The latter is empty if the contact follows the path.
    start : tuple
        Tractions at the start of the path, of shape (2, rows, cells), and the `history` of a march
        from a similar state, or an array of shape (0, 2, rows, cells).
    tolerance : float
        Largest allowed residual at each stage, as a force divided by mu F_z.

    Returns
    -------
    state : np.ndarray, shape (2, rows, cells)
        Tractions at the end of the path.
    history : np.ndarray, shape (1 + steps stages, 2, rows, cells)
        Unknown of the step solver at the start and after every stage.  The tractions are its
        projection onto the friction bound.
    forces, body : np.ndarray, shapes (1 + steps, 3) and (1 + steps, 2)
        Forces at the start and after every step, and the values of x and x' of the body (0 without
        a drive).
    residual : float
        Sum over all stages of the residual force, divided by mu F_z.
    iterations : int
        Number of iterations of the step solver; -1 after an interrupt.
    """
    weight, positions = points[0], points[4]
    motion, bounds, carry, end = loading
    numbers, lengths = drive
    state, guess = start
    stages, total, size = len(carry), len(motion) - 1, len(weight)
    steps, driven = total // stages, len(lengths) > 0
    sectors, number, rows = operators[0].shape
    waves = np.empty((2, sectors * number, 2 * size // (sectors * rows)))
    work, history = np.zeros((8 + LEVELS + stages, 2, size)), np.empty((1 + total,) + state.shape)
    forces, body = np.zeros((steps + 1, 3)), np.zeros((steps + 1, 2))
    advances, gains, slope, clock = (
        np.zeros(stages),
        np.zeros(stages),
        np.zeros(LEVELS),
        np.zeros(1),
    )
    y, q, z, b, at_end = work[0], work[1], work[5], work[6], work[7]
    response, slips = work[8 : 8 + LEVELS], work[8 + LEVELS :]
    pack(y, 0.0, state, 0.0, state)
    combine(at_end, y, 0.0, y)
    unpack(history[0], y)
    multiply(operators, 0, y, z, waves)
    add_displacement(-1.0, motion[0], positions, z)
    sum_forces(weight, positions, y, forces[0])
    if driven:
        respond(operators, weight, b, waves, response, slope)
        body[0, 1] = numbers[RATE]
        if numbers[MASS] > 0.0 or numbers[DAMPING] > 0.0:
            body[0, 0] = numbers[PLACE]
        elif numbers[STIFFNESS] > 0.0:
            body[0, 0] = (numbers[LOAD] - forces[0, 0]) / numbers[STIFFNESS]
        move_forward(-body[0, 0], z)
    total_residual, iterations, place, rate, stiffness, load = 0.0, 0, 0.0, 0.0, 0.0, 0.0
    for at in range(1, 1 + total):
        k, s = (at - 1) // stages, (at - 1) % stages
        combine(b, z, 0.0, z)
        add_displacement(1.0, motion[at], positions, b)
        for j in range(s):
            add(b, -carry[s, j], slips[j])
        if len(guess) > 0:
            if at == 1:
                pack(y, 0.0, guess[1], 0.0, guess[1])
            else:  # add the change between stages in the other march
                pack(y, 1.0, guess[at], -1.0, guess[at - 1])
        elif k > 1:
            last, earlier = history[at - stages], history[at - 2 * stages]
            pack(y, 0.0, last, 0.0, last)
            pack(y, 1.0, last, -1.0, earlier)
        if driven:
            place, rate = body[k, 0], body[k, 1]
            for j in range(s):
                place += carry[s, j] * advances[j]
                rate += carry[s, j] * gains[j]
            move_forward(place, b)
            length = lengths[k]
            stiffness = numbers[STIFFNESS] + (numbers[DAMPING] + numbers[MASS] / length) / length
            load = numbers[LOAD] - numbers[STIFFNESS] * place + numbers[MASS] * rate / length
        step = b, bounds[min(at, len(bounds) - 1)], tolerance
        scratch = work, slips[s], waves, clock
        equation = driven, stiffness, load, response, slope
        found, residual, advances[s] = solve_step(operators, points, step, equation, scratch)
        if found < 0:
            return state, history, forces, body, total_residual, -1
        unpack(history[at], y)
        iterations += found
        total_residual += residual
        if driven:
            gains[s] = advances[s] / lengths[k] - rate
        if s == stages - 1:
            add(b, -1.0, slips[s])
            add_displacement(-1.0, motion[at], positions, b)
            if driven:
                move_forward(-place, b)
                body[k + 1, 0] = place + advances[s]
                body[k + 1, 1] = advances[s] / lengths[k]
            combine(z, b, 1.0 / end - 1.0, z)
            combine(at_end, q, 1.0 / end - 1.0, at_end)
            sum_forces(weight, positions, at_end, forces[k + 1])
    end_state = np.empty(state.shape)
    unpack(end_state, at_end)
    return end_state, history, forces, body, total_residual, iterations
