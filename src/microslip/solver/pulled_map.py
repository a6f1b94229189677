"""One (half) period of a contact that is pulled, as a map of its state.

The state is one row of numbers: the tractions, and where the body remembers (models/pull.py) how
far it is ahead of the path, and how fast that grows.  In the mirror image of half a period later
these two are what they were.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from microslip.models.contact import StepFailure, energy_norm
from microslip.models.coulomb import project
from microslip.models.path import Path
from microslip.models.pull import Body, PullsContact
from microslip.solver.period_map import CreepRate, MarchInterval, PeriodicState, PeriodMap


class PulledMap(PeriodMap):
    """The map of a contact and a body over a path; see period_map.PeriodMap.

    Parameters
    ----------
    contact : pull.PullsContact
        What is marched.
    path : path.Path
        From which the body may stay behind or run ahead.
    body : pull.Body
        What is pulled, and by what.
    creep_rate : period_map.CreepRate or None
        Given where the motion may be slow and its velocity is known.
    mirror : bool
        Whether the second half of the period is the mirror image of the path.
    """

    def __init__(
        self,
        contact: PullsContact,
        path: Path,
        body: Body,
        creep_rate: CreepRate | None = None,
        mirror: bool = True,
    ):
        super().__init__(contact, path, creep_rate, mirror)
        self.body = body
        self._shape = (2, *np.broadcast_shapes(contact.bound.shape, contact.lateral_position.shape))
        self._points = int(np.prod(self._shape))

    def __call__(self, state, step_tolerance, sensitivity=False):
        """March once from `state`; steps are solved to `step_tolerance`.

        Raises StepFailure where the tractions blow up.
        """
        tractions, start = self._parts(state)
        self._march = march = self.contact.pulled_march(
            self.path, tractions, step_tolerance, self.body, start, previous=self._march
        )
        self.marches += 1
        self.iterations += march.iterations
        self.solves += march.solves
        image = self.state(self.image(march.state), march.body[-1])
        change = image - state
        if not np.isfinite(change).all():
            raise StepFailure("diverged: tractions are not finite")
        return MarchInterval(state, image, change, self.size(change), march)

    def state(self, tractions: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """The state of tractions and of (x, x'), one row."""
        return np.append(tractions.ravel(), moved) if self.body.remembers else tractions.ravel()

    def tractions(self, state: np.ndarray) -> np.ndarray:
        """Those of a state, of the shape of the contact's states."""
        return self._parts(state)[0]

    def _parts(self, state):
        moved = state[self._points :] if self.body.remembers else np.zeros(2)
        return state[: self._points].reshape(self._shape), moved

    @property
    def metric(self) -> np.ndarray:
        points = np.broadcast_to(super().metric, self._shape)
        return self.state(points, np.array([self._held, self.body.mass]))

    @property
    def _held(self):
        """Stiffness that counts for x: a mass or a dashpot alone leaves it free."""
        return self.body.stiffness

    def size(self, change: np.ndarray) -> float:
        tractions, moved = self._parts(change)
        squared = energy_norm(self.contact, tractions) ** 2
        if self.body.remembers:
            squared += self.contact.stiffness * (
                self._held * moved[0] ** 2 + self.body.mass * moved[1] ** 2
            )
        elif self.body.stiffness > 0.0:  # the spring gives way as far as the force changes
            force = float(np.sum(self.contact.weight * tractions[0]))
            squared += self.contact.stiffness * force**2 / self.body.stiffness
        return float(np.sqrt(squared))

    def admissible(self, state: np.ndarray) -> np.ndarray:
        """The state, its tractions projected on the friction bound."""
        tractions, moved = self._parts(state)
        return self.state(project(tractions, self.contact.bound), moved)

    def result(self, interval, distance, converged, inverse=None) -> PeriodicState:
        found = super().result(interval, distance, converged, inverse)
        return replace(found, body=interval.march.body)
