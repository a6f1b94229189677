"""A contact as compiled code sees it: points, elastic operators, and sums over the points.

A field has the shape (2, points): forward and lateral component at every point, contact after
contact.  Points may be added that have no area and a friction bound of zero.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.operators import multiply
from microslip.foundation.compiled import kernel

COMPLIANCE = 0
"""Number of A among the operators."""


class System(NamedTuple):
    """The points of a contact, or of several contacts that carry one body.

    Attributes
    ----------
    operators : NamedTuple
        A, from tractions to displacements, and what the solver needs besides; see operators.py.
    solver : Resolvent or Descent
        How a Coulomb step is solved: splitting.Resolvent or descent.Descent.
    scale : np.ndarray, shape (points,)
        Displacement of a point under a unit traction on itself.
    weight : np.ndarray, shape (points,)
        Area of a point.
    positions : np.ndarray, shape (2, points)
        Forward and lateral position of the points, over the contact radius.
    first : np.ndarray of int, shape (contacts + 1,)
        First point of each contact, and the number of points.
    mirror : np.ndarray of int, shape (points,)
        The point across the mirror lateral -> -lateral of each point.
    resultants : np.ndarray, shape (3,)
        1 for each of forward force, lateral force and torque that the points can have, 0 for those
        that symmetry cancels.
    stiffness : float
        Force over mu F_z per uniform displacement u_lim without slip, at least.
    """

    operators: Any  # of a class that operators.operator knows
    solver: Any  # of a class that step.step_solver knows
    scale: np.ndarray
    weight: np.ndarray
    positions: np.ndarray
    first: np.ndarray
    mirror: np.ndarray
    resultants: np.ndarray
    stiffness: float


@kernel(inline="always")
def add_displacement(system: System, factor: float, motion: np.ndarray, out: np.ndarray) -> None:
    """out += factor times the rigid displacement of the points.

    motion: forward, lateral, angle of each contact, (contacts, 3); out: a field.
    """
    positions = system.positions
    for contact in range(len(motion)):
        forward, lateral = factor * motion[contact, 0], factor * motion[contact, 1]
        angle = factor * motion[contact, 2]
        for i in range(system.first[contact], system.first[contact + 1]):
            out[0, i] += forward + angle * positions[1, i]
            out[1, i] += lateral - angle * positions[0, i]


@kernel(inline="always")
def move_forward(factor: float, out: np.ndarray) -> None:
    """Add a uniform forward displacement to a field."""
    for i in range(out.shape[1]):
        out[0, i] += factor


@kernel(inline="always")
def sum_forces(system: System, q: np.ndarray, out: np.ndarray) -> None:
    """Fill out, (3,), with forward force, lateral force and torque of tractions."""
    positions, resultants = system.positions, system.resultants
    ahead, aside, torque = 0.0, 0.0, 0.0
    for i in range(q.shape[1]):
        forward, lateral = system.weight[i] * q[0, i], system.weight[i] * q[1, i]
        ahead += forward
        aside += lateral
        torque += positions[1, i] * forward - positions[0, i] * lateral
    out[0], out[1], out[2] = resultants[0] * ahead, resultants[1] * aside, resultants[2] * torque


@kernel(inline="always")
def forward_force(system: System, q: np.ndarray) -> float:
    """Forward force of tractions."""
    force = 0.0
    for i in range(q.shape[1]):
        force += system.weight[i] * q[0, i]
    return force


@kernel(inline="always")
def mirrored(system: System, state: np.ndarray, out: np.ndarray) -> None:
    """Fill out with the mirror image of tractions, lateral -> -lateral."""
    for i in range(out.shape[1]):
        out[0, i] = state[0, system.mirror[i]]
        out[1, i] = -state[1, system.mirror[i]]


@kernel
def force_norm(system: System, change: np.ndarray, scratch: np.ndarray) -> float:
    """Bound on the force that a change of tractions carries: |dF|^2 <= stiffness <dq, A dq>."""
    multiply(system.operators, COMPLIANCE, change, scratch)
    energy = 0.0
    for c in range(2):
        for i in range(change.shape[1]):
            energy += system.weight[i] * change[c, i] * scratch[c, i]
    return np.sqrt(system.stiffness * max(energy, 0.0))


@kernel(inline="always")
def project(q: np.ndarray, bound: np.ndarray) -> None:
    """Shrink tractions onto the bound, in place."""
    for i in range(q.shape[1]):
        f = shrink(q[0, i], q[1, i], bound[i])
        q[0, i], q[1, i] = f * q[0, i], f * q[1, i]


@kernel(inline="always")
def add(out: np.ndarray, factor: float, values: np.ndarray) -> None:
    """out += factor values, for fields."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] += factor * values[c, i]


@kernel(inline="always")
def copy(out: np.ndarray, values: np.ndarray) -> None:
    """out[...] = values for fields, which compiles faster than the assignment."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] = values[c, i]
