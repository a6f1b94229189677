"""A contact as compiled code sees it: points, elastic operators, and sums over the points.

A field has the shape (2, rows, columns): forward and lateral component at every point.  Bounds have
the shape (1 or rows, columns).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.contacts.coulomb import shrink
from microslip.contacts.operators import multiply
from microslip.foundation.compiled import kernel


class System(NamedTuple):
    """The points of a contact, or of several contacts that carry one body, column by column.

    Attributes
    ----------
    compliance : operator
        A: tractions to displacements, see operators.py.
    solver : Resolvent or Descent
        How a Coulomb step is solved: splitting.Resolvent or descent.Descent.
    scale : np.ndarray, shape (columns,)
        Displacement of a point under a unit traction on itself.
    weight : np.ndarray, shape (columns,)
        Area of a point of each column.
    positions : tuple of np.ndarray, shape (rows, columns) each
        Forward and lateral position of the points, over the contact radius.
    first : np.ndarray of int, shape (contacts + 1,)
        First column of each contact, and the number of columns.
    mirror : np.ndarray of int, shape (rows columns,)
        The point across the mirror lateral -> -lateral of each point.
    resultants : np.ndarray, shape (3,)
        1 for each of forward force, lateral force and torque that the points can have, 0 for those
        that symmetry cancels.
    stiffness : float
        Force over mu F_z per uniform displacement u_lim without slip, at least.
    """

    compliance: NamedTuple
    solver: NamedTuple
    scale: np.ndarray
    weight: np.ndarray
    positions: tuple[np.ndarray, np.ndarray]
    first: np.ndarray
    mirror: np.ndarray
    resultants: np.ndarray
    stiffness: float


@kernel
def add_displacement(system: System, factor: float, motion: np.ndarray, out: np.ndarray) -> None:
    """out += factor times the rigid displacement of the points.

    motion: forward, lateral, angle of each contact, (contacts, 3); out: a field.
    """
    forward_position, lateral_position = system.positions
    for contact in range(len(motion)):
        forward, lateral = factor * motion[contact, 0], factor * motion[contact, 1]
        angle = factor * motion[contact, 2]
        for j in range(out.shape[1]):
            for i in range(system.first[contact], system.first[contact + 1]):
                out[0, j, i] += forward + angle * lateral_position[j, i]
                out[1, j, i] += lateral - angle * forward_position[j, i]


@kernel
def move_forward(factor: float, out: np.ndarray) -> None:
    """Add a uniform forward displacement to a field."""
    for j in range(out.shape[1]):
        for i in range(out.shape[2]):
            out[0, j, i] += factor


@kernel
def sum_forces(system: System, q: np.ndarray, out: np.ndarray) -> None:
    """Fill out, (3,), with forward force, lateral force and torque of tractions."""
    forward_position, lateral_position = system.positions
    weight, resultants = system.weight, system.resultants
    ahead, aside, torque = 0.0, 0.0, 0.0
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            forward, lateral = weight[i] * q[0, j, i], weight[i] * q[1, j, i]
            ahead += forward
            aside += lateral
            torque += lateral_position[j, i] * forward - forward_position[j, i] * lateral
    out[0], out[1], out[2] = resultants[0] * ahead, resultants[1] * aside, resultants[2] * torque


@kernel
def forward_force(system: System, q: np.ndarray) -> float:
    """Forward force of tractions."""
    force = 0.0
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            force += system.weight[i] * q[0, j, i]
    return force


@kernel
def mirrored(system: System, state: np.ndarray, out: np.ndarray) -> None:
    """Fill out with the mirror image of tractions, lateral -> -lateral."""
    for c in range(2):
        sign, source, target = 1.0 - 2.0 * c, state[c].ravel(), out[c].ravel()
        for i in range(target.size):
            target[i] = sign * source[system.mirror[i]]


@kernel
def force_norm(system: System, change: np.ndarray, scratch: np.ndarray) -> float:
    """Bound on the force that a change of tractions carries: |dF|^2 <= stiffness <dq, A dq>."""
    multiply(system.compliance, change, scratch)
    energy = 0.0
    for c in range(2):
        for j in range(change.shape[1]):
            for i in range(change.shape[2]):
                energy += system.weight[i] * change[c, j, i] * scratch[c, j, i]
    return np.sqrt(system.stiffness * max(energy, 0.0))


@kernel
def project(q: np.ndarray, bound: np.ndarray) -> None:
    """Shrink tractions onto the bound, in place."""
    last = len(bound) - 1
    for j in range(q.shape[1]):
        for i in range(q.shape[2]):
            f = shrink(q[0, j, i], q[1, j, i], bound[min(j, last), i])
            q[0, j, i], q[1, j, i] = f * q[0, j, i], f * q[1, j, i]


@kernel
def add(out: np.ndarray, factor: float, values: np.ndarray) -> None:
    """out += factor values, for fields."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] += factor * values[c, j, i]


@kernel
def copy(out: np.ndarray, values: np.ndarray) -> None:
    """out[...] = values for fields, which compiles faster than the assignment."""
    for c in range(2):
        for j in range(out.shape[1]):
            for i in range(out.shape[2]):
                out[c, j, i] = values[c, j, i]
