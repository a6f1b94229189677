"""Convert both unknowns of a fit to the dimensionless points of all rows.

The unknowns are mu, and either u_lim at the mean load or the shear modulus.  A fit of u_lim needs
no elastic modulus.  u_lim is proportional to load^(2/3), and the contact radius to load^(1/3)
(Hertz).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from microslip.si.bodies import TwoBodies
from microslip.si.fitting.measured import Measured
from microslip.si.materials import RIGID, Material

LEAST, MOST = 0.03, 20.0
"""Smallest and largest dimensionless amplitude that a fit resolves.  At smaller amplitudes, nearly
the whole contact sticks.  At larger amplitudes, nearly the whole contact slides all the time."""


class Points(NamedTuple):
    """Dimensionless points for microslip.solve: velocity and amplitude, shape (n,) each."""

    velocity: np.ndarray
    amplitude: np.ndarray


@dataclass(frozen=True, eq=False)
class Scale:
    """The second unknown of a fit: u_lim at the mean load, m, for motions along a line.

    Attributes
    ----------
    rows : Measured
        The measurements.
    poisson : float
        Poisson's ratio of the equivalent half-space (fit of u_lim) or of the bodies (fit of the
        shear modulus).
    unit, name : str
        Unit and name of the second unknown.
    """

    rows: Measured
    poisson: float
    unit: ClassVar[str] = "m"
    name: ClassVar[str] = "u_lim"

    @property
    def mean_load(self) -> float:
        """Mean load of the rows, N."""
        return float(self.rows.load.mean())

    def u_lim(self, mu: float, scale: float) -> float:
        """u_lim at the mean load, m."""
        return scale

    @property
    def bounds(self) -> tuple[float, float]:
        """Smallest and largest value of the second unknown.

        For the largest u_lim, no amplitude exceeds LEAST.  For the smallest one, all positive
        amplitudes are at least MOST.
        """
        sizes = self.points(1.0, 1.0).amplitude
        sizes = sizes[sizes > 0.0]
        return float(sizes.min()) / MOST, float(sizes.max()) / LEAST

    def points(self, mu: float, scale: float, rows: Measured | None = None) -> Points:
        """Velocity and amplitude of each row.  By default, the rows are those of the fit."""
        rows = self.rows if rows is None else rows
        u_lim = self.u_lim(mu, scale) * (rows.load / self.mean_load) ** (2.0 / 3.0)
        return Points(rows.speed / (rows.omega * u_lim), rows.amplitude / u_lim)


@dataclass(frozen=True, eq=False)
class Modulus(Scale):
    """Fit of the shear modulus, Pa.

    Both bodies have this modulus, or one of them is rigid.

    Attributes
    ----------
    alike : bool
        True if both bodies have this modulus, False if the second one is rigid.
    radius : float
        Radius of relative curvature, m.
    """

    alike: bool
    radius: float
    unit = "Pa"
    name = "shear modulus"

    def contact(self, mu: float, scale: float) -> TwoBodies:
        """The contact at the mean load."""
        body = Material(2.0 * scale * (1.0 + self.poisson), self.poisson)
        other = body if self.alike else RIGID
        return TwoBodies(body, other, self.radius, self.mean_load, mu)

    @property
    def bounds(self) -> tuple[float, float]:
        """Smallest and largest shear modulus of solids."""
        return SOFTEST, HARDEST

    def u_lim(self, mu: float, scale: float) -> float:
        """u_lim at the mean load, m."""
        return self.contact(mu, scale).u_lim


SOFTEST, HARDEST = 1e2, 1e13
"""Smallest and largest shear modulus, Pa.  A weak gel has the smallest modulus.  The largest
modulus exceeds diamond's."""
