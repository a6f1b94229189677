"""Every point corrects its own slip as if it were alone, all at once and undamped.

Neighbours answer to the same slip together and overshoot: the matrix of a contact is far from
diagonal.
"""

from __future__ import annotations

from microslip.solver.method import Method
from microslip.solver.methods._dense import DenseContact, descend


def _lengths(matrix, scale, damping):
    """What would take the slip of a point away if it were alone, times the damping."""
    return damping / scale


def _dress(contact, damping):
    return DenseContact(contact, descend, _lengths, damping=damping)


METHOD = Method("projected Jacobi, undamped", dress=_dress, parameters={"damping": 1.0})
