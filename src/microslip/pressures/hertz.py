"""Hertz pressure on a circle: a sphere on a flat, which is the contact of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from microslip.pressures.ellipse import hertz_loads
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz


@dataclass(frozen=True)
class Hertz(Pressure):
    """The pressure of a sphere on a flat."""

    summary = "a sphere on a flat"
    hertzian = True
    G_star = hertz.G_STAR
    torque = hertz.TORQUE_FULL_SLIP
    largest = 1.5 / np.pi

    def cell_loads(self, cells: int) -> np.ndarray:
        """Compute the load on each square, (cells, cells)."""
        return hertz_loads(cells)

    def ring_means(self, psi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean friction bound and lever arm of the rings with the edges r = sin(psi)."""
        radii = np.sin(psi)
        # the first moment of the bound is the integral of sin^2 cos^2 over each ring
        moment = np.diff(psi / 8 - np.sin(4 * psi) / 32)
        load = -np.diff(np.cos(psi) ** 3) / 3
        return hertz.ring_bounds(np.minimum(radii, 1.0)), moment / load

    def bound(self, r: np.ndarray | float, c: float = 1.0) -> np.ndarray:
        """Friction bound at the radius r of a contact of radius c."""
        return 1.5 / np.pi * np.sqrt(np.maximum((c - r) * (c + r), 0.0))

    def depth(self, c: np.ndarray) -> np.ndarray:
        """Indentation depth for the contact radius c."""
        return c * c

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Contact radius at a depth."""
        return np.sqrt(np.maximum(depth, 0.0))

    def of_load(self, share: np.ndarray) -> np.ndarray:
        """Depth at which the load is `share` times the mean load."""
        return np.cbrt(share) ** 2

    def load(self, r: np.ndarray | float, c: np.ndarray | float = 1.0) -> np.ndarray:
        """Load within the radius r of a contact of radius c."""
        return c**3 - np.maximum((c - r) * (c + r), 0.0) ** 1.5

    def loading(self, displacement: np.ndarray | float) -> np.ndarray | float:
        """Tangential force after a displacement from rest (Mindlin)."""
        return hertz.mindlin_force(displacement)


HERTZ = Hertz()
