"""Hertz pressure over an ellipse."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.pressures.cell_loads import of_corner_loads
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz

SMALLEST_RATIO = 0.05
"""Smallest ratio of the semi-axes."""


@dataclass(frozen=True)
class Ellipse(Pressure):
    """The pressure of an elliptic Hertz contact with the semi-axes a and `ratio` * a.

    u_lim is the displacement at the centre under full slip.  Hence G* = 3 K / (2 pi), where K is
    the complete elliptic integral of the eccentricity; this is 3/4 for a circle.

    Parameters
    ----------
    ratio : float
        Ratio of the semi-axes, 0.05 to 1.
    across : int
        0 if the long axis is forward, 1 if it is lateral.

    Raises
    ------
    InputError
        If the ratio is outside its range, or if `across` is neither 0 nor 1.
    """

    ratio: float = 0.5
    across: int = 0

    hertzian = True

    def __post_init__(self) -> None:
        super().__post_init__()
        limits = (SMALLEST_RATIO, 1.0)
        spec.refuse_outside(self.name, "pressure", "ratio", self.ratio, limits)
        if self.across not in (0, 1):
            raise InputError("pressure", self.name, f"across = {self.across:g}: allowed is 0 or 1")

    @property
    def summary(self) -> str:
        return f"a Hertz contact on an ellipse of ratio {self.ratio:g}"

    @cached_property
    def G_star(self) -> float:
        return 1.5 / np.pi * float(scipy.special.ellipk(1.0 - self.ratio**2))

    @cached_property
    def torque(self) -> float:
        """Mean distance from the centre, weighted by the pressure.

        It is 3 pi/16 on the unit circle.  To obtain the ellipse, one axis of this circle is scaled
        by the ratio.  This multiplies the distance along a ray at the angle t by hypot(cos t, ratio
        sin t).
        """
        angle = (np.arange(512) + 0.5) * (np.pi / 1024)
        stretch = np.hypot(np.cos(angle), self.ratio * np.sin(angle))
        return hertz.TORQUE_FULL_SLIP * float(stretch.mean())

    @property
    def area(self) -> float:
        return np.pi * self.ratio

    @property
    def largest(self) -> float:
        return 1.5 / (np.pi * self.ratio)

    @property
    def half_widths(self) -> tuple[float, float]:
        return (self.ratio, 1.0) if self.across else (1.0, self.ratio)

    def cell_loads(self, cells: int) -> np.ndarray:
        """Compute the load on each cell, (cells, cells)."""
        return hertz_loads(cells)

    def loading(self, displacement: np.ndarray | float) -> np.ndarray | float:
        """Tangential force after a displacement from rest.  It is the same as for a sphere."""
        return hertz.mindlin_force(displacement)


def hertz_loads(cells: int) -> np.ndarray:
    """Compute the load of Hertz pressure on each cell of the rectangle around the ellipse, (cells,
    cells).  It does not depend on the ratio of the semi-axes."""
    edges = np.arange(cells + 1) * 2.0 / cells - 1.0
    x, y = edges[:, None], edges[None, :]
    # load of the rectangle from the centre to (x, y), odd in both coordinates; the root is zero
    # outside the disc, as the pressure is
    root = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    load = x * y * root - np.arctan2(x * y, root)
    load = load + 0.5 * x * (3.0 - x * x) * np.arctan2(y, root)
    load = load + 0.5 * y * (3.0 - y * y) * np.arctan2(x, root)
    return of_corner_loads(load / (2.0 * np.pi))
