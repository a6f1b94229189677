"""Rings of several contacts on one body: far apart, so that they share its displacement alone.

To a step these are the rings of one contact whose influence matrix has a block for each.  They are
in the units of the body: u_lim of the contact that carries the mean load, and mu times the load of
all.  A contact whose own u_lim is larger by `extent`, and that carries a `share` of the load, has

    influence extent A,   weights share w,   stiffness k share / extent,

tractions and bounds being what they are in its own units.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from microslip.contacts.system import System
from microslip.models.path import BodyPath
from microslip.models.rings.contact import RadialContact
from microslip.models.system_contact import bounds_of_each


class RingsSideBySide(RadialContact):
    """The contacts of one body; states have shape (2, 1, cells of all).

    Parameters
    ----------
    contacts : sequence of RadialContact
        Each in its own units.
    shares, extents : sequence of float
        Of the load of the body, sum 1; u_lim of each over that of the body.
    """

    def __init__(
        self, contacts: Sequence[RadialContact], shares: Sequence[float], extents: Sequence[float]
    ):
        scaled = list(zip(contacts, shares, extents, strict=True))
        super().__init__(
            _block_diagonal([one.influence * extent for one, _, extent in scaled]),
            np.concatenate([one.bound for one in contacts]),
            np.concatenate([one.weight * share for one, share, _ in scaled]),
            sum(one.stiffness * share / extent for one, share, extent in scaled),
        )
        self.rings_of_a_contact = len(contacts[0].bound)
        self._contacts = contacts

    def system(self) -> System:
        """The System of the rings of all contacts."""
        cells = [len(one.bound) for one in self._contacts]
        return super().system()._replace(first=np.concatenate([[0], np.cumsum(cells)]))

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Bounds of all rings, (k, cells of all), where each contact is at its depths, one a
        row."""
        each = zip(self._contacts, depths, strict=True)
        return np.concatenate([one.bounds(own) for one, own in each], axis=1)

    def field_bounds(self, path: BodyPath) -> np.ndarray:
        """Friction bounds along a path, see SystemContact.field_bounds."""
        return bounds_of_each(self._contacts, path)


def _block_diagonal(blocks):
    """The matrix with these blocks."""
    sizes = np.cumsum([0, *(len(block) for block in blocks)])
    out = np.zeros((sizes[-1], sizes[-1]))
    for block, start, end in zip(blocks, sizes, sizes[1:], strict=False):
        out[start:end, start:end] = block
    return out
