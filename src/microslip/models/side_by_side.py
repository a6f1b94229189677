"""Several contacts that carry one body.  They share its displacement and do not interact
elastically.

Units are those of the body: displacements are in u_lim of a contact under the mean load, and forces
are in mu times the load of all contacts.  If the u_lim of a contact is `extent` times larger, and
the contact carries the fraction `share` of the load, then it has

    influence extent A,   weights share w,   stiffness k share / extent.

The values of its tractions and bounds are the same in both systems of units.  Rotations are in the
units of the contact.  The displacements that they cause are `extent` times larger in the units of
the body.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from microslip.contacts.coulomb import project
from microslip.models.path import BodyPath, Path
from microslip.models.system_contact import SystemContact


class SideBySide(SystemContact):
    """Contacts of equal shape on one body.  Their states are concatenated along axis 2.

    Parameters
    ----------
    contacts : sequence of SystemContact
        The contacts, each in its own units.
    shares, extents : sequence of float
        Fraction of the body's load on each contact (the sum is 1), and u_lim of each contact
        divided by the body's u_lim.
    """

    def __init__(
        self,
        contacts: Sequence[SystemContact],
        shares: Sequence[float],
        extents: Sequence[float],
    ):
        first, self._contacts, self._extents = contacts[0], contacts, np.array(extents, dtype=float)
        each = list(zip(contacts, shares, extents, strict=True))

        def joined(fields: Iterable[np.ndarray]) -> np.ndarray:
            return np.concatenate(list(fields), axis=-1)

        self.angles = first.angles
        self.bound = joined(one.bound for one in contacts)
        self.weight = joined(one.weight * share for one, share, _ in each)
        self.compliance = joined(one.compliance * extent for one, _, extent in each)
        self.forward_position = joined(one.forward_position for one in contacts)
        self.lateral_position = joined(one.lateral_position for one in contacts)
        self.stiffness = sum(one.stiffness * share / extent for one, share, extent in each)
        self.layout = first.layout._replace(contacts=len(contacts))
        rows, columns = first.forward_position.shape
        row, column = np.divmod(first.mirror.reshape(rows, columns), columns)
        of_first = row * columns * len(contacts) + column
        self.mirror = joined(of_first + k * columns for k in range(len(contacts))).ravel()

        operators = [one.operators for one in contacts]
        self.operators = operators[0].joined(operators, self._extents)
        self.resultants = first.resultants

    def solver(self, weight: np.ndarray) -> Any:
        """Create the solver of a Coulomb step for points with the areas `weight`."""
        each = [one.system().solver for one in self._contacts]
        return each[0].joined(each, self._extents, weight)

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Friction bounds (k, cells of all contacts) at the depths (contacts, k)."""
        each = zip(self._contacts, depths, strict=True)
        return np.concatenate([one.bounds(own) for one, own in each], axis=1)

    def field_bounds(self, path: Path) -> np.ndarray:
        """Friction bounds along a path, see SystemContact.field_bounds."""
        assert isinstance(path, BodyPath)  # the path of several contacts
        each = zip(self._contacts, path.each, strict=True)
        return np.concatenate([one.field_bounds(own) for one, own in each], axis=-1)

    def forces_of_each(self, path: Path, fields: np.ndarray) -> np.ndarray:
        """Forces of each contact at the phases of a march, shape (steps + 1, contacts, 3).

        fields: March.fields of a march along the path.  The forces are in the units of the body.
        """
        stages = path.stages.shape[1]
        bounds = self.layout.unpack(self.field_bounds(path))
        bounds = bounds if len(bounds) == 1 else bounds[::stages]
        loads = self.weight * project(np.moveaxis(fields[::stages], 1, 0), bounds)
        torques = self.lateral_position * loads[0] - self.forward_position * loads[1]
        values = np.stack([*loads, torques], axis=-1)
        steps, rows, _, three = values.shape
        return values.reshape(steps, rows, len(self._contacts), -1, three).sum(axis=(1, 3))
