"""Rings of several contacts on one body: far apart, so that they share its displacement alone.

To a step these are the rings of one contact whose influence matrix has a block for each.  They are
in the units of the body: u_lim of the contact that carries the mean load, and mu times the load of
all.  A contact whose own u_lim is larger by `extent`, and that carries a `share` of the load, has

    influence extent A,   weights share w,   stiffness k share / extent,

tractions and bounds being what they are in its own units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag

from microslip.models.path import Path
from microslip.models.pull import PulledMarch
from microslip.models.rings.contact import RadialContact


@dataclass(frozen=True, eq=False)
class BodyPath(Path):
    """A Path of a body, and what its contacts do besides.

    Attributes
    ----------
    each : tuple of path.Path
        Of every contact, relative to that of the body and cut into the same steps.
    """

    each: tuple[Path, ...] = ()


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
            block_diag(*(one.influence * extent for one, _, extent in scaled)),
            np.concatenate([one.bound for one in contacts]),
            np.concatenate([one.weight * share for one, share, _ in scaled]),
            sum(one.stiffness * share / extent for one, share, extent in scaled),
        )
        self._cells = [len(one.bound) for one in contacts]
        self._ahead = None, None

    def pulled_march(self, path, state, tolerance, body, start, previous=None) -> PulledMarch:
        """March of the body along a BodyPath; see models.pull.PullsContact."""
        if self._ahead[0] is not path:
            self._ahead = path, self._ahead_of(path)
        imposed = path.under(self.bound[None]), self._ahead[1]
        return self._pulled_along(path, imposed, state, tolerance, (body, start), previous)

    def _ahead_of(self, path):
        """What each contact does besides, weighted, (1 + steps stages, 2, cells)."""
        columns = []
        for one, cells in zip(path.each, self._cells, strict=True):
            stages = one.stages.reshape(-1, 3)
            moved = np.concatenate([one.positions[:1], stages])[:, :2]
            columns.append(np.repeat(moved[:, :, None], cells, axis=2))
        return np.concatenate(columns, axis=2) * self.weight
