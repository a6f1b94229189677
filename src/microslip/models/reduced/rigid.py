"""The rigid contact: every point slips in the direction of its rigid velocity at every instant.

For a translation, it is the rigid slider of Eq 6.  For a rotation, it is the quasi-steady contact
of Eqs 21, 22 and 29.  The model has no memory, so a march only evaluates the forces at each phase.
"""

from __future__ import annotations

import numpy as np

from microslip.models import contact
from microslip.models.path import Path
from microslip.models.rings.mesh import make_rings
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

GRADING = 0.98
"""Grading of the steps towards the turning points.  At a turning point, the direction of slip
reverses within a phase of about v/y."""


class RigidContact(contact.Contact):
    """Rigid contact with points on rings and at angles on half the disc, or with a single point for
    a translation (see models.contact)."""

    direct = True
    sticks = False
    grading = GRADING

    def __init__(self, cells: int, angles: int, rotates: bool, pressure: Pressure = HERTZ):
        self.stiffness = pressure.stiffness
        self.angles = angles if rotates else 1
        if rotates:
            rings = make_rings(cells, pressure=pressure)
            theta = (np.arange(angles) + 0.5) * np.pi / angles
            self.lateral_position = np.cos(theta)[:, None] * rings.radius
            self.forward_position = np.sin(theta)[:, None] * rings.radius
            self.bound, self.weight = rings.bound, rings.area / angles
        else:
            self.lateral_position = self.forward_position = np.zeros((1, 1))
            self.bound = self.weight = np.ones(1)
        self.compliance = np.ones_like(self.bound)

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Elastic displacement of each point, which is 0."""
        return np.zeros_like(state)

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state under lateral -> -lateral.  This negates lateral
        tractions."""
        return state[:, ::-1, :] * contact.MIRROR

    def periodic_state(self, path: Path, mirror: bool) -> np.ndarray:
        """Return the state after one march.  It does not depend on the initial state."""
        end = self.march(path, np.zeros((2, *self.forward_position.shape)), 0.0).state
        return self.mirrored(end) if mirror else end

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: contact.Guess | None = None,
    ) -> contact.March:
        """Compute the forces under full slip in the direction of the velocity at each phase of the
        path."""
        velocity = np.gradient(path.positions, path.phase, axis=0, edge_order=2)
        forces = np.empty((path.steps + 1, 3))
        for k, rate in enumerate(velocity):
            q = contact.full_slip(self, *contact.rigid_displacement(self, rate))
            forces[k] = contact.forces(self, q)
        if self.angles > 1:
            forces[:, contact.LATERAL] = 0.0  # the other half of the disc cancels it
        return contact.March(q, forces, 0.0, 0, path.steps + 1)
