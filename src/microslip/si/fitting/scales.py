"""From a guess of both unknowns to the dimensionless points of all rows, and back.

The unknowns are mu and a second one that sets the scale: u_lim at the mean load, which needs no
knowledge of the bodies, or the shear modulus.  Under another load u_lim goes like
its power 2/3 and the contact radius like its power 1/3 (Hertz).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from microslip.si.bodies import TwoBodies
from microslip.si.fitting.measured import Measured
from microslip.si.materials import RIGID, Material
from microslip.theory import hertz


class Points(NamedTuple):
    """Points for microslip.solve: velocity and amplitude, shape (n,) each."""

    velocity: np.ndarray
    amplitude: np.ndarray


@dataclass(frozen=True, eq=False)
class Scale:
    """The second unknown of a fit.

    Attributes
    ----------
    rows : Measured
        The measurements.
    poisson : float
        Poisson's ratio, dimensionless: of the one half-space that stands for both bodies, or of the
        bodies.
    unit, name : str
        Unit of the second unknown, and its name in words.
    """

    rows: Measured
    poisson: float
    unit: ClassVar[str]
    name: ClassVar[str]

    @property
    def mean_load(self) -> float:
        """N."""
        return float(self.rows.load.mean())

    def u_lim(self, mu: float, scale: float) -> float:
        """At the mean load, m."""
        raise NotImplementedError

    def bounds(self, least: float, most: float) -> tuple[float, float]:
        """Range of the second unknown, for amplitudes from `least` to `most`."""
        raise NotImplementedError

    def points(self, mu: float, scale: float, rows: Measured | None = None) -> Points:
        """Velocity and amplitude of each row; rows: others than those of the fit."""
        rows = self.rows if rows is None else rows
        u_lim = self.u_lim(mu, scale) * (rows.load / self.mean_load) ** (2.0 / 3.0)
        return Points(rows.speed / (rows.omega * u_lim), rows.amplitude / u_lim)


@dataclass(frozen=True, eq=False)
class Displacement(Scale):
    """The second unknown is u_lim at the mean load, m; for motions along a line."""

    unit, name = "m", "u_lim"

    def u_lim(self, mu: float, scale: float) -> float:
        """At the mean load, m."""
        return scale

    def bounds(self, least: float, most: float) -> tuple[float, float]:
        """Range that lets the amplitudes of some rows be within a range.

        At its ends all that are not 0 are at most `least`, or at least `most`.
        """
        sizes = self.points(1.0, 1.0).amplitude
        sizes = sizes[sizes > 0.0]
        return float(sizes.min()) / most, float(sizes.max()) / least


@dataclass(frozen=True, eq=False)
class Modulus(Scale):
    """The second unknown is the shear modulus, Pa: of one body on a rigid one, or of two alike.

    Attributes
    ----------
    spin : bool
        Whether the amplitude is an angle, of a bore.
    alike : bool
        Whether both bodies have that modulus; else the second one is rigid.
    radius : float
        Radius of relative curvature, m.
    """

    spin: bool
    alike: bool
    radius: float
    unit, name = "Pa", "shear modulus"

    def contact(self, mu: float, scale: float) -> TwoBodies:
        """The contact under the mean load."""
        body = Material(2.0 * scale * (1.0 + self.poisson), self.poisson)
        other = body if self.alike else RIGID
        return TwoBodies(body, other, self.radius, self.mean_load, mu)

    def points(self, mu: float, scale: float, rows: Measured | None = None) -> Points:
        """Velocity and amplitude of each row; rows: others than those of the fit."""
        rows = self.rows if rows is None else rows
        if not self.spin:
            return super().points(mu, scale, rows)
        contact, share = self.contact(mu, scale), rows.load / self.mean_load
        arc = rows.amplitude * contact.contact_radius * share ** (1.0 / 3.0)
        moving = arc > 0.0  # an angle of 0 leaves no unit for the velocity, and needs none
        velocity = np.divide(rows.speed, rows.omega * arc, out=np.zeros_like(arc), where=moving)
        size = arc / (contact.u_lim * share ** (2.0 / 3.0))
        return Points(velocity, np.asarray(hertz.bore_amplitude(size, self.poisson)))

    def bounds(self, least: float, most: float) -> tuple[float, float]:
        """Shear moduli of bodies that are pressed on one another, whatever the amplitudes."""
        return SOFTEST, HARDEST

    def u_lim(self, mu: float, scale: float) -> float:
        """At the mean load, m."""
        return self.contact(mu, scale).u_lim


SOFTEST, HARDEST = 1e2, 1e13
"""Smallest and largest shear modulus, Pa: that of a weak gel, and one above diamond."""
