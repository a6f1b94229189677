"""Loads of pressures on square cells."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

RINGS = 4096
SMALLEST_LOAD = 1e-13
"""Loads of cells below this share of the whole are rounding at the contact's edge."""


def of_corner_loads(load: np.ndarray) -> np.ndarray:
    """Loads of cells, sum 1, from the load of the rectangle from the centre to each corner (odd in
    both coordinates), (cells + 1, cells + 1)."""
    return of_loads(np.diff(np.diff(load, axis=0), axis=1))


def of_loads(loads: np.ndarray) -> np.ndarray:
    """Loads of cells, sum 1, from loads with rounding errors; those near 0 become 0."""
    loads = np.where(loads < SMALLEST_LOAD * loads.sum(), 0.0, loads)
    return loads / loads.sum()


def round_loads(cells: int, ring_loads: Callable, inner: float = 0.0) -> np.ndarray:
    """Loads of cells under a pressure that depends on the radius alone, (cells, cells), sum 1.

    ring_loads(psi): loads of the rings between the radii sin(psi).  The load of each of many thin
    rings is spread evenly along its circle: exact but for the width of the rings.
    """
    turn = np.linspace(0.0, np.pi / 2, RINGS + 1)
    psi = np.arcsin(np.sqrt(inner**2 + (1.0 - inner**2) * np.sin(turn) ** 2))
    loads = ring_loads(psi)
    middle = np.sin(0.5 * (psi[1:] + psi[:-1]))
    edges = np.arange(cells + 1) * 2.0 / cells - 1.0
    sizes, places = np.unique(np.abs(edges), return_inverse=True)
    corner = np.empty((len(sizes), len(sizes)))
    across = np.arcsin(np.minimum(sizes[:, None] / middle, 1.0))
    for i, size in enumerate(sizes):
        along = np.arccos(np.minimum(size / middle, 1.0))
        corner[i] = np.maximum(across - along, 0.0) @ loads
    signs = np.sign(edges)
    return of_corner_loads(signs[:, None] * signs * corner[np.ix_(places, places)])
