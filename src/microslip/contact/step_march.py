"""Time integration of a contact along a path in Python, for steps that take long to solve.

The equations are those of march.py, which is compiled.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from microslip.contact.contact import Body, Contact, Guess, March, forces, rigid_displacement
from microslip.contact.path import Path

Step = tuple[np.ndarray, np.ndarray, int, float, float]
"""Tractions, slip, number of iterations, residual as a force divided by mu F_z, and displacement d
of a driven body (0 without a body)."""


class StepSolver(Protocol):
    """Solver of the Coulomb steps of a march."""

    def solve(self, b: np.ndarray, guess: np.ndarray) -> Step:
        """Solve a step for the imposed displacement b from a guess of the tractions."""

    def balance(self, b: np.ndarray, guess: np.ndarray, stiffness: float, load: float) -> Step:
        """Solve a step of a driven body: stiffness d + forward force = load."""


def march_by_steps(
    contact: Contact,
    solver: StepSolver,
    path: Path,
    state: np.ndarray,
    previous: Guess | None = None,
    *,
    body: Body | None = None,
    start: np.ndarray | None = None,
) -> March:
    """March along a path; for the arguments, see contact.Contact and RingContact.march."""
    stages, total, end = len(path.carry), len(path.motion) - 1, path.end
    guess = None if previous is None else previous.fields
    if guess is None or guess.shape != (1 + total, *state.shape):
        guess = None
    residual, iterations = 0.0, 0
    history, out = np.empty((1 + total, *state.shape)), np.empty((1 + path.steps, 3))
    moves, forward = np.zeros((1 + path.steps, 2)), np.zeros_like(state)
    forward[0] = 1.0
    slips, advances, gains = [state] * stages, np.zeros(stages), np.zeros(stages)
    at_end = history[0] = y = np.array(state, dtype=float)
    out[0] = forces(contact, state)
    if body is not None:
        drive, lengths = body.along(path, start)
        moves[0] = drive[4:]
        if not body.remembers:
            moves[0, 0] = (body.load - out[0, 0]) / body.stiffness if body.stiffness else 0.0
    rigid = rigid_displacement(contact, path.motion[0])
    z = contact.displacement(y) - rigid - moves[0, 0] * forward
    for at in range(1, 1 + total):
        k, s = divmod(at - 1, stages)
        rigid = rigid_displacement(contact, path.motion[at])
        b = z + rigid
        for j in range(s):
            b -= path.carry[s, j] * slips[j]
        if guess is not None:
            y = guess[1] if at == 1 else y + guess[at] - guess[at - 1]
        elif k > 1:
            y = 2.0 * history[at - stages] - history[at - 2 * stages]
        place = 0.0
        if body is None:
            step = solver.solve(b, y)
        else:
            place, rate = moves[k] + path.carry[s, :s] @ np.stack([advances, gains], 1)[:s]
            b += place * forward
            stiffness = body.stiffness + (body.damping + body.mass / lengths[k]) / lengths[k]
            load = body.load - body.stiffness * place + body.mass * rate / lengths[k]
            step = solver.balance(b, y, stiffness, load)
            gains[s] = step[4] / lengths[k] - rate
        y, slips[s], count, error, advances[s] = step
        history[at] = y
        iterations, residual = iterations + count, residual + error
        if s == stages - 1:
            b = b - slips[s] - rigid - place * forward
            if body is not None:
                moves[k + 1] = place + advances[s], advances[s] / lengths[k]
            z = b if end == 1.0 else z + (b - z) / end
            at_end = y if end == 1.0 else at_end + (y - at_end) / end
            out[k + 1] = forces(contact, at_end)
    return March(at_end, out, residual, iterations, total, history, moves)
