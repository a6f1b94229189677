"""A flat punch with a rounded edge: f(r) = 0 within the flat end, and a parabola outside."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from microslip.foundation import spec
from microslip.pressures.axisymmetric_indenter import Indenter

LARGEST_FLAT = 0.99
"""Largest radius of the flat end, divided by the contact radius."""
_HALVINGS = 100
"""Number of bisections, enough for full precision."""


@dataclass(frozen=True)
class Punch(Indenter):
    """The pressure of a punch with a flat end. The radius of the flat end is `flat` times the
    contact radius.

    Its equivalent plane profile is D(c) ~ c (sqrt(c^2 - b^2) - b arccos(b/c)) for c above the
    radius b of the flat end (Ciavarella 1999).

    Parameters
    ----------
    flat : float
        Radius of the flat end divided by the contact radius, 0 to 0.99.

    Raises
    ------
    InputError
        If the radius is outside its range.
    """

    flat: float = 0.8

    def __post_init__(self) -> None:
        super().__post_init__()
        kind, limits = "a share of the contact radius", (0.0, LARGEST_FLAT)
        spec.refuse_outside(self.name, "pressure", "flat", self.flat, limits, kind=kind)

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
        """Indentation depth for the contact radius c."""
        return self._scale * self._profile(c)

    def slope(self, c: np.ndarray) -> np.ndarray:
        """Derivative of the depth with respect to the contact radius."""
        c = np.maximum(c, self.flat)
        return self._scale * (2.0 * _root(c, self.flat) - self.flat * _angle(c, self.flat))

    def radius(self, depth: np.ndarray) -> np.ndarray:
        """Contact radius at a depth, by bisection."""
        depth = np.asarray(depth, float)
        low, high = np.full(depth.shape, self.flat), np.ones(depth.shape)
        while np.any(self.depth(high) < depth):
            high = 2.0 * high
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            below = self.depth(middle) < depth
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return np.where(depth > 0.0, high, 0.0)[()]


def _root(c: np.ndarray, flat: float) -> np.ndarray:
    return np.sqrt((c - flat) * (c + flat))


def _angle(c: np.ndarray, flat: float) -> np.ndarray:
    return np.arccos(np.minimum(flat / np.maximum(c, 1e-300), 1.0))
