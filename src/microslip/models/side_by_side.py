"""Several contacts on one body, far apart, so that they share its displacement alone.

They are in the units of the body: u_lim of the contact that carries the mean load, and mu times the
load of all.  A contact whose own u_lim is larger by `extent`, and that carries a `share` of the
load, has

    influence extent A,   weights share w,   stiffness k share / extent,

tractions and bounds being what they are in its own units.  A rotation by an angle in the units of a
contact moves its points by extent times as much.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from microslip.models.path import BodyPath, Path
from microslip.models.system_contact import SystemContact


class SideBySide(SystemContact):
    """Contacts of equal shape on one body; states have those of each side by side along axis 2.

    Parameters
    ----------
    contacts : sequence of SystemContact
        Each in its own units.
    shares, extents : sequence of float
        Fraction of the load of the body, sum 1; u_lim of each over that of the body.
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
        """The solver of a step, of points with these areas."""
        each = [one.system().solver for one in self._contacts]
        return each[0].joined(each, self._extents, weight)

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Bounds of all contacts, (k, cells of all), where each is at its depths, one a row."""
        each = zip(self._contacts, depths, strict=True)
        return np.concatenate([one.bounds(own) for one, own in each], axis=1)

    def field_bounds(self, path: Path) -> np.ndarray:
        """Friction bounds along a path, see SystemContact.field_bounds."""
        assert isinstance(path, BodyPath)  # as that of a body is
        each = zip(self._contacts, path.each, strict=True)
        return np.concatenate([one.field_bounds(own) for one, own in each], axis=-1)
