"""Models that neglect elasticity, partial slip or the interaction of points.

rigid: every point slips in the direction of its rigid velocity at every instant.  For a
translation, this model is the rigid slider of Eq 6. For a rotation, this model is the quasi-steady
contact of Eqs 21, 22 and 29.  The model has no memory, so that only the forces at each phase are
evaluated.

slider: one friction element in series with an isotropic spring (Benad et al. 2019).  The element
slides once the displacement exceeds u_lim, as the whole contact does. Therefore, the element and
the contact have the same dimensionless groups.  The model neglects partial slip.  The slider is
cheap, and accurate at high velocities.  Near the static limit, the friction of the slider is given
by Eq 7.

dahl: the Dahl model in two directions (Tsai and Tseng 2005),

    dF/dt = k (dw/dt - |dw/dt| F),        |F| <= 1,

where k is the stiffness of the contact without slip.  The model has the stiffness and the friction
bound of the contact, but it never sticks.  Therefore, under any vibration, the friction of the
model tends to 0 as the velocity tends to 0.  Along a straight segment of the path, the equation has
a closed-form solution. This solution is linear in the initial force.

mdr: the method of dimensionality reduction, which replaces the contact by a row of independent
springs with friction.  The model is exact for tangential loading of an axisymmetric indenter in one
direction (Cattaneo and Mindlin).  For slip in two directions, the model is an approximation,
because the springs do not interact.  Springs at -a < x < a have the stiffness G* and the friction
bound G* (1 - h(x)) per unit length.  Here h(x) is the depth at which the contact radius is x,
divided by the reference depth.  The spring at x therefore begins to slide at the displacement (1 -
h) u_lim.  For a sphere, this displacement is (1 - x^2) u_lim.  Now let the depth be d times the
reference depth.  If d exceeds h, the spring begins to slide at the displacement (d - h) u_lim.
"""

from __future__ import annotations

import numpy as np

from microslip.contact import contact
from microslip.contact.path import Path
from microslip.contact.ring_contact import Growth, RadialContact
from microslip.contact.rings import Focus, make_rings
from microslip.scene.hertz import HERTZ
from microslip.scene.pressure import Pressure

GRADING = 0.98
"""Grading of the time steps towards the turning points.  At a turning point, the direction of slip
reverses within a phase of about v/y.  This is the ratio of the velocity to the amplitude."""


class RigidContact(contact.Contact):
    """Rigid contact; see contact.Contact. The points are on rings and at angles on one half of the
    disc. For a translation, a single point suffices."""

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
        """Return the elastic displacement of each point, which is 0."""
        return np.zeros_like(state)

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the mirror image of a state, in which the lateral direction is reversed.  The
        reflection negates lateral tractions."""
        return state[:, ::-1, :] * contact.MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: contact.March | None = None,
    ) -> contact.March:
        """Compute the forces under full slip in the direction of the velocity at each phase of the
        path."""
        velocity = np.gradient(path.positions, path.phase, axis=0, edge_order=2)
        forces = np.empty((path.steps + 1, 3))
        for k, rate in enumerate(velocity):
            q = contact.full_slip(self, *contact.rigid_displacement(self, rate))
            forces[k] = contact.forces(self, q)
        if self.angles > 1:
            forces[:, contact.LATERAL] = 0.0  # cancelled by the other half of the disc
        return contact.March(q, forces, 0.0, 0, path.steps + 1)


class DahlContact(contact.Contact):
    """A single bristle; see contact.Contact.  States have the shape (2, 1, 1)."""

    sticks = False  # the static limit of friction is 0
    angles = 1

    def __init__(self, stiffness: float):
        self.stiffness = stiffness
        self.bound = self.weight = np.ones(1)
        self.compliance = np.full(1, 1.0 / stiffness)
        self.forward_position = self.lateral_position = np.zeros((1, 1))

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """Return the deflection of the bristle, of shape (2, 1, 1)."""
        return state / self.stiffness

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Return the state with the sign of its lateral traction reversed."""
        return state * contact.MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: contact.March | None = None,
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


def load_on_springs(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Return the load of the springs within |x| < edges in the method of dimensionality reduction.

    The load is computed at each of k depths d.  At the depth d, the spring at x carries
    G* (d - h(x)) per unit length.  Here h(x) is the depth at which the contact radius is x.  The
    integral of x h' from 0 to a radius gives the load of a contact with this radius.  The result
    has the shape (k, n + 1).
    """
    inside = np.minimum(edges, pressure.radius(depth)[:, None])
    compression = depth[:, None] - pressure.depth(inside)
    return pressure.stiffness * inside * compression + pressure.load(inside, inside)


def mdr_contact(
    cells: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ
) -> RadialContact:
    """Create a contact of springs that are graded towards `focus`.

    The number of springs on 0 < x < 1 is `cells`.  Each spring has a mirror image.  The attribute
    `bound` of the contact is a force per unit length.  The weight of a spring is the total length
    of the spring and its mirror image.
    """
    edges = np.sin(make_rings(cells, focus).psi)
    length = np.diff(edges)
    bound = 0.5 * np.diff(load_on_springs(pressure, edges, np.ones(1))[0]) / length
    influence = np.eye(cells) / pressure.G_star
    growth = Growth(pressure, edges, load_on_springs, influence_power=0, weight_power=1)
    return RadialContact(influence, bound, 2.0 * length, pressure.stiffness, growth)


def slider_contact() -> RadialContact:
    """Create a contact of one point with unit friction bound and unit compliance."""
    return RadialContact(np.ones((1, 1)), np.ones(1), np.ones(1))
