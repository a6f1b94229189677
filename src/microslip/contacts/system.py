"""Contacts in compiled code: points, elastic operators, and sums over the points.

A field has the shape (2, points): forward and lateral components at the points of all contacts, one
contact after the other.  Additional points with area 0 and friction bound 0 are allowed.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.operators import multiply
from microslip.foundation.compiled import kernel

COMPLIANCE = 0
"""Index of the operator A among the operators of a contact."""


class System(NamedTuple):
    """The points of a contact, or of several contacts that carry one body.

    Attributes
    ----------
    operators : NamedTuple
        The operator A, which maps tractions to displacements, and the resolvents of the solver; see
        operators.py.
    solver : Resolvent or Descent
        Solver of Coulomb steps: splitting.Resolvent or descent.Descent.
    scale : np.ndarray, shape (points,)
        Displacement of each point under a unit traction on the same point.
    weight : np.ndarray, shape (points,)
        Area of each point.
    positions : np.ndarray, shape (2, points)
        Forward and lateral coordinates of the points, divided by the contact radius.
    first : np.ndarray of int, shape (contacts + 1,)
        Index of the first point of each contact, followed by the total number of points.
    mirror : np.ndarray of int, shape (points,)
        Index of the mirror image of each point, under lateral -> -lateral.
    resultants : np.ndarray, shape (3,)
        Factors of the forward force, the lateral force and the torque: 0 if symmetry cancels this
        component, otherwise 1.
    stiffness : float
        Force for a uniform displacement u_lim without slip, divided by mu F_z, or an upper bound on
        this value.
    """

    operators: Any  # of a class that is registered with operators.operator
    solver: Any  # of a class that is registered with step.step_solver
    scale: np.ndarray
    weight: np.ndarray
    positions: np.ndarray
    first: np.ndarray
    mirror: np.ndarray
    resultants: np.ndarray
    stiffness: float


@kernel(inline="always")
def add_displacement(system: System, factor: float, motion: np.ndarray, out: np.ndarray) -> None:
    """Add a factor times the rigid displacement of the points to the field `out`.

    motion: forward, lateral and angular displacement of each contact, (contacts, 3).
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
    """Fill `out`, shape (3,), with the forward force, the lateral force and the torque due to
    tractions."""
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
    """Return the forward force due to tractions."""
    force = 0.0
    for i in range(q.shape[1]):
        force += system.weight[i] * q[0, i]
    return force


@kernel(inline="always")
def mirrored(system: System, state: np.ndarray, out: np.ndarray) -> None:
    """Fill `out` with the mirror image of tractions, lateral -> -lateral."""
    for i in range(out.shape[1]):
        out[0, i] = state[0, system.mirror[i]]
        out[1, i] = -state[1, system.mirror[i]]


@kernel
def force_norm(system: System, change: np.ndarray, scratch: np.ndarray) -> float:
    """Upper bound on the change of force due to a change of tractions: |dF|^2 <= stiffness <dq, A
    dq>."""
    multiply(system.operators, COMPLIANCE, change, scratch)
    energy = 0.0
    for c in range(2):
        for i in range(change.shape[1]):
            energy += system.weight[i] * change[c, i] * scratch[c, i]
    return np.sqrt(system.stiffness * max(energy, 0.0))


@kernel(inline="always")
def project(q: np.ndarray, bound: np.ndarray) -> None:
    """Project tractions onto the friction bound, in place."""
    for i in range(q.shape[1]):
        f = shrink(q[0, i], q[1, i], bound[i])
        q[0, i], q[1, i] = f * q[0, i], f * q[1, i]


@kernel(inline="always")
def add(out: np.ndarray, factor: float, values: np.ndarray) -> None:
    """Add `factor` times `values` to the field `out`."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] += factor * values[c, i]


@kernel(inline="always")
def copy(out: np.ndarray, values: np.ndarray) -> None:
    """Copy a field; this compiles faster than out[...] = values."""
    for c in range(2):
        for i in range(out.shape[1]):
            out[c, i] = values[c, i]
