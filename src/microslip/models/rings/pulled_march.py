"""A march of the ring contact whose forward displacement is pulled (models/pull.py)."""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.interrupts import BETWEEN_LOOKS, interrupted
from microslip.models.pull import Pull, stage_load, stage_stiffness, starting_place
from microslip.models.rings.first_guess import stretch
from microslip.models.rings.march import bound_at, displacements, guess, remembered
from microslip.models.rings.newton_step import Step
from microslip.models.rings.pulled_step import PulledStep, make_trial, solve_pulled_step
from microslip.models.rings.tangent import RingSystem, copy, make_factors, subtract


@kernel(inline="always")
def _guessed_place(places, at, known, moved):
    """First guess of x at the end of a stage, from other stages or from another march."""
    if len(known) > 0:
        return places[at - 1] + known[at] - known[at - 1]
    if at > 1:
        return places[at - 1] + stretch(moved, at) * (places[at - 1] - places[at - 2])
    return places[0]


@kernel(inline="always")
def _add(rows, ahead, at, sign):
    """Add sign times what `ahead` has of a stage, if it has any, to rows (2, n)."""
    if len(ahead) > 0:
        for c in range(2):
            subtract(rows[c], -sign, ahead[at, c])


@kernel
def pulled_march(
    rings: RingSystem, imposed: tuple, pull: Pull, state: np.ndarray, known: tuple, settings: tuple
) -> tuple:
    """March along a path from which the contact may stay behind, or run ahead.

    Parameters
    ----------
    rings : tangent.RingSystem
        The contact.
    imposed : tuple
        models.path.LoadingPath, whose integrator ends with the step; by how much the weighted
        displacement that is imposed on each ring is ahead of that, (1 + steps stages, 2, n), at the
        start and at every stage, or (0, 2, 0) where all rings follow the path.
    pull : models.pull.Pull
        What pulls.
    state : np.ndarray, shape (2, n)
        Tractions at the start.
    known : tuple
        Tractions (1 + steps stages, 2, n) and places (1 + steps stages,) of another march, at its
        start and after every stage, or empty.
    settings : tuple of float
        Tolerance of every stage, a force over mu F_z; force per displacement without slip.

    Returns
    -------
    tuple
        End state, the tractions and places of this march as in `known`, x and x' at the phases
        (steps + 1, 2), forces (steps + 1, 3), residual sum, iterations, whether it was interrupted,
        which makes the rest worthless.
    """
    path, ahead = imposed
    n, steps, stages = len(rings.weight), path.stages.shape[0], path.stages.shape[1]
    weight, carry, bounds = rings.weight, path.carry, path.bounds
    (tolerance, holding), (known_tractions, known_places) = settings, known
    factors, trial, moved = make_factors(n), make_trial(weight), displacements(path)
    tractions, places = np.empty((1 + steps * stages, 2, n)), np.empty(1 + steps * stages)
    forces, body = np.zeros((steps + 1, 3)), np.empty((steps + 1, 2))
    slips, b, q = np.empty((stages, 2, n)), np.empty((2, n)), state.copy()
    advances, gains = np.empty(stages), np.empty(stages)
    for c in range(2):
        for i in range(n):
            forces[0, c] += weight[i] * q[c, i]
    place, rate = starting_place(pull, forces[0, 0]), pull.start[1]
    z = remembered(rings, moved[0], q, b)
    subtract(z[0], place, weight)
    _add(z, ahead, 0, -1.0)
    copy(tractions[0], q)
    places[0], body[0, 0], body[0, 1] = place, place, rate
    total, spent, iterations, at = 0.0, 0.0, 0, 0
    for k in range(steps):
        length = pull.lengths[k]
        for s in range(stages):
            at += 1
            past_place, past_rate = body[k, 0], body[k, 1]
            for j in range(s):
                past_place += carry[s, j] * advances[j]
                past_rate += carry[s, j] * gains[j]
            for c in range(2):
                for i in range(n):
                    b[c, i] = z[c, i] + weight[i] * moved[at, c]
                if c == 0:
                    subtract(b[0], -past_place, weight)
                for j in range(s):
                    subtract(b[c], carry[s, j], slips[j, c])
            _add(b, ahead, at, 1.0)
            guess(q, bounds, moved, at, known_tractions, tractions)
            pulled = PulledStep(
                Step(b, bound_at(bounds, at), tolerance),
                stage_stiffness(pull, length),
                stage_load(pull, length, past_place, past_rate),
                holding,
            )
            first = _guessed_place(places, at, known_places, moved) - past_place
            count, residual, advances[s] = solve_pulled_step(
                rings, pulled, (q, slips[s], first), factors, trial
            )
            place = past_place + advances[s]
            gains[s] = advances[s] / length - past_rate
            copy(tractions[at], q)
            places[at] = place
            iterations += count
            total += residual
            spent += (count + 1) * 4.0 * n * n
            if spent > BETWEEN_LOOKS:
                spent = 0.0
                if interrupted():
                    return q, tractions, places, body, forces, total, iterations, True
        body[k + 1, 0], body[k + 1, 1] = place, advances[stages - 1] / length
        for c in range(2):
            for i in range(n):
                z[c, i] = b[c, i] - slips[stages - 1, c, i] - weight[i] * moved[at, c]
                forces[k + 1, c] += weight[i] * q[c, i]
        subtract(z[0], past_place, weight)
        _add(z, ahead, at, -1.0)
    return q, tractions, places, body, forces, total, iterations, False
