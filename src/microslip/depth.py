"""The contact while its normal load changes: how wide it is, and what each part of it carries.

Depth is the indentation over that of the reference state (radius a, load F_z); everything else is
dimensionless as in hertz.  At depth d Hertz's contact has the radius sqrt(d) and carries d^(3/2).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np


def radius(depth):
    """Contact radius over the reference one; depth >= 0, any shape."""
    return np.sqrt(depth)


def load(depth):
    """Normal load over the reference one; depth >= 0, any shape."""
    return depth**1.5


def of_load(share):
    """The depth at which the normal load is ``share`` >= 0 of the reference one, any shape."""
    return np.cbrt(share) ** 2


def load_on_rings(edges, depth):
    """Load within each radius in ``edges`` (n + 1,) at each depth (k,), shape (k, n + 1)."""
    left = np.maximum(depth[:, None] - edges**2, 0.0)
    return load(depth)[:, None] - load(left)


def load_on_springs(edges, depth):
    """Load of the springs of dimensionality reduction within |x| < edges, as load_on_rings.

    The spring at x carries 3/4 (d - x^2) per length.
    """
    inside = np.minimum(edges, radius(depth)[:, None])
    return 1.5 * (depth[:, None] * inside - inside**3 / 3.0)


class Growth(NamedTuple):
    """How a row of rings or springs that fills the reference contact fills one of another size.

    edges: (n + 1,) from 0 to 1; carried(edges, depth) -> load within each edge, (k, n + 1); powers
    of the contact radius by which influence and weights grow.
    """

    edges: np.ndarray
    carried: Callable
    influence_power: int
    weight_power: int
