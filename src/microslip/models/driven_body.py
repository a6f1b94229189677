"""A body that a force or a spring drives, and its equation along a path (contacts/drive.py)."""

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
        k over mu F_z / u_lim, and c and m in the same units with the phase as time; all are 0 if a
        constant force alone drives a body without mass.
    load : float
        Constant force, over mu F_z.
    """

    stiffness: float
    damping: float
    mass: float
    load: float

    @property
    def remembers(self) -> bool:
        """Whether x and x' belong to the state; otherwise x follows from the tractions."""
        return self.mass > 0.0 or self.damping > 0.0

    def along(self, path: Path, start: np.ndarray) -> Drive:
        """The Drive along a path, from x and x' at its start, shape (2,)."""
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
