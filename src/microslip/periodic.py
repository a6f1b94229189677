"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.  The start should have too much forward
traction rather than too little: from there the mean tractions relax towards the periodic ones
without losing slip on the way, which is what keeps an accelerated map from settling where nothing
moves.  The verdict is always that of the plain map: its residual, the distance to the fixed point
that the last correction measured, and what the residual means at the pace of the motion: close to
the static limit a state changes so little in a period that a small residual proves nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from microslip.friction import project
from microslip.models.contact import energy_norm

PLAIN_PERIODS = 1
FORCING = 1e-3
LOOSEST = 1e-4
"""While the state is still far from periodic, steps are solved to this share of what the last
period changed, and to LOOSEST at first: more would be wasted on a start that is about to change."""
ANDERSON_DEPTH = 12
NOISE = 0.1
"""Share of a period's change that its steps may leave unsolved."""
FORGETFUL = 0.2
"""Contraction of the plain map from the start on below which it is left alone."""
NEWTON_STALL = 10
"""Newton corrections without a better state after which the search is given up."""


@dataclass(frozen=True, eq=False)
class PeriodicState:
    """Result of the search.

    forces: (steps + 1, 3) over the last (half) period marched; start: tractions at its beginning;
    residual: what the plain map still changed, distance: estimated distance from the fixed point
    (both bounds on a force over mu F_z); solver_residual: sum over the stages of the last period;
    periods: maps marched; iterations, solves: of the step solver, over all of them.
    """

    forces: np.ndarray
    start: np.ndarray
    residual: float
    distance: float
    solver_residual: float
    periods: int
    iterations: int
    solves: int
    converged: bool


@dataclass(frozen=True)
class Pace:
    """How slowly a state can go wrong.

    static_force: mean forward force of the static limit; gain: force that a contact which does not
    slip gains in half a period.  A state whose plain map still changes a share of ``gain`` moves
    forward at a velocity wrong by that share, and as the force depends on the velocity only through
    its excess over the static limit, at most the same share of the excess is in doubt.
    """

    static_force: float
    gain: float

    def doubt(self, residual, force):
        """Error of the mean forward force that a residual of the plain map stands for."""
        return abs(force - self.static_force) * residual / self.gain


def find_periodic_state(
    contact, path, start, tolerance, step_tolerance, pace=None, max_periods=200
):
    """March half periods until the state is periodic to ``tolerance`` (a force over mu F_z).

    contact: models.contact.Contact; path: half a period, from turning point to turning point, whose
    second half is its lateral mirror image; start: state, shape of the contact; pace: if the motion
    may be slow, see Pace.  The returned forces belong to a march from the returned start, whose
    distance from the periodic state is ``distance``.  Never raises for want of convergence: see
    ``converged``.
    """
    newton = contact.has_sensitivity
    accelerate = _newton_correction if newton else Anderson(contact, ANDERSON_DEPTH)
    state, best, march = start, None, None
    inner = step_tolerance if newton else max(step_tolerance, LOOSEST)
    iterations = solves = 0
    forgets, last_residual = True, np.inf
    for period in range(1, max_periods + 1):
        use_newton = newton and period > PLAIN_PERIODS
        march = contact.march(path, state, inner, sensitivity=use_newton, previous=march)
        iterations += march.iterations
        solves += march.solves
        image = contact.mirrored(march.state)
        change = image - state
        residual = energy_norm(contact, change)
        solved = inner <= step_tolerance
        if not newton:
            noisy = not solved and march.residual > NOISE * residual
            inner = max(step_tolerance, min(FORCING * residual, NOISE * inner if noisy else LOOSEST))
            if noisy:
                continue  # what is left of the steps hides what the period changed
        if newton and not use_newton:
            proposal = image
        elif newton:
            proposal = accelerate(contact, march, state, change)
        else:
            forgets = forgets and residual <= FORGETFUL * last_residual
            proposal = accelerate(state, image)
            if forgets:
                proposal = image
        last_residual = residual
        proposal = project(proposal, contact.bound)
        distance = max(energy_norm(contact, proposal - state), residual)
        if pace is not None:
            distance = max(distance, pace.doubt(residual, path.mean(march.forces[:, 0])))
        converged = distance <= tolerance and (use_newton if newton else solved)
        if best is None or distance < best.distance or converged:
            best = PeriodicState(
                march.forces,
                state,
                residual,
                distance,
                march.residual,
                period,
                iterations,
                solves,
                converged,
            )
        if converged or (newton and period - best.periods > NEWTON_STALL):
            return best
        state = proposal
    return best


def _newton_correction(contact, march, state, change):
    """Newton's next state for the fixed point of the mirrored march (derivative from the march)."""
    size = state.size
    jacobian = march.sensitivity
    mirrored = contact.mirrored(np.ones_like(state)).reshape(
        size
    )  # signs; points map to themselves
    system = np.eye(size) - mirrored[:, None] * jacobian
    try:
        step = np.linalg.solve(system, change.reshape(size))
    except np.linalg.LinAlgError:  # some direction is neutral: leave it where it is
        step = np.linalg.lstsq(system, change.reshape(size), rcond=1e-13)[0]
    return state + step.reshape(state.shape)


class Anderson:
    """Anderson acceleration of a fixed-point map on tractions, least squares in a force metric."""

    def __init__(self, contact, depth):
        self.scale = np.sqrt(contact.weight * contact.compliance)
        self.depth = depth
        self.images, self.changes = [], []

    def __call__(self, state, image):
        """Next state from the pairs (state, image) seen so far."""
        self.images.append(image)
        self.changes.append(image - state)
        if len(self.changes) > self.depth + 1:
            self.images.pop(0)
            self.changes.pop(0)
        if len(self.changes) == 1:
            return image
        scaled = [(change * self.scale).ravel() for change in self.changes]
        differences = np.stack([b - a for a, b in pairwise(scaled)], axis=1)
        weights = np.linalg.lstsq(differences, scaled[-1], rcond=1e-9)[0]
        moves = [b - a for a, b in pairwise(self.images)]
        return image - sum(w * move for w, move in zip(weights, moves, strict=True))
