"""A body that a force or a spring drives, and what a march of it returns (contacts/drive.py)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from microslip.contacts.drive import Drive
from microslip.models.contact import March
from microslip.models.path import Path


@dataclass(frozen=True)
class Body:
    """A driven body and its drive, in working units.

    Attributes
    ----------
    stiffness, damping, mass : float
        k over mu F_z / u_lim, c and m by the phase likewise; all 0: the load alone pulls.
    load : float
        Force that does not change, over mu F_z.
    """

    stiffness: float
    damping: float
    mass: float
    load: float

    @property
    def remembers(self) -> bool:
        """Whether x and x' belong to the state: else the tractions tell x."""
        return self.mass > 0.0 or self.damping > 0.0

    def along(self, path: Path, start: np.ndarray) -> Drive:
        """The Drive along a path, from x and x' at its start."""
        share = 1.0 / (1.0 + path.carry[-1].sum())  # a stiffly accurate method carries the rest
        lengths = share * np.diff(path.phase)
        return Drive(
            float(self.stiffness),
            float(self.damping),
            float(self.mass),
            float(self.load),
            lengths,
            np.array(start, dtype=float),
        )


@dataclass(frozen=True, eq=False)
class PulledMarch(March):
    """A March of a driven body.

    Attributes
    ----------
    body : np.ndarray, shape (steps + 1, 2)
        x and x' at every phase.
    """

    body: np.ndarray = field(kw_only=True)
