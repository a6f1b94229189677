"""Hertz pressure on an ellipse, a circle and a ring.

The circle is the contact of a sphere with a flat, as in the paper.  Examples of the ring are the
contacts of a torus and of the rim of a cup.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partialmethod

import numpy as np
import scipy

from microslip.foundation.errors import InputError
from microslip.scene.grid import of_corner_loads
from microslip.scene.pressure import Pressure, RoundPressure
from microslip.theory import hertz

SMALLEST_RATIO = 0.05
"""Smallest ratio of the semi-axes."""


def hertz_loads(cells: int) -> np.ndarray:
    """Compute the load of Hertz pressure on each cell of the rectangle around the ellipse.

    The result is an array of shape (cells, cells). The loads do not depend on the ratio of the
    semi-axes.
    """
    edges = np.arange(cells + 1) * 2.0 / cells - 1.0
    x, y = edges[:, None], edges[None, :]
    # load on the rectangle between the centre and (x, y), odd in both coordinates; like the
    # pressure, the root is zero outside the disc
    root = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    load = x * y * root - np.arctan2(x * y, root)
    load = load + 0.5 * x * (3.0 - x * x) * np.arctan2(y, root)
    load = load + 0.5 * y * (3.0 - y * y) * np.arctan2(x, root)
    return of_corner_loads(load / (2.0 * np.pi))


@dataclass(frozen=True)
class Ellipse(Pressure):
    """The pressure of an elliptic Hertz contact with the semi-axes a and `ratio` * a.

    The length u_lim is the displacement at the centre under full slip.  Hence G* = 3 K / (2 pi),
    where K is the complete elliptic integral of the first kind at the eccentricity of the ellipse.
    For a circle, G* is 3/4.

    Parameters
    ----------
    ratio : float
        Ratio of the semi-axes, from 0.05 to 1.
    across : int
        0 if the long axis points forward, 1 if it is lateral.

    Raises
    ------
    InputError
        If the ratio is outside its range, or if `across` is neither 0 nor 1.
    """

    ratio: float = 0.5
    across: int = 0

    hertzian = True
    cell_loads = staticmethod(hertz_loads)
    loading = staticmethod(hertz.mindlin_force)  # the same as for a sphere
    ranges = {"ratio": (SMALLEST_RATIO, 1.0)}

    def __post_init__(self) -> None:
        super().__post_init__()
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

        The mean is 3 pi/16 on the unit circle.  If one axis of this circle is scaled by the ratio,
        the circle becomes the ellipse.  The scaling multiplies distances along a ray at the angle t
        by hypot(cos t, ratio sin t).
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


@dataclass(frozen=True)
class Hertz(Pressure):
    """The pressure of a sphere on a flat."""

    summary = "a sphere on a flat"
    hertzian = True
    cell_loads = staticmethod(hertz_loads)
    loading = staticmethod(hertz.mindlin_force)
    G_star = hertz.G_STAR
    torque = hertz.TORQUE_FULL_SLIP
    largest = 1.5 / np.pi

    def ring_means(self, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """For each ring between neighbouring edges r = sin(psi), compute the mean friction bound
        and the lever arm."""
        radii = np.sin(psi)
        # the first moment of the bound is the integral of sin^2 cos^2 over each ring
        moment = np.diff(psi / 8 - np.sin(4 * psi) / 32)
        load = -np.diff(np.cos(psi) ** 3) / 3
        return hertz.ring_bounds(np.minimum(radii, 1.0)), moment / load

    def bound(self, r: np.ndarray | float, c: float = 1.0) -> np.ndarray:
        """Return the friction bound at the radius r in a contact of radius c."""
        return 1.5 / np.pi * np.sqrt(np.maximum((c - r) * (c + r), 0.0))

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Return the indentation depth for the contact radius c."""
        return c * c

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Return the contact radius at an indentation depth."""
        return np.sqrt(np.maximum(depth, 0.0))

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Return the indentation depth at which the load is `share` times the mean load."""
        return np.cbrt(share) ** 2

    def load(self, r: np.ndarray | float, c: np.ndarray | float = 1.0) -> np.ndarray:
        """Return the load within the radius r in a contact of radius c."""
        return c**3 - np.maximum((c - r) * (c + r), 0.0) ** 1.5


HERTZ = Hertz()


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Ring(RoundPressure):
    """A pressure proportional to sqrt((r - b)(1 - r)) on the ring between the radii b and 1, where
    b is `inner`.

    The pressure is the Hertz pressure of a line contact that is bent into a circle.  For a slender
    torus, this pressure is an approximation. For a wide ring, this pressure is an assumption.

    Parameters
    ----------
    inner : float
        Radius of the hole divided by the outer radius, from 0.05 to 0.95.

    Raises
    ------
    InputError
        If the radius of the hole is outside its range.
    """

    inner: float = 0.5

    ranges = {"inner": (0.05, 0.95, "a share of the outer radius")}

    @property
    def summary(self) -> str:
        return f"a ring-shaped contact with a hole of {self.inner:g} of its radius"

    @property
    def area(self) -> float:
        return np.pi * (1.0 - self.inner**2)

    @property
    def _half(self) -> float:
        return 0.5 * (1.0 - self.inner)

    @property
    def _middle(self) -> float:
        return 0.5 * (1.0 + self.inner)

    @property
    def _top(self) -> float:
        """Factor by which the square root in the pressure is multiplied.  With this factor, the
        load is 1.

        Let r = middle - half cos t.  Then the factor equals 1 / Integral sqrt((r - b)(1 - r)) 2 pi
        r dr.
        """
        return 1.0 / (np.pi**2 * self._half**2 * self._middle)

    def bound(self, r: np.ndarray) -> np.ndarray:
        """Return the friction bound at a radius."""
        r = np.asarray(r, float)
        return self._top * np.sqrt(np.maximum((r - self.inner) * (1.0 - r), 0.0))[()]

    def _ring_integrals(self, psi: np.ndarray, power: int) -> np.ndarray:
        """For each ring between neighbouring radii r = sin(psi), integrate (friction bound) * 2 pi
        r^power over r."""
        at = np.arccos(np.clip((self._middle - np.sin(psi)) / self._half, -1.0, 1.0))
        turn = at[:-1, None] + np.diff(at)[:, None] * 0.5 * (_NODES + 1.0)
        r = self._middle - self._half * np.cos(turn)
        values = self._top * self._half**2 * np.sin(turn) ** 2 * 2.0 * np.pi * r**power
        return 0.5 * np.diff(at) * (values @ _WEIGHTS)

    ring_loads = partialmethod(_ring_integrals, power=1)
    ring_moments = partialmethod(_ring_integrals, power=2)

    @property
    def torque(self) -> float:
        whole = np.linspace(np.arcsin(self.inner), np.pi / 2, 65)
        return float(self.ring_moments(whole).sum())

    @property
    def largest(self) -> float:
        return self._top * self._half

    @cached_property
    def G_star(self) -> float:
        """G* in working units. This value equals the largest displacement in a contact with G* = 1
        under full slip.

        Let m be 1 - ((r - s)/(r + s))^2.  A unit traction on a narrow ring of radius s causes a
        displacement at the radius r.  Per unit width of the ring, this displacement is 4 s/(r + s)
        K(m)/pi.
        """
        # imported here, because loading takes a third of a second
        from scipy.integrate import quad
        from scipy.optimize import minimize_scalar

        inner, top = self.inner, self._top

        def displacement(r: float) -> float:
            def of_circle(s: float) -> float:
                apart = max(((r - s) / (r + s)) ** 2, 1e-300)
                kernel = 4.0 / np.pi * s / (r + s) * scipy.special.ellipkm1(apart)
                return kernel * top * np.sqrt(max((s - inner) * (1.0 - s), 0.0))

            settings = {"epsabs": 0.0, "epsrel": 1e-10, "limit": 200}
            return quad(of_circle, inner, 1.0, points=[r], **settings)[0]

        options = {"xatol": 1e-7}
        best = minimize_scalar(lambda r: -displacement(r), bounds=(inner, 1.0), options=options)
        return float(-best.fun)
