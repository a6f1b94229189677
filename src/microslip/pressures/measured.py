"""A pressure given point by point: what a sensor measured, or another program computed."""

from __future__ import annotations

import numpy as np

from microslip.pressures.record import Pressure

AXES = ("forward", "lateral")
FINE = 256
"""Squares along a side at which the largest displacement under full slip is found."""
REGULAR = 1e-3
"""Distances between neighbours may differ by this share."""


def of_grid(name, forward, lateral, values):
    """The Pressure of values on a regular grid; forward, lateral: increasing, (n,) and (m,), in one
    unit of length; values: (n, m), 0 outside the contact, in any unit.  Every point stands for a
    rectangle around it, with the pressure constant in it.

    a is half the longer side of the rectangle around all points with pressure, and its centre is
    the one that rotations turn about.  Raises ValueError for a grid that is not regular, values
    below 0 or not finite, and a load that is 0.
    """
    widths = [_width(label, axis) for label, axis in zip(AXES, (forward, lateral), strict=True)]
    if not np.isfinite(values).all() or values.min() < 0.0:
        bad = values[~(np.isfinite(values) & (values >= 0.0))][0]
        raise ValueError(f"pressure {bad:g} is not allowed; allowed: finite numbers, 0 or above")
    loaded = values > 0.0
    if not loaded.any():
        raise ValueError("pressure is 0 everywhere; allowed: a load above 0")
    edges, centres, halves = [], [], []
    for axis, width, other in ((forward, widths[0], 1), (lateral, widths[1], 0)):
        used = axis[loaded.any(axis=other)]
        edges.append(np.append(axis - 0.5 * width, axis[-1] + 0.5 * width))
        centres.append(0.5 * (used[0] + used[-1]))
        halves.append(0.5 * (used[-1] - used[0] + width))
    edges = [(edge - centre) / max(halves) for edge, centre in zip(edges, centres, strict=True)]
    total = np.zeros((len(forward) + 1, len(lateral) + 1))
    total[1:, 1:] = values.cumsum(axis=0).cumsum(axis=1)
    total /= total[-1, -1]
    middles = [0.5 * (edge[1:] + edge[:-1]) for edge in edges]

    def cell_loads(cells):
        corners = np.arange(cells + 1) * 2.0 / cells - 1.0
        part = np.stack([np.interp(corners, edges[1], row) for row in total])
        part = np.stack([np.interp(corners, edges[0], column) for column in part.T], axis=1)
        return np.maximum(np.diff(np.diff(part, axis=0), axis=1), 0.0)

    load = values / values.sum()
    return Pressure(
        name=name,
        summary="a pressure from a file",
        G_star=_largest_displacement(cell_loads(FINE)),
        torque=float(np.sum(load * np.hypot(middles[0][:, None], middles[1][None, :]))),
        cell_loads=cell_loads,
    )


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
    from scipy.signal import fftconvolve

    n = len(loads)
    edges = (np.arange(1 - n, n + 1) - 0.5) * 2.0 / n
    u, v = edges[:, None], edges[None, :]
    # Integral of 1/distance over the rectangle from the centre to (u, v)
    to_corner = u * np.arcsinh(v / np.abs(u)) + v * np.arcsinh(u / np.abs(v))
    kernel = np.diff(np.diff(to_corner, axis=0), axis=1) / (2.0 / n) ** 2
    displacement = fftconvolve(loads, kernel)[n - 1 : 2 * n - 1, n - 1 : 2 * n - 1]
    return float(displacement[loads > 0.0].max() / np.pi)
