"""A ring-shaped contact: what a torus, or the rim of a cup, touches."""

from __future__ import annotations

from functools import cache

import numpy as np
import scipy

from microslip.foundation import spec
from microslip.pressures.cell_loads import round_loads
from microslip.pressures.pressure import Pressure, of_radii

DEFAULTS = {"inner": 0.5}
LIMITS = (0.05, 0.95)
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)


def pressure(name: str, inner: float) -> Pressure:
    """The Pressure sqrt((r - b)(1 - r)) on the ring from b = `inner` to 1.

    That is Hertz's pressure of a line contact laid around a circle, which a slender torus comes
    close to; of a wide ring it is an assumption.  Raises InputError for b outside 0.05..0.95.
    """
    kind = "a share of the outer radius"
    spec.refuse_outside(name, "pressure", "inner", inner, LIMITS, kind=kind)
    half, middle = 0.5 * (1.0 - inner), 0.5 * (1.0 + inner)
    # Integral of sqrt((r - b)(1 - r)) 2 pi r dr, r = middle - half cos(t)
    top = 1.0 / (np.pi**2 * half**2 * middle)

    def bound(r):
        r = np.asarray(r, float)
        return top * np.sqrt(np.maximum((r - inner) * (1.0 - r), 0.0))[()]

    def ring_integrals(psi, power):
        """Integrals of the bound times 2 pi r^power between the radii sin(psi)."""
        at = np.arccos(np.clip((middle - np.sin(psi)) / half, -1.0, 1.0))
        turn = at[:-1, None] + np.diff(at)[:, None] * 0.5 * (_NODES + 1.0)
        r = middle - half * np.cos(turn)
        values = top * half**2 * np.sin(turn) ** 2 * 2.0 * np.pi * r**power
        return 0.5 * np.diff(at) * (values @ _WEIGHTS)

    def ring_loads(psi):
        return ring_integrals(psi, 1)

    def ring_moments(psi):
        return ring_integrals(psi, 2)

    whole = np.linspace(np.arcsin(inner), np.pi / 2, 65)
    return Pressure(
        name=name,
        summary=f"a ring-shaped contact with a hole of {inner:g} of its radius",
        G_star=_largest_displacement(inner, top),
        torque=float(ring_moments(whole).sum()),
        largest=top * half,
        cell_loads=lambda cells: round_loads(cells, ring_loads, inner),
        ring_means=lambda psi: of_radii(ring_loads, ring_moments, psi),
        bound=bound,
        inner=inner,
    )


@cache
def _largest_displacement(inner, top):
    """Largest displacement under full slip for G* = 1, and so the G* that makes it u_lim.

    A circle of radius s under unit load per area causes 4 s/(r + s) K(m)/pi at r, 1 - m the square
    of (r - s)/(r + s).
    """
    # These take a third of a second to load, and few ask for a ring.
    from scipy.integrate import quad
    from scipy.optimize import minimize_scalar

    def displacement(r):
        def of_circle(s):
            apart = max(((r - s) / (r + s)) ** 2, 1e-300)
            kernel = 4.0 / np.pi * s / (r + s) * scipy.special.ellipkm1(apart)
            return kernel * top * np.sqrt(max((s - inner) * (1.0 - s), 0.0))

        parts = (inner, r), (r, 1.0)
        return sum(quad(of_circle, *part, epsabs=0.0, epsrel=1e-10, limit=200)[0] for part in parts)

    found = minimize_scalar(
        lambda r: -displacement(r), bounds=(inner, 1.0), method="bounded", options={"xatol": 1e-7}
    )
    return float(-found.fun)
