"""The Dahl model in two directions (Tsai and Tseng 2005).

    dF/dt = k (dw/dt - |dw/dt| F),        |F| <= 1

Here k is the stiffness of the contact without slip.  The model has the stiffness and the friction
bound of the contact, but it never sticks.  So any vibration reduces the friction to 0 as the
velocity tends to 0.  Along a straight segment of the path, the equation has a closed-form solution,
which is linear in the initial force.
"""

from __future__ import annotations

import numpy as np

from microslip.models import contact
from microslip.models.path import Path


class DahlContact(contact.Contact):
    """A single bristle (see models.contact.Contact); states have shape (2, 1, 1)."""

    direct = True
    sticks = False  # the static limit of friction is 0
    angles = 1

    def __init__(self, stiffness: float):
        self.stiffness = stiffness
        self.bound = self.weight = np.ones(1)
        self.compliance = np.full(1, 1.0 / stiffness)
        self.forward_position = self.lateral_position = np.zeros((1, 1))

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Deflection of the bristle, shape (2, 1, 1)."""
        return state / self.stiffness

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the state with its lateral traction negated."""
        return state * contact.MIRROR

    def periodic_state(self, path: Path, mirror: bool) -> np.ndarray:
        """Solve the linear equation q = image(march(q)) for the two components."""
        image = np.diag([1.0, -1.0]) if mirror else np.eye(2)
        starts = np.vstack([np.zeros(2), np.eye(2)]).reshape(3, 2, 1, 1)
        ends = np.array([image @ self.march(path, q, 0.0).state.ravel() for q in starts])
        matrix = np.eye(2) - (ends[1:] - ends[0]).T
        return np.linalg.solve(matrix, ends[0]).reshape(2, 1, 1)

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: contact.Guess | None = None,
    ) -> contact.March:
        """Integrate along straight lines between the phases of the path (translations only)."""
        moves = np.diff(path.positions[:, :2], axis=0)
        lengths = np.hypot(*moves.T)
        forces = np.zeros((path.steps + 1, 3))
        forces[0, :2] = traction = state.ravel()
        for k, (move, length) in enumerate(zip(moves, lengths, strict=True)):
            if length > 0.0:
                end = move / length
                traction = end + (traction - end) * np.exp(-self.stiffness * length)
            forces[k + 1, :2] = traction
        return contact.March(
            state=traction.reshape(2, 1, 1),
            forces=forces,
            residual=0.0,
            iterations=0,
            solves=path.steps,
        )
