"""Squares of several contacts on one body, side by side along the lateral axis.

They are far apart and share the forward displacement of the body alone.  Units are those of the
body, see rings/side_by_side.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.contacts.descent import PATIENCE, Descent
from microslip.contacts.operators import operator
from microslip.contacts.system import System
from microslip.foundation.compiled import kernel
from microslip.models.path import BodyPath
from microslip.models.squares.contact import CartesianContact
from microslip.models.squares.convolution import Convolved, apply_convolution
from microslip.models.system_contact import SystemContact, bounds_of_each


class ConvolvedApart(NamedTuple):
    """The operator on squares of several contacts side by side, of equal shape.

    Attributes
    ----------
    convolved : Convolved
        Of each.
    extents : np.ndarray, shape (contacts,)
        u_lim of each over that of the body.
    given, result : np.ndarray, field of one contact
        Scratch.
    """

    convolved: Convolved
    extents: np.ndarray
    given: np.ndarray
    result: np.ndarray


@operator(ConvolvedApart)
@kernel
def apply_apart(apart: ConvolvedApart, field: np.ndarray, image: np.ndarray) -> None:
    """image = A field, contact by contact."""
    given, result, columns = apart.given, apart.result, apart.given.shape[2]
    for one in range(len(apart.extents)):
        for c in range(2):
            for j in range(given.shape[1]):
                for i in range(columns):
                    given[c, j, i] = field[c, j, one * columns + i]
        apply_convolution(apart.convolved, given, result)
        for c in range(2):
            for j in range(given.shape[1]):
                for i in range(columns):
                    image[c, j, one * columns + i] = apart.extents[one] * result[c, j, i]


class SquaresSideBySide(SystemContact):
    """The contacts of one body; states have those of each side by side along axis 2.

    Parameters
    ----------
    contacts : sequence of CartesianContact
        Equal, each in its own units.
    shares, extents : sequence of float
        Fraction of the load of the body, sum 1; u_lim of each over that of the body.
    """

    angles = 1

    def __init__(
        self,
        contacts: Sequence[CartesianContact],
        shares: Sequence[float],
        extents: Sequence[float],
    ):
        self._one, self._contacts = contacts[0], contacts
        shares, self._extents = np.array(shares, dtype=float), np.array(extents, dtype=float)
        one, columns = self._one, self._one.bound.shape[1]
        self.bound, self.forward_position, self.lateral_position = (
            np.tile(field, len(contacts))
            for field in (one.bound, one.forward_position, one.lateral_position)
        )
        self.weight = np.tile(one.weight, len(contacts)) * np.repeat(shares, columns)
        self.compliance = np.tile(one.compliance, len(contacts))
        self.compliance = self.compliance * np.repeat(self._extents, columns)
        self.stiffness = float((one.stiffness * shares / self._extents).sum())

    def system(self) -> System:
        """The System of the squares of all contacts."""
        alone, (rows, columns) = self._one.system(), self.bound.shape
        each, count = columns // len(self._contacts), len(self._contacts)
        points, mirror = np.arange(rows * columns).reshape(rows, columns), alone.mirror
        mirror = mirror.reshape(rows, each) % each  # columns: a square keeps its row
        columns_of = [mirror + one * each for one in range(count)]
        mirror = np.take_along_axis(points, np.concatenate(columns_of, axis=1), axis=1)
        field = np.empty((2, rows, each))
        return alone._replace(
            compliance=ConvolvedApart(alone.compliance, self._extents, field, np.empty_like(field)),
            solver=Descent(
                float(alone.solver.largest * self._extents.max()),
                PATIENCE,
                np.array([1.0 / self.compliance[0].max()]),
                np.empty((3, columns)),
            ),
            scale=self.compliance[0],
            weight=self.weight[0],
            positions=(self.forward_position, self.lateral_position),
            first=each * np.arange(count + 1),
            mirror=mirror.ravel(),
            stiffness=self.stiffness,
        )

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q in the units of the body, as the state."""
        out = np.empty(state.shape)
        apply_apart(self.system().compliance, np.ascontiguousarray(state), out)
        return out

    def field_bounds(self, path: BodyPath) -> np.ndarray:
        """Friction bounds along a path, see SystemContact.field_bounds."""
        return bounds_of_each(self._contacts, path)
