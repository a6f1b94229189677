"""Rings times angles of several contacts on one body: far apart, so that they share its forward
displacement alone.

To a step these are the rings of one contact, none of which feels those of another.  Units are those
of the rings alone, see rings/side_by_side.py: with `extent` and `share` of a contact

    influence extent A,   weights share w,   stiffness k share / extent,

and a turn by an angle in its own units moves points at their own places by extent times as much.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from microslip.contacts.system import System
from microslip.models.path import BodyPath
from microslip.models.polar.angular_modes import Sectors, quickest, scaled
from microslip.models.polar.contact import PolarContact
from microslip.models.system_contact import bounds_of_each


class PolarSideBySide(PolarContact):
    """The contacts of one body; states have shape (2, angles, cells of all).

    Parameters
    ----------
    contacts : sequence of PolarContact
        Each in its own units; of the same angles.
    shares, extents : sequence of float
        Of the load of the body, sum 1; u_lim of each over that of the body.
    """

    def __init__(
        self, contacts: Sequence[PolarContact], shares: Sequence[float], extents: Sequence[float]
    ):
        first, scaled_by = contacts[0], list(zip(contacts, shares, extents, strict=True))
        self.angles, self.rotates = first.angles, first.rotates
        self.whole, self._half = first.whole, first._half

        def joined(values):
            return np.concatenate(list(values), axis=-1)

        self.bound = joined(one.bound for one in contacts)
        self.weight = joined(one.weight * share for one, share, _ in scaled_by)
        self.compliance = joined(one.compliance * extent for one, _, extent in scaled_by)
        self.penalty = joined(one.penalty * extent for one, _, extent in scaled_by)
        self.forward_position = joined(one.forward_position for one in contacts)
        self.lateral_position = joined(one.lateral_position for one in contacts)
        self.influence = _apart([scaled(one.influence, by) for one, _, by in scaled_by])
        self.inverse = _apart([scaled(one.inverse, 1.0 / by) for one, _, by in scaled_by])
        self.stiffness = sum(one.stiffness * share / extent for one, share, extent in scaled_by)
        self._contacts = contacts

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """As RingsSideBySide.bounds."""
        each = zip(self._contacts, depths, strict=True)
        return np.concatenate([one.bounds(own) for one, own in each], axis=1)

    def field_bounds(self, path: BodyPath) -> np.ndarray:
        """Friction bounds along a path, see SystemContact.field_bounds."""
        return bounds_of_each(self._contacts, path)

    def system(self) -> System:
        """The System of the points of all contacts."""
        cells = [len(one.bound) for one in self._contacts]
        return super().system()._replace(first=np.concatenate([[0], np.cumsum(cells)]))


def _apart(operators: Sequence[Sectors]) -> Sectors:
    """One operator on the rings of all, of the same angles, that keeps their modes apart."""
    pairs = 2 if (operators[0].members[:, :, 1] >= 0).any() else 1
    cells = [one.blocks.shape[2] // pairs for one in operators]
    shape = operators[0].blocks.shape[:2]
    blocks = np.zeros((*shape, pairs, sum(cells), pairs, sum(cells)))
    end = np.cumsum(cells)
    for one, n, last in zip(operators, cells, end, strict=True):
        own = slice(last - n, last)
        blocks[:, :, :, own, :, own] = one.blocks.reshape(*shape, pairs, n, pairs, n)
    size = pairs * sum(cells)
    none, blocks = np.zeros((0, 0, 0)), blocks.reshape(*shape, size, size)
    return quickest(operators[0]._replace(dense=none, blocks=blocks))
