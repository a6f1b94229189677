"""Hertz's pressure over an ellipse."""

from __future__ import annotations

import numpy as np
import scipy

from microslip.foundation import spec
from microslip.foundation.errors import InputError
from microslip.pressures.cell_loads import of_corner_loads
from microslip.pressures.pressure import Pressure
from microslip.theory import hertz

DEFAULTS = {"ratio": 0.5, "across": 0.0}
SMALLEST_RATIO = 0.05


def pressure(name: str, ratio: float, across: float) -> Pressure:
    """The Pressure of an elliptic Hertz contact of semi-axes a and ratio a.

    across: 0 if the long axis is the forward one, 1 if it is the lateral one.  u_lim is the
    displacement under full slip at the centre, so that G* = 3 K / (2 pi), K the complete elliptic
    integral of the eccentricity: 3/4 for a circle.  Raises InputError for a ratio outside 0.05..1
    and another `across`.
    """
    spec.refuse_outside(name, "pressure", "ratio", ratio, (SMALLEST_RATIO, 1.0))
    if across not in (0.0, 1.0):
        raise InputError("pressure", name, f"across = {across:g}: allowed is 0 or 1")
    axes = (ratio, 1.0) if across else (1.0, ratio)
    return Pressure(
        name=name,
        summary=f"a Hertz contact on an ellipse of ratio {ratio:g}",
        G_star=1.5 / np.pi * float(scipy.special.ellipk(1.0 - ratio**2)),
        torque=_torque(ratio),
        largest=1.5 / (np.pi * ratio),
        cell_loads=lambda cells: ellipse_loads(cells, axes),
        loading=hertz.mindlin_force,
        hertzian=True,
    )


def _torque(ratio):
    """Mean distance from the centre under Hertz's pressure: on the unit circle it is 3 pi/16, and
    along the ray at an angle t of the squeezed circle it is stretched by hypot(cos t, ratio sin t).
    """
    angle = (np.arange(512) + 0.5) * (np.pi / 1024)
    return hertz.TORQUE_FULL_SLIP * float(np.hypot(np.cos(angle), ratio * np.sin(angle)).mean())


def ellipse_loads(cells: int, axes: tuple[float, float] = (1.0, 1.0)) -> np.ndarray:
    """Hertz's pressure integrated over each square, (cells, cells); axes: semi-axes, the forward
    one first."""
    edges = np.arange(cells + 1) * 2.0 / cells - 1.0
    x, y = (np.clip(edges / axis, -1.0, 1.0) for axis in axes)
    x, y = x[:, None], y[None, :]
    # load of the rectangle from the centre to (x, y), odd in both; past the edge of the disc the
    # bound is zero, and so is the root
    root = np.sqrt(np.maximum(1.0 - x * x - y * y, 0.0))
    load = x * y * root - np.arctan2(x * y, root)
    load = load + 0.5 * x * (3.0 - x * x) * np.arctan2(y, root)
    load = load + 0.5 * y * (3.0 - y * y) * np.arctan2(x, root)
    return of_corner_loads(load / (2.0 * np.pi))
