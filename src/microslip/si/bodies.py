"""Hertz contact of two elastic bodies in SI units, and their elastic mismatch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.materials import Material
from microslip.theory.hertz import checked


@dataclass(frozen=True)
class TwoBodies:
    """A sphere pressed against a flat or a second sphere.  At least one of the bodies is elastic.

    For tangential loads, two half-spaces are equivalent to one half-space whose compliance is the
    sum of both compliances.  The sums of 1/G and nu/G give G and Poisson's ratio of the equivalent
    half-space.  The normal and the tangential problem are assumed to be uncoupled.

    Attributes
    ----------
    first, second : Material
        The bodies.
    radius : float
        Radius of relative curvature, m: 1/R = 1/R1 + 1/R2.
    load : float
        Normal force, N.
    mu : float
        Coefficient of friction without vibration, dimensionless.
    radii : tuple of float
        R1 and R2, m, negative for a hollow body, infinite for a flat one.  If empty, R1 is
        `radius`, and the second body is flat.

    Raises
    ------
    ValueError
        If a value is not finite or not positive, or if both bodies are rigid.
    """

    first: Material
    second: Material
    radius: float
    load: float
    mu: float
    radii: tuple = ()
    pressure = "hertz"
    """Name of the pressure for microslip.solve."""

    def __post_init__(self) -> None:
        for name in ("radius", "load", "mu"):
            checked(name, getattr(self, name), low_open=True)
        if self.first.rigid and self.second.rigid:
            allowed = "allowed is an elastic body if the counterbody is rigid"
            raise InputError("material", "rigid", allowed)

    def with_load(self, load: float) -> TwoBodies:
        """A copy of the contact under another load, N."""
        return replace(self, load=load)

    @property
    def contradictions(self) -> Sequence[str]:
        """Messages about inputs that contradict each other."""
        return ()

    @property
    def bodies(self) -> tuple[Material, Material]:
        return (self.first, self.second)

    @property
    def E_star(self) -> float:
        """Contact modulus E*, Pa, from 1/E* = sum (1 - nu^2)/E (Hertz)."""
        return 1.0 / sum((1.0 - body.poisson**2) / body.young for body in self.bodies)

    @property
    def G(self) -> float:
        """Shear modulus for torsion, from 1/G = sum 1/G_i, Pa."""
        return 1.0 / sum(1.0 / body.shear_modulus for body in self.bodies)

    @property
    def poisson(self) -> float:
        """Poisson's ratio of the equivalent half-space, sum(nu/G) / sum(1/G)."""
        compliances = [1.0 / body.shear_modulus for body in self.bodies]
        total = sum(compliances)  # c / total is exactly 1 for one elastic body
        return sum(b.poisson * (c / total) for b, c in zip(self.bodies, compliances, strict=True))

    @property
    def G_star(self) -> float:
        """Tangential contact modulus G*, Pa, from 1/G* = sum (2 - nu)/(4 G) (Eq 3 for two
        bodies)."""
        return 4.0 * self.G / (2.0 - self.poisson)

    @property
    def contact_radius(self) -> float:
        """Contact radius a = (3 F R / (4 E*))^(1/3), m (Hertz)."""
        return (0.75 * self.load * self.radius / self.E_star) ** (1.0 / 3.0)

    @property
    def smallest_radius(self) -> float:
        """The smaller |radius| of the two bodies, m."""
        return min(map(abs, self.radii), default=self.radius)

    @property
    def curvature_radius(self) -> float | None:
        """Geometric mean of both radii of relative curvature, m; None without curvatures."""
        return self.radius

    def load_at(self, radius: np.ndarray) -> np.ndarray | None:
        """Load, N, at which a round contact has this radius, m; None for other shapes."""
        return self.load * (radius / self.contact_radius) ** 3

    @property
    def indentation(self) -> float:
        """Indentation d = a^2/R, m (Hertz)."""
        return self.contact_radius**2 / self.radius

    @property
    def largest_pressure(self) -> float:
        """Largest pressure p0 = 3 F / (2 pi a^2), Pa (Hertz)."""
        return 1.5 * self.load / (math.pi * self.contact_radius**2)

    @property
    def u_lim(self) -> float:
        """Displacement at which the whole contact slides, mu d E*/G*, m (see below Eq 2)."""
        return self.mu * self.indentation * self.E_star / self.G_star

    @property
    def mismatch(self) -> float:
        """Dundurs' constant beta, dimensionless; 0 for equal bodies.

        With p = (1 - 2 nu)/G and q = (1 - nu)/G of each body, it is (p1 - p2) / (2 (q1 + q2)).  It
        is a measure of the tangential displacement caused by pressure.
        """
        first, second = ((1.0 - 2.0 * body.poisson) / body.shear_modulus for body in self.bodies)
        both = sum((1.0 - body.poisson) / body.shear_modulus for body in self.bodies)
        return 0.5 * (first - second) / both
