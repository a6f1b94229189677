"""Axisymmetric indenters, whose contact is a full circle that grows with the load.

By the method of dimensionality reduction, an indenter with the profile f(r) is equivalent to a
plane profile.  The plane profile is D(c) = c Integral_0^c f'(r) / sqrt(c^2 - r^2) dr.  At the
indentation depth D(c), the contact radius is c.  Let h = D / D(1).  If the friction bound is
written as a superposition of flat punches, the results are

    G* = 1 / (2 Integral_0^1 x h'(x) dx)
    bound(r, c) = (G*/pi) Integral_r^c h'(x) / sqrt(x^2 - r^2) dx
    load(r, c) = 2 G* Integral_r^c h'(x) sqrt(x^2 - r^2) dx,

where load(r, c) is the load outside the radius r.  The substitution x = r cosh(eta) makes these
integrals smooth.

Power is an indenter with the profile f(r) ~ r^n.  The indenter is a cone for n = 1 and a sphere for
n = 2.  Indenters with larger n have a flatter end.  Punch is a flat punch with a rounded edge: f(r)
is 0 within the flat end, and a parabola outside.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from microslip.scene.pressure import RoundPressure
from microslip.theory.hertz import unit_rule

_NODES = 128
"""Number of nodes of a Gauss rule."""
SMALLEST_RADIUS = 1e-7
"""Smallest ratio of radius to contact radius.  Smaller ratios are replaced by this value, because
the friction bound of some indenters is infinite at the centre."""
SMALLEST_CONTACT = 1e-100
"""Smallest contact radius. This limit keeps divisions by the contact radius finite."""
_GRID = np.linspace(0.0, 1.0, 257)
_CORRECTIONS = 6
"""Number of Newton steps. The initial guess comes from a table."""
_HALVINGS = 100
"""Number of bisections. This number is enough for full precision."""
_STEP = 3e-4
"""Step of the differences, divided by the distance from the flat end.  For r^n with n up to 20, the
relative error is below 1e-10."""
_REFINEMENTS = 3
"""Number of grids in the search for the largest friction bound.  Each grid is 128 times finer than
the previous one."""


@dataclass(frozen=True)
class Indenter(RoundPressure):
    """Base class of axisymmetric indenters.

    A subclass defines `depth(c)`, which returns the indentation depth for the contact radius c.  At
    the contact radius 1, the depth is 1.  A subclass can also define `slope` and `radius` by
    formulas. The numerical methods of this class are slower.

    Attributes
    ----------
    flat : float
        Radius of the flat end, divided by the contact radius; 0 if the indenter has no flat end.
    """

    flat = 0.0
    needs = ("depth",)

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Compute the derivative of `depth` by differences of fourth order.  The derivative is 0
        for c below the radius of the flat end."""
        c = np.maximum(c, self.flat + SMALLEST_CONTACT)
        step = _STEP * np.maximum(c - self.flat, SMALLEST_CONTACT)
        near, far = (self.depth(c + k * step) - self.depth(c - k * step) for k in (1.0, 2.0))
        return (8.0 * near - far) / (12.0 * step)

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Compute the contact radius at a depth by bisection. This function is the inverse of
        `depth`."""
        depth = np.asarray(depth, float)
        low, high = np.full(depth.shape, self.flat), np.ones(depth.shape)
        while np.any(self.depth(high) < depth):
            high = 2.0 * high
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            below = self.depth(middle) < depth
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return np.where(depth > 0.0, high, 0.0)[()]

    def _pairs(self) -> Iterator[tuple[str, Any, Any, float]]:
        ends = np.linspace(self.flat, 1.0, 9)
        c, step = _above(self.flat, ends[:, None])
        yield "slope and depth", np.sum(step * self.slope(c), axis=-1), self.depth(ends), 0.005
        yield from super()._pairs()

    @cached_property
    def G_star(self) -> float:
        x, step = _above(self.flat, 1.0)
        return 0.5 / float(np.sum(step * x * self.slope(x)))

    def _rule(
        self, r: np.ndarray | float, c: np.ndarray | float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return a quadrature rule for integrals from r to c.

        The four arrays are the nodes x, the weights, the radii r, and the roots sqrt(x^2 - r^2).
        The weights are dx / sqrt(x^2 - r^2).  An additional last axis runs over the nodes.
        """
        radii, contact = np.broadcast_arrays(np.asarray(r, float), np.asarray(c, float))
        contact = np.maximum(contact, SMALLEST_CONTACT)[..., None]
        radii = np.clip(radii[..., None], SMALLEST_RADIUS * contact, contact)
        first = np.arccosh(np.maximum(np.minimum(self.flat, contact) / radii, 1.0))
        length = np.arccosh(np.maximum(contact / radii, 1.0)) - first
        # nodes are clustered at both limits: the slope starts like a square root at the edge of a
        # flat end, and is concentrated near the contact edge if the indenter is nearly flat
        nodes, weights = unit_rule(_NODES)
        eta = first + length * np.sin(0.5 * np.pi * nodes) ** 2
        step = length * 0.5 * np.pi * np.sin(np.pi * nodes) * weights
        return radii * np.cosh(eta), step, radii, radii * np.sinh(eta)

    def bound(self, r: np.ndarray, c: float = 1.0) -> np.ndarray:
        """Return the friction bound at the radius r in a contact of radius c."""
        x, weight, _, _ = self._rule(r, c)
        bound = self.G_star / np.pi * np.sum(weight * self.slope(x), axis=-1)
        return np.where(np.asarray(r, float) >= c, 0.0, bound)[()]

    def load(self, r: np.ndarray | float, c: np.ndarray | float = 1.0) -> np.ndarray:
        """Return the load within the radius r in a contact of radius c."""
        return (self._outside(0.0, c) - self._outside(r, c))[()]

    def _outside(self, r: np.ndarray | float, c: np.ndarray | float) -> np.ndarray:
        x, weight, _, root = self._rule(r, c)
        return 2.0 * self.G_star * np.sum(weight * root**2 * self.slope(x), axis=-1)

    def _moment_outside(self, r: np.ndarray | float) -> np.ndarray:
        x, weight, r, root = self._rule(r, 1.0)
        lever = x**2 * np.arccos(np.minimum(r / x, 1.0)) + r * root
        return self.G_star * np.sum(weight * root * lever * self.slope(x), axis=-1)

    def loading(self, displacement: np.ndarray) -> np.ndarray:
        """Return the tangential force after a displacement u from rest.

        Let P(d) be the load at the indentation depth d.  Then the force is 1 - P(1 - u) (Ciavarella
        1998, Jaeger 1998).
        """
        depth = np.maximum(1.0 - np.asarray(displacement, float), 0.0)
        c = self.radius(depth)
        return 1.0 - np.where(depth > 0.0, self.load(c, c), 0.0)

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Return the indentation depth at which the load is `share` times the mean load.

        The initial guess from a table is improved by Newton's method.
        """
        share = np.asarray(share, float)
        largest = 1.0
        while self.load(largest, largest) < share.max(initial=0.0):
            largest = 2.0 * largest
        grid = self.flat + (largest - self.flat) * _GRID**2
        k = np.clip(np.searchsorted(self.load(grid, grid), share), 1, len(grid) - 1)
        low, high = grid[k - 1], grid[k]
        c = 0.5 * (low + high)
        for _ in range(_CORRECTIONS):  # d load / d depth = 2 G* c
            rise = 2.0 * self.G_star * c * self.slope(c)
            c = np.clip(c - (self.load(c, c) - share) / np.maximum(rise, 1e-300), low, high)
        return np.where(share > 0.0, self.depth(c), 0.0)[()]

    @cached_property
    def largest(self) -> float:
        """Largest friction bound, determined on grids that are refined around the maximum."""
        low, high = 0.0, 1.0
        for _ in range(_REFINEMENTS):
            r = np.linspace(low, high, len(_GRID))
            values = self.bound(r)
            best = int(values.argmax())
            low, high = r[max(best - 1, 0)], r[min(best + 1, len(r) - 1)]
        return float(values[best])

    @cached_property
    def torque(self) -> float:
        return float(self._moment_outside(0.0))

    def ring_loads(self, psi: np.ndarray) -> np.ndarray:
        return -np.diff(self._outside(np.sin(psi), 1.0))

    def ring_moments(self, psi: np.ndarray) -> np.ndarray:
        return -np.diff(self._moment_outside(np.sin(psi)))


@dataclass(frozen=True)
class Power(Indenter):
    """The pressure of an indenter with the profile r^exponent.

    Parameters
    ----------
    exponent : float
        Exponent of the profile, from 1 to 100.

    Raises
    ------
    InputError
        If the exponent is outside its range.
    """

    exponent: float = 2.0

    ranges = {"exponent": (1.0, 100.0)}

    @property
    def summary(self) -> str:
        return f"an indenter with the profile r^{self.exponent:g}"

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Return the indentation depth for the contact radius c."""
        return np.asarray(c, float) ** self.exponent

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Return the derivative of the depth with respect to the contact radius."""
        return self.exponent * c ** (self.exponent - 1.0)

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Return the contact radius at an indentation depth."""
        return np.maximum(depth, 0.0) ** (1.0 / self.exponent)

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Return the indentation depth at which the load is `share` times the mean load."""
        return np.maximum(share, 0.0) ** (self.exponent / (self.exponent + 1.0))

    @cached_property
    def largest(self) -> float:
        """Largest friction bound.

        For exponents n up to 2, the largest bound is the bound at the centre. This bound is (G*/pi)
        Integral_0^1 n x^(n - 2) dx = (n + 1) / (2 pi (n - 1)).
        """
        if self.exponent > 2.0:
            return super().largest
        over = 2.0 * np.pi * (self.exponent - 1.0)
        return (self.exponent + 1.0) / over if over > 0.0 else np.inf


@dataclass(frozen=True)
class Punch(Indenter):
    """The pressure of a flat punch with a rounded edge.

    The radius of the flat end is `flat` times the contact radius.  The equivalent plane profile is
    D(c) ~ c (sqrt(c^2 - b^2) - b arccos(b/c)) for c above the radius b of the flat end (Ciavarella
    1999).

    Parameters
    ----------
    flat : float
        Radius of the flat end divided by the contact radius, from 0 to 0.99.

    Raises
    ------
    InputError
        If the radius is outside its range.
    """

    flat: float = 0.8

    ranges = {"flat": (0.0, 0.99, "a share of the contact radius")}

    @property
    def summary(self) -> str:
        return f"a punch with a rounded edge, flat up to {self.flat:g} of its contact radius"

    def _profile(self, c: np.ndarray | float) -> np.ndarray:
        r = np.maximum(np.asarray(c, float), self.flat)
        return r * (_root(r, self.flat) - self.flat * _angle(r, self.flat))

    @cached_property
    def _scale(self) -> float:
        return 1.0 / float(self._profile(1.0))

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Return the indentation depth for the contact radius c."""
        return self._scale * self._profile(c)

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Return the derivative of the depth with respect to the contact radius."""
        c = np.maximum(c, self.flat)
        return self._scale * (2.0 * _root(c, self.flat) - self.flat * _angle(c, self.flat))


def _above(flat: float, end: np.ndarray | float) -> tuple[np.ndarray, np.ndarray]:
    """Return the nodes and the weights of a quadrature rule for integrals of the slope from the
    radius of the flat end to the radius `end`."""
    nodes, weights = unit_rule(_NODES)
    # x = flat + (end - flat) s^2 removes the square root of the slope at the edge of a flat end
    return flat + (end - flat) * nodes**2, (end - flat) * 2.0 * nodes * weights


def _root(c: np.ndarray, flat: float) -> np.ndarray:
    return np.sqrt((c - flat) * (c + flat))


def _angle(c: np.ndarray, flat: float) -> np.ndarray:
    return np.arccos(np.minimum(flat / np.maximum(c, 1e-300), 1.0))
