"""Simple searches for the periodic state, used for comparisons, and the Python marches that they
use.

The arguments of every search are a period_map.PeriodMap, an initial state and a Goal.  Every search
returns a PeriodicState.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.contact import March, StepFailure, energy_norm
from microslip.solver.period_map import Goal, PeriodicState, PeriodMap
from microslip.states.search import largest_excess

SLOWEST = 1.0 - 1e-6
"""Largest ratio of two successive changes used in an extrapolation.  Rounding can make it 1."""
FORCING = 1e-3
"""Ratio of the step tolerance to the last change of the state, used far from the periodic state."""
LOOSEST, LOOSEST_NEAR = 1e-4, 1e-5
"""First step tolerance, for an initial state far from the periodic state and for one near it."""
DEPTH = 12
"""Number of differences in the least-squares problem of Anderson acceleration."""
NOISE = 0.1
"""Largest ratio of the summed step residuals to the change of the state.  Above this ratio, the
march is repeated with a smaller step tolerance."""
QUIET = 0.25
"""Factor applied to NOISE in the step tolerance if the initial state is near the periodic state."""
FORGETFUL = 0.2
"""The plain map needs no acceleration if the residual of every march is at most this fraction of
the previous one."""


@dataclass(frozen=True, eq=False)
class MarchInterval:
    """Result of one march over a period or half a period.

    Attributes
    ----------
    state : np.ndarray
        Tractions at the start of the march.
    image : np.ndarray
        Tractions at the start of the next march.  They equal the tractions at the end of this
        march, mirrored if the march covers half a period.
    residual : float
        Norm of the difference `image - state`, as a force divided by mu F_z.
    march : contact.March
        The march itself.
    """

    state: np.ndarray
    image: np.ndarray
    residual: float
    march: March


class Marches:
    """Performs the marches of a period_map.PeriodMap one by one and records their effort.

    The estimated distance from the fixed point is a force.  It is the largest of three numbers (see
    search.largest_excess): the residual, the last correction, and the difference between the force
    and the static limit, multiplied by residual / gain.
    """

    def __init__(self, period_map: PeriodMap):
        self.contact, self.path = period_map.contact, period_map.path
        self.image, self.drift_rate = period_map.image, period_map.drift_rate
        self.count = self.iterations = self.solves = 0
        self.metric = self.contact.weight * self.contact.compliance
        self._march: March | None = None

    def __call__(self, state: np.ndarray, step_tolerance: float) -> MarchInterval:
        """March once from `state`; steps are solved to `step_tolerance`.

        Raises StepFailure if the tractions diverge.
        """
        self._march = march = self.contact.march(
            self.path, state, step_tolerance, previous=self._march
        )
        self.count += 1
        self.iterations += march.iterations
        self.solves += march.solves
        image = self.image(march.state)
        change = image - state
        if not np.isfinite(change).all():
            raise StepFailure("diverged: tractions are not finite")
        return MarchInterval(state, image, energy_norm(self.contact, change), march)

    def admissible(self, state: np.ndarray) -> np.ndarray:
        """The state, limited to the friction bound if the integrator never exceeds the bound."""
        return project(state, self.contact.bound) if self.path.end == 1.0 else state

    def distance(self, interval: MarchInterval, proposal: np.ndarray) -> float:
        """Estimate the distance of an interval's state from the fixed point, using a better
        state."""
        step = energy_norm(self.contact, proposal - interval.state)
        distance = max(step, interval.residual)
        if self.drift_rate is not None:
            rate, mean = self.drift_rate, float(self.path.mean(interval.march.forces[:, 0]))
            excess = largest_excess(mean, rate.static_force, rate.full)
            distance = max(distance, excess * interval.residual / rate.gain)
        return distance

    def result(self, interval: MarchInterval, distance: float, converged: bool) -> PeriodicState:
        """The PeriodicState of an interval."""
        return PeriodicState(
            forces=interval.march.forces,
            start=interval.state,
            residual=interval.residual,
            distance=float(distance),
            solver_residual=interval.march.residual,
            marches=self.count,
            iterations=self.iterations,
            solves=self.solves,
            converged=bool(converged),
        )


def accelerated(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Search by Anderson acceleration, with marches in Python.

    The initial state should have too much forward traction rather than too little.  This prevents
    convergence to a state without slip.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map over a (half) period.
    start : np.ndarray
        Tractions at the start of the march.
    goal : period_map.Goal
        Tolerances and largest number of marches.

    Returns
    -------
    period_map.PeriodicState
        The converged state, or the one with the smallest distance.
    """
    marches = Marches(period_map)
    accelerate, step_tolerance = Anderson(marches.metric, DEPTH), goal.step_tolerance
    state, best = start, None
    forcing, loosest = FORCING, LOOSEST
    if goal.near:
        forcing = min(FORCING, QUIET * NOISE / len(period_map.path.stages))
        loosest = LOOSEST_NEAR
    inner = max(step_tolerance, loosest)
    forgets, last_residual = True, np.inf
    while marches.count < goal.most_marches:
        interval = marches(state, inner)
        solved = inner <= step_tolerance
        noisy = not solved and interval.march.residual > NOISE * interval.residual
        ceiling = NOISE * inner if noisy else loosest
        inner = max(step_tolerance, min(forcing * interval.residual, ceiling))
        if noisy:
            continue  # the step residuals exceed the allowed fraction of the change
        forgets = forgets and interval.residual <= FORGETFUL * last_residual
        last_residual = interval.residual
        proposal = accelerate(state, interval.image)
        if forgets:
            proposal = interval.image
        state = marches.admissible(proposal)
        distance = marches.distance(interval, state)
        converged = solved and distance <= goal.tolerance
        if best is None or distance < best.distance or converged:
            best = marches.result(interval, distance, converged)
        if converged:
            break
    return best or marches.result(interval, interval.residual, False)


def march(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """Search by the plain march, with the distance estimate of the shipped search.

    The remaining changes are extrapolated as a geometric series, using the ratio of the last two
    changes.
    """
    marches, state, last, distance = Marches(period_map), start, None, float("inf")
    for _ in range(goal.most_marches):
        interval = marches(state, goal.step_tolerance)
        if last is not None:
            ratio = min(interval.residual / last, SLOWEST) if last > 0.0 else 0.0
            distance = max(
                interval.residual / (1.0 - ratio), marches.distance(interval, interval.image)
            )
        if distance <= goal.tolerance:
            break
        state, last = interval.image, interval.residual
    return marches.result(interval, distance, distance <= goal.tolerance)


class Anderson:
    """Anderson acceleration of a map of tractions; `metric` holds the least-squares weights."""

    def __init__(self, metric: np.ndarray, depth: int):
        self.scale = np.sqrt(metric)
        self.depth = depth
        self.images: list[np.ndarray] = []
        self.changes: list[np.ndarray] = []

    def __call__(self, state: np.ndarray, image: np.ndarray) -> np.ndarray:
        """The next state, from the pairs (state, image) of all calls so far."""
        self.images.append(image)
        self.changes.append(image - state)
        if len(self.changes) > self.depth + 1:
            self.images.pop(0)
            self.changes.pop(0)
        if len(self.changes) == 1:
            return image
        scaled = [(change * self.scale).ravel() for change in self.changes]
        differences = np.stack([b - a for a, b in pairwise(scaled)], axis=1)
        try:
            weights = np.linalg.lstsq(differences, scaled[-1], rcond=1e-9)[0]
        except np.linalg.LinAlgError as error:
            raise StepFailure(f"diverged: {error}") from error
        moves = [b - a for a, b in pairwise(self.images)]
        return image - sum(w * move for w, move in zip(weights, moves, strict=True))
