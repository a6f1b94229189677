"""The contact while its normal load changes: what each part of it carries.

Depth is the indentation over that of the reference state (radius a, load F_z); everything else is
in the working units of a pressure.Pressure, that of an axisymmetric indenter.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from microslip.pressures.pressure import Pressure


def load_on_rings(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Load within each radius in `edges` (n + 1,) at each depth (k,), shape (k, n + 1)."""
    return pressure.load(edges, pressure.radius(depth)[:, None])


def load_on_springs(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Load of the springs of dimensionality reduction within |x| < edges, as load_on_rings.

    The spring at x carries G* (d - h(x)) per length, h(x) the depth at which the contact radius
    is x; the integral of x h' is the load of a contact of that radius.
    """
    inside = np.minimum(edges, pressure.radius(depth)[:, None])
    left = depth[:, None] - pressure.depth(inside)
    return pressure.stiffness * inside * left + pressure.load(inside, inside)


class Growth(NamedTuple):
    """How a row of rings or springs that fills the reference contact fills one of another size.

    Attributes
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    edges : np.ndarray, shape (n + 1,)
        From 0 to 1.
    load_within : callable
        load_within(pressure, edges, depth) -> load within each edge, (k, n + 1).
    influence_power, weight_power : int
        Powers of the contact radius by which influence and weights grow.
    """

    pressure: Pressure
    edges: np.ndarray
    load_within: Callable
    influence_power: int
    weight_power: int
