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
import scipy

from microslip.models.path import BodyPath
from microslip.models.pull import Body, PulledMarch
from microslip.models.rings.contact import RadialContact


class RingsSideBySide(RadialContact):
    """The contacts of one body; states have shape (2, 1, cells of all).

    Parameters
    ----------
    contacts : sequence of RadialContact
        Each in its own units.
    shares, extents : sequence of float
        Of the load of the body, sum 1; u_lim of each over that of the body.
    """

    has_sensitivity = False

    def __init__(
        self, contacts: Sequence[RadialContact], shares: Sequence[float], extents: Sequence[float]
    ):
        scaled = list(zip(contacts, shares, extents, strict=True))
        super().__init__(
            scipy.linalg.block_diag(*(one.influence * extent for one, _, extent in scaled)),
            np.concatenate([one.bound for one in contacts]),
            np.concatenate([one.weight * share for one, share, _ in scaled]),
            sum(one.stiffness * share / extent for one, share, extent in scaled),
        )
        self._contacts = contacts
        self._imposed = None, None

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Bounds of all rings, (k, cells of all), where each contact is at its depths, one a
        row."""
        each = zip(self._contacts, depths, strict=True)
        return np.concatenate([one.bounds(own) for one, own in each], axis=1)

    def pulled_march(
        self,
        path: BodyPath,
        state: np.ndarray,
        tolerance: float,
        body: Body,
        start: np.ndarray,
        previous: PulledMarch | None = None,
    ) -> PulledMarch:
        """March of the body along a BodyPath; see models.pull.PullsContact."""
        if self._imposed[0] is not path:
            bounds = path.bounds(self._contacts)
            self._imposed = path, (path.under(bounds), self._ahead_of(path))
        imposed = self._imposed[1]
        return self._pulled_along(path, imposed, state, tolerance, (body, start), previous)

    def _ahead_of(self, path: BodyPath):
        """What each contact does besides, weighted, (1 + steps stages, 2, cells)."""
        cells = [len(one.bound) for one in self._contacts]
        ahead = np.repeat(path.besides()[:, :, :2], cells, axis=0)
        return np.ascontiguousarray(np.moveaxis(ahead, 0, -1)) * self.weight
