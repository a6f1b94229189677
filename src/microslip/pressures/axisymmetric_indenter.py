"""Axisymmetric indenters: any profile whose contact is a full circle that grows with the load.

By the method of dimensionality reduction an indenter with the profile f(r) is equivalent to the
plane profile D(c) = c Integral_0^c f'(r) / sqrt(c^2 - r^2) dr: pressed to the depth D(c) it touches
up to the radius c.  With h = D / D(1), and the friction bound the sum of flat punches,

    G* = 1 / (2 Integral_0^1 x h'(x) dx)
    bound(r, c) = (G*/pi) Integral_r^c h'(x) / sqrt(x^2 - r^2) dx
    load beyond r = 2 G* Integral_r^c h'(x) sqrt(x^2 - r^2) dx.

With x = r cosh(eta) these integrals are smooth.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from microslip.pressures.cell_loads import round_loads
from microslip.pressures.pressure import Pressure, of_radii

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(128)
_NODES, _WEIGHTS = 0.5 * (_NODES + 1.0), 0.5 * _WEIGHTS
SMALLEST_RADIUS = 1e-7
"""Radii below this one, over the contact radius, are taken for it: some bounds have no finite value
at the centre."""
SMALLEST_CONTACT = 1e-100
_GRID = np.linspace(0.0, 1.0, 257)
_CORRECTIONS = 6
_REFINEMENTS = 3
"""Grids on which the largest bound is searched, each 128 times finer than the one before."""


def indenter(
    name: str,
    summary: str,
    depth: Callable,
    slope: Callable,
    radius: Callable,
    *,
    flat: float = 0.0,
    of_load: Callable | None = None,
    largest: float | None = None,
) -> Pressure:
    """The Pressure of an axisymmetric indenter; all functions are of arrays.

    Parameters
    ----------
    name, summary : str
        Of the pressure.
    depth : callable
        depth(c): indentation that makes the contact radius c, 1 at 1.
    slope : callable
        slope(c): its derivative, 0 below the radius of a flat end.
    radius : callable
        radius(depth): inverse of depth.
    flat : float
        Radius of a flat end, over the contact radius.
    of_load : callable or None
        of_load(share): depth of a share of the load; None: it is searched for.
    largest : float or None
        Largest friction bound, or infinity; None: it is searched for, and has to be finite.

    Returns
    -------
    pressure.Pressure
        In its own working units.
    """
    # x = flat + (1 - flat) s^2 takes the square root out of slopes that begin at a flat end
    x = flat + (1.0 - flat) * _NODES**2
    step = (1.0 - flat) * 2.0 * _NODES * _WEIGHTS
    G_star = 0.5 / float(np.sum(step * x * slope(x)))

    def rule(r, c):
        """Nodes x with weights dx / sqrt(x^2 - r^2) on a last axis, and that root."""
        r, c = np.broadcast_arrays(np.asarray(r, float), np.asarray(c, float))
        c = np.maximum(c, SMALLEST_CONTACT)
        r = np.clip(r, SMALLEST_RADIUS * c, c)[..., None]
        c = c[..., None]
        first = np.arccosh(np.maximum(np.minimum(flat, c) / r, 1.0))
        length = np.arccosh(np.maximum(c / r, 1.0)) - first
        # clustered at both ends: at a flat end the slope begins like a root, at the edge of a
        # contact that is nearly flat all of it rises
        eta = first + length * np.sin(0.5 * np.pi * _NODES) ** 2
        step = length * 0.5 * np.pi * np.sin(np.pi * _NODES) * _WEIGHTS
        return r * np.cosh(eta), step, r, r * np.sinh(eta)

    def bound(r, c=1.0):
        x, weight, _, _ = rule(r, c)
        beyond = np.asarray(r, float) >= c
        return np.where(beyond, 0.0, G_star / np.pi * np.sum(weight * slope(x), axis=-1))[()]

    def load(r, c=1.0):
        return (_outside(0.0, c) - _outside(r, c))[()]

    def _outside(r, c):
        x, weight, _, root = rule(r, c)
        return 2.0 * G_star * np.sum(weight * root**2 * slope(x), axis=-1)

    def moment_outside(r):
        x, weight, r, root = rule(r, 1.0)
        lever = x**2 * np.arccos(np.minimum(r / x, 1.0)) + r * root
        return G_star * np.sum(weight * root * lever * slope(x), axis=-1)

    def loading(displacement):
        """What slips at the depth 1 less what would still slip at the depth 1 - u: the load of a
        smaller contact is missing (Ciavarella 1998, Jaeger 1998)."""
        left = np.maximum(1.0 - np.asarray(displacement, float), 0.0)
        c = radius(left)
        return 1.0 - np.where(left > 0.0, load(c, c), 0.0)

    def searched(share):
        share = np.asarray(share, float)
        largest = 1.0
        while load(largest, largest) < share.max(initial=0.0):
            largest = 2.0 * largest
        grid = flat + (largest - flat) * _GRID**2
        k = np.clip(np.searchsorted(load(grid, grid), share), 1, len(grid) - 1)
        low, high = grid[k - 1], grid[k]
        c = 0.5 * (low + high)
        for _ in range(_CORRECTIONS):  # Newton's; the load grows by the stiffness 2 G* c
            rise = 2.0 * G_star * c * slope(c)
            c = np.clip(c - (load(c, c) - share) / np.maximum(rise, 1e-300), low, high)
        return np.where(share > 0.0, depth(c), 0.0)[()]

    def peak():
        """Largest bound: the best point of a grid, refined between its neighbours."""
        low, high = 0.0, 1.0
        for _ in range(_REFINEMENTS):
            r = np.linspace(low, high, len(_GRID))
            values = bound(r)
            best = int(values.argmax())
            low, high = r[max(best - 1, 0)], r[min(best + 1, len(r) - 1)]
        return float(values[best])

    def ring_loads(psi):
        return -np.diff(_outside(np.sin(psi), 1.0))

    def ring_moments(psi):
        return -np.diff(moment_outside(np.sin(psi)))

    return Pressure(
        name=name,
        summary=summary,
        G_star=G_star,
        torque=float(moment_outside(0.0)),
        largest=peak() if largest is None else largest,
        cell_loads=lambda cells: round_loads(cells, ring_loads),
        ring_means=lambda psi: of_radii(ring_loads, ring_moments, psi),
        bound=bound,
        depth=depth,
        radius=radius,
        of_load=of_load or searched,
        load=load,
        loading=loading,
    )
