"""Load of a pressure on each cell of a regular grid over the contact."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

RINGS = 4096
"""Number of thin rings that approximate a round pressure."""
SMALLEST_LOAD = 1e-13
"""A cell load below this fraction of the total load is a rounding error and is set to 0."""


def of_corner_loads(load: np.ndarray) -> np.ndarray:
    """Compute the loads of the cells, shape (cells, cells). Their sum is 1.

    load: load on the rectangle between the centre and each corner of a cell, (cells + 1, cells +
    1). It is odd in both coordinates.
    """
    return of_loads(np.diff(np.diff(load, axis=0), axis=1))


def of_loads(loads: np.ndarray) -> np.ndarray:
    """Scale the loads of the cells so that their sum is 1, and replace rounding errors near 0 by
    0."""
    loads = np.where(loads < SMALLEST_LOAD * loads.sum(), 0.0, loads)
    return loads / loads.sum()


def round_loads(cells: int, ring_loads: Callable, inner: float = 0.0) -> np.ndarray:
    """Compute the cell loads of a pressure that depends on the radius alone, shape (cells, cells).
    Their sum is 1.

    The load of each of RINGS thin rings is spread evenly along its middle circle.

    Parameters
    ----------
    cells : int
        Number of cells along a side.
    ring_loads : callable
        ring_loads(psi) -> load on each ring between neighbouring radii sin(psi).
    inner : float
        Radius of the hole in the contact.
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
