"""Compiled search for the periodic state, the fixed point of a march over a (half) period.

Anderson's method accelerates the iteration.  Convergence is judged by three quantities: the
residual of the plain map, the distance to the next state, and an error computed from the residual
and the drift rate of the motion (`Goal`).  The last quantity is needed near the static limit, where
the state changes so slowly that a small residual is no evidence of convergence.

The state of a driven body includes two more numbers, its position x and rate x'
(contacts/drive.py).  In one period, unbalanced forces hardly change the state of a heavy body or of
a body on a soft spring.  Therefore the map extrapolates the changes of x and x' by the factors of
`Inertia`.  The fixed point remains the same.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.contacts.drive import Drive
from microslip.contacts.march import Loading, march
from microslip.contacts.system import System, copy, force_norm, forward_force, mirrored, project
from microslip.foundation.compiled import kernel
from microslip.states.anderson import DEPTH, accelerated, remember

FORCING = 1e-3
"""Tolerance of the steps in a march, divided by the last change of the state."""
LOOSEST, LOOSEST_NEAR = 1e-4, 1e-5
"""Largest tolerance of a step.  The first value is for an initial state far from the periodic
state, and the second value is for one near it."""
NOISE = 1e-2
"""Largest accepted residual of a march, divided by the force that the drift adds in this march.  An
error of the state decays no faster than the state drifts."""
DRIFTING, MOST_RETURNS = 0.5, 3
"""DRIFTING: a state below the static limit is stuck if its residual exceeds this fraction of the
force that the drift adds.  Such a state drifts without slip, so its change does not measure the
distance to the periodic state.  The search then goes halfway back to the last state that was not
stuck, at most MOST_RETURNS times in a row."""
FORGETFUL = 0.2
"""The plain map is not accelerated if its contraction factor is below this value."""


class Goal(NamedTuple):
    """Tolerances of a search, and properties of the periodic state.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.
    mirror : bool
        Whether the second half of the period is the mirror image of the path.
    near : bool
        Whether the initial state is near the periodic state.
    share : np.ndarray, shape (steps,)
        Duration of each step divided by the duration of the path.
    static_force : float
        Mean forward force in the static limit; NaN if unknown.
    least : float
        Mean forward force below which a state is stuck and changes slowly.  It is approximately the
        static limit; NaN if unknown.
    full : float
        Mean forward force of full slip, which is the largest possible value.
    gain : float
        Force that a contact without slip gains along the path; infinite unless the drift is slow.
    """

    tolerance: float
    step_tolerance: float
    mirror: bool
    near: bool
    share: np.ndarray
    static_force: float
    least: float
    full: float
    gain: float


class Inertia(NamedTuple):
    """Data for extrapolating a driven body's change in a period, and for the norm of this change.

    Attributes
    ----------
    drive : drive.Drive
        Equation of motion of the body; the field `start` is not used.
    place, rate : float
        Factors that extrapolate the changes of x and x'.
    held, mass : float
        Weights of the squares of the changes in x and x', in the norm of a state.  They are a
        stiffness and a mass.
    spread : np.ndarray, shape (points,)
        Forward tractions that exert a unit force.
    """

    drive: Drive
    place: float
    rate: float
    held: float
    mass: float
    spread: np.ndarray


class Memory(NamedTuple):
    """Data of a search that are kept between calls; each call changes them.

    Attributes
    ----------
    state : np.ndarray, field
        Tractions at the start of the next march.
    place : np.ndarray, shape (2,)
        x and x' at the start of the next march.
    guess : np.ndarray
        march.Trace.fields from the last march.
    pairs : np.ndarray, shape (2, DEPTH + 1, state.size + 2)
        Images and changes, see anderson.remember.
    above : np.ndarray, field
        Last state that was not stuck; initially the first state.
    counts : np.ndarray of int, shape (5,)
        Number of marches, number of iterations, number of pairs, 1 while the plain map contracts
        fast (otherwise 0), and number of consecutive returns to an earlier state.
    numbers : np.ndarray, shape (2,)
        Tolerance of the steps in the next march, and residual of the last march.
    best : tuple of np.ndarray
        State, forces and body of the best march, and four numbers: distance, residual, residual of
        the steps, and 1 if the state converged.
    """

    state: np.ndarray
    place: np.ndarray
    guess: np.ndarray
    pairs: np.ndarray
    above: np.ndarray
    counts: np.ndarray
    numbers: np.ndarray
    best: tuple


def memory_of(state: np.ndarray, place: np.ndarray, stages: int, steps: int, goal: Goal) -> Memory:
    """Create the Memory of a search from initial tractions (a field), and from x and x'."""
    state = np.array(state, dtype=float, order="C")
    loosest = LOOSEST_NEAR if goal.near else LOOSEST
    inner = max(goal.step_tolerance, min(loosest, NOISE * goal.gain / (stages * steps)))
    return Memory(
        state,
        np.array(place, dtype=float),
        np.empty((1 + stages * steps, *state.shape)),
        np.empty((2, DEPTH + 1, state.size + 2)),
        state.copy(),
        np.array([0, 0, 0, 1, 0]),
        np.array([inner, np.inf]),
        (
            state.copy(),
            np.zeros((steps + 1, 3)),
            np.zeros((steps + 1, 2)),
            np.array([np.inf, np.inf, np.inf, 0.0]),
        ),
    )


@kernel
def state_norm(
    system: System,
    inertia: Inertia | None,
    change: np.ndarray,
    body_change: np.ndarray,
    scratch: np.ndarray,
) -> float:
    """Upper bound on the force due to a change in the tractions and in the body's motion.

    body_change: changes of x and x'.
    """
    norm = force_norm(system, change, scratch)
    if inertia is None:
        return norm
    drive = inertia.drive
    if drive.mass > 0.0 or drive.damping > 0.0:
        held = inertia.held * body_change[0] ** 2 + inertia.mass * body_change[1] ** 2
    elif drive.stiffness > 0.0:
        held = inertia.held * (forward_force(system, change) / drive.stiffness) ** 2
    else:
        held = 0.0
    return np.sqrt(norm**2 + system.stiffness * held)


@kernel
def largest_excess(force: float, static_force: float, full: float) -> float:
    """Largest possible difference between a mean force and the static limit.  `static_force` can be
    NaN."""
    if np.isnan(static_force):  # the limit can be any force from 0 to full slip
        return max(abs(force), abs(full - force))
    return abs(force - static_force)


@kernel
def search(
    system: System,
    loading: Loading,
    inertia: Inertia | None,
    goal: Goal,
    memory: Memory,
    most: int,
) -> tuple[bool, bool]:
    """Continue a search for at most `most` marches.

    Returns
    -------
    done : bool
        Whether the search ended: the state converged or is not finite, see memory.best.
    broken : bool
        Whether the search was interrupted and can be continued.
    """
    state, place, guess, pairs, above, counts, numbers, best = memory
    n, steps, bound = state.size, len(goal.share), loading.bound[0]
    image, change, scratch = np.empty_like(state), np.empty_like(state), np.empty_like(state)
    new_image, new_change, scale = np.zeros(n + 2), np.zeros(n + 2), np.empty(n + 2)
    proposal, body_change = np.empty(n + 2), np.zeros(2)
    for i in range(state.shape[1]):
        scale[i] = scale[i + n // 2] = np.sqrt(system.weight[i] * system.scale[i])
    scale[n] = scale[n + 1] = 0.0
    if inertia is not None:
        scale[n], scale[n + 1] = np.sqrt(inertia.held), np.sqrt(inertia.mass)
    nothing = np.empty((0,) + state.shape)
    for _ in range(most):
        inner = numbers[0]
        start = guess if counts[0] > 0 else nothing
        if inertia is None:
            trace = march(system, loading, None, state, start, inner)
        else:
            d = inertia.drive
            drive = Drive(d.stiffness, d.damping, d.mass, d.load, d.lengths, place)
            trace = march(system, loading, drive, state, start, inner)
        if trace.broken:
            return False, True
        counts[0] += 1
        counts[1] += trace.iterations
        fields, row = trace.fields.ravel(), guess.ravel()
        for i in range(row.size):
            row[i] = fields[i]
        if goal.mirror:
            mirrored(system, trace.state, image)
        else:
            copy(image, trace.state)
        gained, last = 0.0, len(trace.body) - 1
        if inertia is not None:
            d = inertia.drive
            advance = trace.body[last, 0] - trace.body[0, 0]
            for i in range(n):
                change.ravel()[i] = image.ravel()[i] - state.ravel()[i]
            gained = abs(advance) * system.stiffness + force_norm(system, change, scratch)
            body_change[0] = inertia.place * advance
            body_change[1] = inertia.rate * (trace.body[last, 1] - trace.body[0, 1])
            if not (d.mass > 0.0 or d.damping > 0.0):
                body_change[0], body_change[1] = 0.0, 0.0
                if inertia.place > 1.0:
                    # from the motion of the body, more accurate than from the forces of the steps
                    force = trace.forces[0, 0] - inertia.place * d.stiffness * advance
                    force -= trace.forces[last, 0]
                    for i in range(image.shape[1]):
                        image[0, i] += force * inertia.spread[i]
        image_row, state_row, change_row = image.ravel(), state.ravel(), change.ravel()
        for i in range(n):
            change_row[i] = image_row[i] - state_row[i]
            new_image[i], new_change[i] = image_row[i], change_row[i]
        for i in range(2):
            new_image[n + i], new_change[n + i] = place[i] + body_change[i], body_change[i]
        residual = state_norm(system, inertia, change, body_change, scratch)
        if not np.isfinite(residual):
            best[3][0] = np.nan
            return True, False
        solved = inner <= goal.step_tolerance
        numbers[0] = max(goal.step_tolerance, min(FORCING * residual, inner))
        if not residual <= FORGETFUL * numbers[1]:
            counts[3] = 0
        numbers[1] = residual
        mean = 0.0
        for k in range(steps):
            mean += 0.5 * goal.share[k] * (trace.forces[k, 0] + trace.forces[k + 1, 0])
        stuck = counts[0] > 1 and mean < goal.least and residual > DRIFTING * goal.gain
        back = stuck and inertia is None and counts[4] < MOST_RETURNS
        if not stuck:
            copy(above, state)
        counts[4] = counts[4] + 1 if back else 0 if not stuck else counts[4]
        if not back:
            counts[2] = remember(pairs, counts[2], new_image, new_change)
        if back:  # halfway
            counts[2], above_row = 0, above.ravel()
            for i in range(n):
                proposal[i] = 0.5 * (state_row[i] + above_row[i])
        elif counts[3]:
            for i in range(n + 2):
                proposal[i] = new_image[i]
        else:
            accelerated(pairs, counts[2], scale, proposal)
        for i in range(n):
            image_row[i] = proposal[i]
        if loading.end == 1.0:
            project(image, bound)
        for i in range(n):
            change_row[i] = image_row[i] - state_row[i]
        for i in range(2):
            body_change[i] = proposal[n + i] - place[i]
        distance = max(state_norm(system, inertia, change, body_change, scratch), residual)
        if goal.gain < np.inf:
            gained = residual if inertia is None else gained
            excess = largest_excess(mean, goal.static_force, goal.full)
            distance = max(distance, excess * gained / goal.gain)
        near_enough = distance <= goal.tolerance
        converged = solved and near_enough
        if near_enough:  # solve the steps of the next march to the final tolerance
            numbers[0] = goal.step_tolerance
        if converged or distance < best[3][0]:
            copy(best[0], state)
            for k in range(steps + 1):
                for i in range(3):
                    best[1][k, i] = trace.forces[k, i]
                for i in range(2):
                    best[2][k, i] = trace.body[k, i]
            best[3][0], best[3][1] = distance, residual
            best[3][2], best[3][3] = trace.residual, 1.0 if converged else 0.0
        copy(state, image)
        for i in range(2):
            place[i] = proposal[n + i]
        if converged:
            return True, False
    return False, False
