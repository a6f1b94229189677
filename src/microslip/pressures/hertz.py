"""Hertz's pressure over a circle: a sphere on a flat, which the paper is about."""

from __future__ import annotations

import numpy as np

from microslip.pressures.ellipse import ellipse_loads
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz


def _hertz_means(psi):
    radii = np.sin(psi)
    # Integral of sin^2 cos^2 over each ring is the first moment of the bound
    moment = np.diff(psi / 8 - np.sin(4 * psi) / 32)
    load = -np.diff(np.cos(psi) ** 3) / 3
    return hertz.ring_bounds(np.minimum(radii, 1.0)), moment / load


def _hertz_bound(r, c=1.0):
    return 1.5 / np.pi * np.sqrt(np.maximum((c - r) * (c + r), 0.0))


def _hertz_load(r, c=1.0):
    return c**3 - np.maximum((c - r) * (c + r), 0.0) ** 1.5


PRESSURE = Pressure(
    name="hertz",
    summary="a sphere on a flat",
    G_star=hertz.G_STAR,
    torque=hertz.TORQUE_FULL_SLIP,
    largest=1.5 / np.pi,
    cell_loads=ellipse_loads,
    ring_means=_hertz_means,
    bound=_hertz_bound,
    depth=lambda c: c * c,
    radius=lambda depth: np.sqrt(np.maximum(depth, 0.0)),
    of_load=lambda share: np.cbrt(share) ** 2,
    load=_hertz_load,
    loading=hertz.mindlin_force,
    hertzian=True,
)
