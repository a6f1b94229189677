"""One (half) period of a contact that is pulled, as a map of its state.

The state is one row of numbers: the tractions, and where the body remembers (driven_body.py) how
far it is ahead of the path, x, and how fast that grows, x'.  In the mirror image of half a period
later these two are what they were.

In one period a heavy body hardly notices that the forces on it do not balance, nor does a soft
spring that the contact stays behind.  So the map moves the body on as if it were no heavier, and
its spring no softer, than the contact is: by so many times what it moved.  What repeats itself is
the same.  A contact that slides as a whole gives way far more than one that sticks: the stiffness
that counts there is the rise of its mean force with the displacement.
"""

from __future__ import annotations

import numpy as np

from microslip.models.driven_body import Body
from microslip.models.path import Path
from microslip.models.system_contact import SystemContact
from microslip.solver.period_map import DriftRate, PeriodMap
from microslip.states.search import Inertia

CAUTION = 0.3
"""Share of the contact's stiffness that a softer spring counts as having: more would overshoot."""


class PulledMap(PeriodMap):
    """The map of a contact and a body over a path; see period_map.PeriodMap.

    Parameters
    ----------
    contact : SystemContact
        What is marched.
    path : path.Path
        From which the body may stay behind or run ahead.
    body : driven_body.Body
        What is pulled, and by what.
    drift_rate : period_map.DriftRate or None
        Given where the motion may be slow and its velocity is known.
    mirror : bool
        Whether the second half of the period is the mirror image of the path.
    slope : float
        Largest rise of the mean forward force for a body that gains a unit of x in the interval.
    """

    contact: SystemContact

    def __init__(
        self,
        contact: SystemContact,
        path: Path,
        body: Body,
        drift_rate: DriftRate | None = None,
        mirror: bool = True,
        slope: float = np.inf,
    ):
        super().__init__(contact, path, drift_rate, mirror)
        self.body = body
        self._shape = (2, *np.broadcast_shapes(contact.bound.shape, contact.lateral_position.shape))
        self._points = int(np.prod(self._shape))
        spread = np.broadcast_to(contact.bound, self._shape[1:])
        load = float(np.sum(contact.weight * spread))
        # a period that begins without contact has no tractions there to correct
        self._spread = spread / load if load > 0.0 else 0.0 * spread
        interval, stiffness = path.phase[-1] - path.phase[0], contact.stiffness
        self._mass = min(body.mass, stiffness * interval**2)
        self._held = body.stiffness * min(1.0, body.stiffness / stiffness)
        self._haste = np.ones(2)
        slow = max(1.0, body.damping / (stiffness * interval))
        if body.stiffness > 0.0:
            steepest = min(CAUTION * stiffness, slope)
            self._haste[0] = max(1.0, steepest / body.stiffness * slow)
        if body.mass > 0.0:
            self._haste[1] = max(1.0, body.mass / (self._mass * slow))

    def state(self, tractions: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """The state of tractions and of (x, x'), one row."""
        return np.append(tractions.ravel(), moved) if self.body.remembers else tractions.ravel()

    def parts(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Tractions of a state, and x and x' if they belong to it, else 0."""
        moved = state[self._points :] if self.body.remembers else np.zeros(2)
        return state[: self._points].reshape(self._shape), moved

    def inertia(self) -> Inertia:
        """Stiffness, mass and acceleration factors of the driven body, for compiled code."""
        return Inertia(
            self.body.along(self.path, np.zeros(2)),
            float(self._haste[0]),
            float(self._haste[1]),
            float(self._held),
            float(self._mass),
            self.contact.layout.pack(self._spread),
        )
