"""The method of dimensionality reduction: a row of independent springs with friction.

For tangential loading in one direction it reproduces the half-space exactly (Cattaneo and Mindlin,
any axisymmetric indenter); with two components of slip it is an approximation, since its springs
know nothing of each other.  Springs at -a < x < a have the stiffness G* per length, and the
indenter gives each the friction bound G* (1 - h(x)) per length (dimensionless), h(x) the share of
the depth at which the contact radius is x, so that it yields at (1 - h) u_lim: 1 - x^2 for a
sphere.  At another indentation d these are (d - h) u_lim, where that is above 0.
"""

from __future__ import annotations

import numpy as np

from microslip.models.rings.contact import RadialContact
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.varying_load import Growth, load_on_springs
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure


def mdr_contact(
    cells: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ
) -> RadialContact:
    """`cells` springs under an indenter's Pressure on 0 < x < 1 with their mirror images,
    gathered around x = `focus`.

    The spring at x stands for both halves of a ring: what a spring carries is force over length.
    """
    edges = np.sin(make_rings(cells, focus).psi)
    length = np.diff(edges)
    bound = 0.5 * np.diff(load_on_springs(pressure, edges, np.ones(1))[0]) / length
    influence = np.eye(cells) / pressure.G_star
    growth = Growth(pressure, edges, load_on_springs, influence_power=0, weight_power=1)
    return RadialContact(influence, bound, 2.0 * length, pressure.stiffness, growth)
