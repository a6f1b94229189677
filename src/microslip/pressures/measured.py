"""A pressure given point by point: what a sensor measured, or another program computed."""

from __future__ import annotations

import numpy as np

from microslip.pressures.record import Pressure
from microslip.pressures.squares import of_loads

AXES = ("forward", "lateral")
FINE = 256
"""Squares along a side at which the largest displacement under full slip is found."""
REGULAR = 1e-3
"""Distances between neighbours may differ by this share."""


def of_grid(name, forward, lateral, values):
    """The Pressure of values on a regular grid; forward, lateral: increasing, (n,) and (m,), in one
    unit of length; values: (n, m), 0 outside the contact, in any unit.  Between the points the
    pressure is bilinear, and it ends one point beyond the last above 0.

    a is half the longer side of the rectangle that holds all pressure, and its centre is the one
    that rotations turn about.  Raises ValueError for a grid that is not regular, values below 0 or
    not finite, and a load that is 0.
    """
    widths = [_width(label, axis) for label, axis in zip(AXES, (forward, lateral), strict=True)]
    if not np.isfinite(values).all() or values.min() < 0.0:
        bad = values[~(np.isfinite(values) & (values >= 0.0))][0]
        raise ValueError(f"pressure {bad:g} is not allowed; allowed: finite numbers, 0 or above")
    loaded = values > 0.0
    if not loaded.any():
        raise ValueError("pressure is 0 everywhere; allowed: a load above 0")
    centres, halves = [], []
    for axis, width, other in ((forward, widths[0], 1), (lateral, widths[1], 0)):
        used = axis[loaded.any(axis=other)]
        centres.append(0.5 * (used[0] + used[-1]))
        halves.append(0.5 * (used[-1] - used[0]) + width)
    axes = [
        (axis - centre) / max(halves)
        for axis, centre in zip((forward, lateral), centres, strict=True)
    ]
    shares = values / values.sum()

    def cell_loads(cells):
        edges = np.arange(cells + 1) * 2.0 / cells - 1.0
        along, across = (_hat_integrals(axis, edges) for axis in axes)
        return of_loads(along @ shares @ across.T)

    return Pressure(
        name=name,
        summary="a pressure from a file",
        G_star=_largest_displacement(cell_loads(FINE)),
        torque=float(np.sum(shares * np.hypot(axes[0][:, None], axes[1][None, :]))),
        cell_loads=cell_loads,
        mirrored=False,  # what is measured never is
    )


def _hat_integrals(axis, edges):
    """Share of the hat function of each point of an axis that lies in each cell, (cells, n)."""
    t = np.clip((edges[:, None] - axis) / (axis[1] - axis[0]), -1.0, 1.0)
    return np.diff(0.5 + t - 0.5 * t * np.abs(t), axis=0)


def _width(label, axis):
    steps = np.diff(axis)
    if len(axis) < 2 or not np.isfinite(axis).all() or np.ptp(steps) > REGULAR * steps.mean():
        raise ValueError(
            f"{label}: not evenly spaced; allowed: two coordinates or more, at equal distances"
        )
    return float(steps.mean())


def _largest_displacement(loads):
    """Largest displacement under full slip for G* = 1, and so the G* that makes it u_lim.

    loads: on squares, (n, n), each spread evenly over its own; displacements at their centres.
    """
    n = len(loads)
    edges = (np.arange(1 - n, n + 1) - 0.5) * 2.0 / n
    u, v = edges[:, None], edges[None, :]
    # Integral of 1/distance over the rectangle from the centre to (u, v)
    to_corner = u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))
    kernel = np.diff(np.diff(to_corner, axis=0), axis=1) / (2.0 / n) ** 2
    padded = (3 * n, 3 * n)  # at least that many, so that nothing wraps around
    spectrum = np.fft.rfft2(loads, padded) * np.fft.rfft2(kernel, padded)
    displacement = np.fft.irfft2(spectrum, padded)[n - 1 : 2 * n - 1, n - 1 : 2 * n - 1]
    return float(displacement[loads > 0.0].max() / np.pi)
