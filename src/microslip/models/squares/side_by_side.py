"""Squares of several contacts on one body: each is solved by itself, in its own units, at the place
of the body that balances the sum of their forces; see pulled_march.py."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from microslip.models.path import BodyPath
from microslip.models.pull import Body, PulledMarch
from microslip.models.squares.contact import CartesianContact


class SquaresSideBySide:
    """The contacts of one body; states are those of each, one beside the other along axis 2.

    Parameters
    ----------
    contacts : sequence of CartesianContact
        Alike, in their own units.
    shares, extents : sequence of float
        Of the load of the body, sum 1; u_lim of each over that of the body.
    """

    has_sensitivity = False
    sticks = True
    angles = 1
    radius = 1.0

    def __init__(
        self,
        contacts: Sequence[CartesianContact],
        shares: Sequence[float],
        extents: Sequence[float],
    ):
        self._one, self._count = contacts[0], len(contacts)
        self._shares, self._extents = np.array(shares), np.array(extents)
        one, columns = self._one, self._one.bound.shape[1]
        self.bound, self.forward_position, self.lateral_position = (
            np.tile(field, self._count)
            for field in (one.bound, one.forward_position, one.lateral_position)
        )
        self.weight = np.tile(one.weight, self._count) * np.repeat(self._shares, columns)
        self.compliance = np.tile(one.compliance, self._count) * np.repeat(self._extents, columns)
        self.stiffness = float((one.stiffness * self._shares / self._extents).sum())

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q in the units of the body, as the state."""
        each = zip(self._extents, self._each(state), strict=True)
        return self._together([by * self._one.displacement(own) for by, own in each])

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Every contact in its own mirror image."""
        return self._together([self._one.mirrored(own) for own in self._each(state)])

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
        base = np.concatenate([path.positions[:1], path.stages.reshape(-1, 3)])
        moved = (base + path.besides()) / self._extents[:, None, None]
        standing = self._shares, self._extents, moved
        march = self._one.pulled_along(path, standing, self._each(state), tolerance, (body, start))
        return replace(march, state=self._together(march.state))

    def _each(self, state):
        """States of the contacts, the first axis."""
        return np.stack(np.split(state, self._count, axis=-1))

    def _together(self, states):
        """The state of all from those of the contacts."""
        return np.concatenate(list(states), axis=-1)
