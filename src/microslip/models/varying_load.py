"""Load on each part of an axisymmetric indenter's contact, as a function of the depth.

The depth is the indentation divided by its value in the reference state, in which the contact
radius is a and the load is F_z.  All other quantities are in working units (see
pressures/pressure.py).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from microslip.pressures.pressure import Pressure


def load_on_rings(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Load within each radius of `edges` (n + 1,) at each depth (k,), shape (k, n + 1)."""
    return pressure.load(edges, pressure.radius(depth)[:, None])


def load_on_springs(pressure: Pressure, edges: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """Load of the springs within |x| < edges in the method of dimensionality reduction, (k, n + 1).

    The spring at x carries G* (d - h(x)) per length at the depth d, where h(x) is the depth for the
    contact radius x.  The integral of x h' is the load of a contact of this radius.
    """
    inside = np.minimum(edges, pressure.radius(depth)[:, None])
    compression = depth[:, None] - pressure.depth(inside)
    return pressure.stiffness * inside * compression + pressure.load(inside, inside)


class Growth(NamedTuple):
    """Scaling of rings or springs from the reference contact to a contact of another size.

    Attributes
    ----------
    pressure : pressure.Pressure
        Pressure of an axisymmetric indenter.
    edges : np.ndarray, shape (n + 1,)
        Edges of the rings or springs in the reference contact, 0 to 1.
    load_within : callable
        load_within(pressure, edges, depth) -> load within each edge, (k, n + 1); one of the
        functions of this module.
    influence_power, weight_power : int
        Powers of the contact radius to which influence and weights are proportional.
    """

    pressure: Pressure
    edges: np.ndarray
    load_within: Callable
    influence_power: int
    weight_power: int
