"""One (half) period as a map of the tractions at its beginning, and the verdict on a fixed point.

The verdict is always that of the plain map: its residual, the distance to the fixed point that the
last correction measured, and what the residual means at the drift rate of the motion: close to the
static limit a state changes so little in a period that a small residual proves nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.contact import Contact, March, StepFailure, energy_norm
from microslip.models.path import Path

if TYPE_CHECKING:
    from microslip.states.search import Inertia

MOST_MARCHES = 200
"""Largest number of marches in a search, by default."""


class Goal(NamedTuple):
    """Tolerances of a search for the periodic state, and its largest number of marches.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, forces over mu F_z.
    most_marches : int
        Marches to try.
    near : bool
        Whether the start is near the state, so that only well solved steps tell what is left.
    """

    tolerance: float
    step_tolerance: float
    most_marches: int = MOST_MARCHES
    near: bool = False


@dataclass(frozen=True, eq=False)
class PeriodicState:
    """Result of the search.

    Attributes
    ----------
    forces : np.ndarray, shape (steps + 1, 3)
        Over the last (half) period marched.
    start : np.ndarray
        Tractions at its beginning.
    residual : float
        What the plain map still changed, a bound on a force over mu F_z.
    distance : float
        Estimated distance from the fixed point, likewise.
    solver_residual : float
        Sum over the stages of the last period.
    marches : int
        Maps marched.
    iterations, solves : int
        Iterations and stages of the step solver, over all marches.
    converged : bool
        Whether the distance is within the tolerance.
    body : np.ndarray or None, shape (steps + 1, 2)
        x and x' of a driven contact over the last (half) period, see pull.PulledMarch.
    fields : np.ndarray or None
        contact.March.fields of the last (half) period: the initial guess of a march from `start`.
    """

    forces: np.ndarray
    start: np.ndarray
    residual: float
    distance: float
    solver_residual: float
    marches: int
    iterations: int
    solves: int
    converged: bool
    body: np.ndarray | None = None
    fields: np.ndarray | None = None


@dataclass(frozen=True)
class DriftRate:
    """How slowly a state can go wrong.

    A state whose plain map still changes a share of the gain moves forward at a velocity wrong by
    that share, and as the force depends on the velocity only through its excess over the static
    limit, at most the same share of the excess is in doubt.

    Attributes
    ----------
    static_force : float
        Mean forward force of the static limit, over mu F_z; NaN where it is not known.
    full : float
        That of full slip, the largest that it can be.
    gain : float
        Force that a contact which does not slip gains in a march over a (half) period.
    least : float
        Mean forward force below which a state only drifts, about that of the static limit; NaN: it
        is not known better than `static_force`.
    """

    static_force: float
    full: float
    gain: float
    least: float = np.nan

    def force_error(self, residual: float, force: float) -> float:
        """Error of the mean forward force that a residual of the plain map stands for."""
        excess = abs(force - self.static_force)
        if np.isnan(excess):  # a state below the limit has lost what it takes long to gain
            excess = max(abs(force), abs(self.full - force))
        return excess * residual / self.gain


@dataclass(frozen=True, eq=False)
class MarchInterval:
    """One march over a (half) period.

    Attributes
    ----------
    state : np.ndarray
        Tractions at its beginning.
    image : np.ndarray
        Those where the next one begins: at the end of the period, or the mirror image of its
        middle.
    change : np.ndarray
        image - state.
    residual : float
        Its size, as a force over mu F_z.
    march : contact.March
        What it gave.
    """

    state: np.ndarray
    image: np.ndarray
    change: np.ndarray
    residual: float
    march: March


class PeriodMap:
    """The map of a contact over a path, which counts the marches.

    PeriodMap(...)(state, step_tolerance) is a MarchInterval.

    Parameters
    ----------
    contact : contact.Contact
        What is marched.
    path : path.Path
        Half a period, from turning point to turning point, whose second half is its lateral mirror
        image, or without `mirror` a whole one.
    drift_rate : DriftRate or None
        Given where the motion may be slow.
    mirror : bool
        See `path`.
    """

    def __init__(
        self, contact: Contact, path: Path, drift_rate: DriftRate | None = None, mirror: bool = True
    ):
        self.contact, self.path, self.drift_rate, self.mirror = contact, path, drift_rate, mirror
        self.marches = self.iterations = self.solves = 0
        self._march: March | None = None

    def __call__(self, state: np.ndarray, step_tolerance: float) -> MarchInterval:
        """March once from `state`; steps are solved to `step_tolerance`.

        Raises StepFailure where the tractions blow up.
        """
        self._march = march = self.contact.march(
            self.path, state, step_tolerance, previous=self._march
        )
        self.marches += 1
        self.iterations += march.iterations
        self.solves += march.solves
        image = self.image(march.state)
        change = image - state
        if not np.isfinite(change).all():
            raise StepFailure("diverged: tractions are not finite")
        return MarchInterval(state, image, change, self.size(change), march)

    def parts(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Tractions of a state, and x and x' of a driven body, 0 without one."""
        return state, np.zeros(2)

    def state(self, tractions: np.ndarray, place: np.ndarray) -> np.ndarray:
        """The state of tractions, and of x and x' of a driven body."""
        return tractions

    def inertia(self) -> Inertia | None:
        """No body is driven."""
        return None

    @property
    def metric(self) -> np.ndarray:
        """Weights of squared changes of a state, as energies; broadcast to it."""
        return self.contact.weight * self.contact.compliance

    def size(self, change: np.ndarray) -> float:
        """Bound on the force that a change of a state carries, over mu F_z."""
        return energy_norm(self.contact, change)

    def image(self, state: np.ndarray) -> np.ndarray:
        """Tractions at the start of the next interval, from those at the end of one; linear."""
        return self.contact.mirrored(state) if self.mirror else state

    def admissible(self, state: np.ndarray) -> np.ndarray:
        """The state projected on the friction bound, where the integrator keeps to it."""
        return project(state, self.contact.bound) if self.path.end == 1.0 else state

    def distance(self, interval: MarchInterval, proposal: np.ndarray) -> float:
        """Estimated distance of an interval's state from the fixed point, given a better state."""
        distance = max(self.size(proposal - interval.state), interval.residual)
        if self.drift_rate is not None:
            mean = float(self.path.mean(interval.march.forces[:, 0]))
            distance = max(distance, self.drift_rate.force_error(interval.residual, mean))
        return distance

    def result(
        self,
        interval: MarchInterval,
        distance: float,
        converged: bool,
    ) -> PeriodicState:
        """The PeriodicState that an interval amounts to."""
        return PeriodicState(
            forces=interval.march.forces,
            start=interval.state,
            residual=interval.residual,
            distance=float(distance),
            solver_residual=interval.march.residual,
            marches=self.marches,
            iterations=self.iterations,
            solves=self.solves,
            converged=bool(converged),
        )
