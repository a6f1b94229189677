"""Axisymmetric indenters: profiles whose contact is a full circle that grows with the load.

By the method of dimensionality reduction, an indenter with the profile f(r) is equivalent to the
plane profile D(c) = c Integral_0^c f'(r) / sqrt(c^2 - r^2) dr.  At the indentation depth D(c), the
contact radius is c.  With h = D / D(1), and the friction bound written as a superposition of flat
punches,

    G* = 1 / (2 Integral_0^1 x h'(x) dx)
    bound(r, c) = (G*/pi) Integral_r^c h'(x) / sqrt(x^2 - r^2) dx
    load beyond r = 2 G* Integral_r^c h'(x) sqrt(x^2 - r^2) dx.

The substitution x = r cosh(eta) makes these integrals smooth.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from microslip.pressures.pressure import RoundPressure

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
SMALLEST_RADIUS = 1e-7
"""Smallest radius divided by the contact radius.  Smaller radii are replaced by this value, because
the friction bound of some indenters is infinite at the centre."""
SMALLEST_CONTACT = 1e-100
"""Smallest contact radius, which keeps divisions by the contact radius finite."""
_GRID = np.linspace(0.0, 1.0, 257)
_CORRECTIONS = 6
"""Number of Newton steps after the initial guess from a table."""
_REFINEMENTS = 3
"""Number of grids in the search for the largest bound.  Each grid is 128 times finer than the
previous one."""


@dataclass(frozen=True)
class Indenter(RoundPressure):
    """Base class of axisymmetric indenters.  A subclass defines `depth`, `slope` and `radius`.

    Attributes
    ----------
    flat : float
        Radius of a flat end, divided by the contact radius.
    """

    flat = 0.0

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Indentation depth for the contact radius c; depth(1) = 1."""
        raise NotImplementedError

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Derivative of `depth`; 0 for c below the radius of a flat end."""
        raise NotImplementedError

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Inverse of `depth`."""
        raise NotImplementedError

    @cached_property
    def G_star(self) -> float:
        # x = flat + (1 - flat) s^2 removes the square root of the slope at the edge of a flat end
        x = self.flat + (1.0 - self.flat) * _NODES**2
        step = (1.0 - self.flat) * 2.0 * _NODES * _WEIGHTS
        return 0.5 / float(np.sum(step * x * self.slope(x)))

    def _rule(
        self, r: np.ndarray | float, c: np.ndarray | float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Quadrature from r to c on a new last axis: nodes x, weights dx / sqrt(x^2 - r^2), radii
        r, and roots sqrt(x^2 - r^2)."""
        radii, contact = np.broadcast_arrays(np.asarray(r, float), np.asarray(c, float))
        contact = np.maximum(contact, SMALLEST_CONTACT)[..., None]
        radii = np.clip(radii[..., None], SMALLEST_RADIUS * contact, contact)
        first = np.arccosh(np.maximum(np.minimum(self.flat, contact) / radii, 1.0))
        length = np.arccosh(np.maximum(contact / radii, 1.0)) - first
        # nodes are clustered at both ends: the slope starts like a square root at a flat end, and
        # rises only near the edge if the indenter is nearly flat
        eta = first + length * np.sin(0.5 * np.pi * _NODES) ** 2
        step = length * 0.5 * np.pi * np.sin(np.pi * _NODES) * _WEIGHTS
        return radii * np.cosh(eta), step, radii, radii * np.sinh(eta)

    def bound(self, r: np.ndarray, c: float = 1.0) -> np.ndarray:
        """Friction bound at the radius r of a contact of radius c."""
        x, weight, _, _ = self._rule(r, c)
        bound = self.G_star / np.pi * np.sum(weight * self.slope(x), axis=-1)
        return np.where(np.asarray(r, float) >= c, 0.0, bound)[()]

    def load(self, r: np.ndarray | float, c: np.ndarray | float = 1.0) -> np.ndarray:
        """Load within the radius r of a contact of radius c."""
        return (self._outside(0.0, c) - self._outside(r, c))[()]

    def _outside(self, r: np.ndarray | float, c: np.ndarray | float) -> np.ndarray:
        x, weight, _, root = self._rule(r, c)
        return 2.0 * self.G_star * np.sum(weight * root**2 * self.slope(x), axis=-1)

    def _moment_outside(self, r: np.ndarray | float) -> np.ndarray:
        x, weight, r, root = self._rule(r, 1.0)
        lever = x**2 * np.arccos(np.minimum(r / x, 1.0)) + r * root
        return self.G_star * np.sum(weight * root * lever * self.slope(x), axis=-1)

    def loading(self, displacement: np.ndarray) -> np.ndarray:
        """Tangential force after a displacement u from rest: 1 minus the load of the contact at the
        depth 1 - u (Ciavarella 1998, Jaeger 1998)."""
        depth = np.maximum(1.0 - np.asarray(displacement, float), 0.0)
        c = self.radius(depth)
        return 1.0 - np.where(depth > 0.0, self.load(c, c), 0.0)

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Depth at which the load is `share` times the mean load, from a table and Newton's
        method."""
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
        """Largest friction bound, found on grids that are refined around the largest value."""
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
