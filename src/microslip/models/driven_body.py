"""A body driven by a force or a spring, and its equation of motion along a path
(contacts/drive.py)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.contacts.drive import Drive
from microslip.models.path import Path


@dataclass(frozen=True)
class Body:
    """A driven body and its drive, in working units.

    Attributes
    ----------
    stiffness, damping, mass : float
        Stiffness k, damping c and mass m in units of mu F_z and u_lim, with the phase as time. All
        are 0 for a massless body driven by a constant force.
    load : float
        Constant force divided by mu F_z.
    """

    stiffness: float
    damping: float
    mass: float
    load: float

    @property
    def remembers(self) -> bool:
        """Whether x and x' are part of the state. Otherwise x is computed from the tractions."""
        return self.mass > 0.0 or self.damping > 0.0

    def along(self, path: Path, start: np.ndarray) -> Drive:
        """Return the Drive for a path; start: x and x' at the start of the path, shape (2,)."""
        share = 1.0 / (1.0 + path.carry[-1].sum())  # gamma: the last row of a_ij sums to 1
        lengths = share * np.diff(path.phase)
        return Drive(
            float(self.stiffness),
            float(self.damping),
            float(self.mass),
            float(self.load),
            lengths,
            np.array(start, dtype=float),
        )
