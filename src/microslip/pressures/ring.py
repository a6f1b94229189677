"""A ring-shaped contact, for example of a torus or of a cup's rim."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from microslip.foundation import spec
from microslip.pressures.pressure import RoundPressure

LIMITS = (0.05, 0.95)
"""Range of the radius of the hole, divided by the outer radius."""
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


@dataclass(frozen=True)
class Ring(RoundPressure):
    """A pressure proportional to sqrt((r - b)(1 - r)) on the ring from r = b = `inner` to r = 1.

    This is the Hertz pressure of a line contact that is bent into a circle.  It is close to the
    pressure of a slender torus; for a wide ring, it is an assumption.

    Parameters
    ----------
    inner : float
        Radius of the hole divided by the outer radius, 0.05 to 0.95.

    Raises
    ------
    InputError
        If the radius is outside its range.
    """

    inner: float = 0.5

    def __post_init__(self) -> None:
        super().__post_init__()
        kind = "a share of the outer radius"
        spec.refuse_outside(self.name, "pressure", "inner", self.inner, LIMITS, kind=kind)

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
        """Factor of the root, chosen such that the load is 1: 1 / Integral sqrt((r - b)(1 - r)) 2
        pi r dr, with r = middle - half cos t."""
        return 1.0 / (np.pi**2 * self._half**2 * self._middle)

    def bound(self, r: np.ndarray) -> np.ndarray:
        """Friction bound at a radius."""
        r = np.asarray(r, float)
        return self._top * np.sqrt(np.maximum((r - self.inner) * (1.0 - r), 0.0))[()]

    def _ring_integrals(self, psi: np.ndarray, power: int) -> np.ndarray:
        """Integrals of the bound times 2 pi r^power between the radii sin(psi)."""
        at = np.arccos(np.clip((self._middle - np.sin(psi)) / self._half, -1.0, 1.0))
        turn = at[:-1, None] + np.diff(at)[:, None] * 0.5 * (_NODES + 1.0)
        r = self._middle - self._half * np.cos(turn)
        values = self._top * self._half**2 * np.sin(turn) ** 2 * 2.0 * np.pi * r**power
        return 0.5 * np.diff(at) * (values @ _WEIGHTS)

    def ring_loads(self, psi: np.ndarray) -> np.ndarray:
        return self._ring_integrals(psi, 1)

    def ring_moments(self, psi: np.ndarray) -> np.ndarray:
        return self._ring_integrals(psi, 2)

    @property
    def torque(self) -> float:
        whole = np.linspace(np.arcsin(self.inner), np.pi / 2, 65)
        return float(self.ring_moments(whole).sum())

    @property
    def largest(self) -> float:
        return self._top * self._half

    @cached_property
    def G_star(self) -> float:
        """G* in working units.  It equals the largest displacement under full slip for G* = 1.

        Under a unit traction on a narrow ring of radius s, the displacement at the radius r is 4
        s/(r + s) K(m)/pi per unit of the ring's width.  Here 1 - m = ((r - s)/(r + s))^2.
        """
        # imported here, because they take a third of a second to load
        from scipy.integrate import quad
        from scipy.optimize import minimize_scalar

        inner, top = self.inner, self._top

        def displacement(r: float) -> float:
            def of_circle(s: float) -> float:
                apart = max(((r - s) / (r + s)) ** 2, 1e-300)
                kernel = 4.0 / np.pi * s / (r + s) * scipy.special.ellipkm1(apart)
                return kernel * top * np.sqrt(max((s - inner) * (1.0 - s), 0.0))

            parts = (inner, r), (r, 1.0)
            settings = {"epsabs": 0.0, "epsrel": 1e-10, "limit": 200}
            return sum(quad(of_circle, *part, **settings)[0] for part in parts)

        best = minimize_scalar(
            lambda r: -displacement(r),
            bounds=(inner, 1.0),
            method="bounded",
            options={"xatol": 1e-7},
        )
        return float(-best.fun)
