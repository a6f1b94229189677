"""The method of dimensionality reduction: a row of independent springs with friction.

The method is exact for tangential loading of an axisymmetric indenter in one direction (Cattaneo
and Mindlin).  For slip in two directions, it is an approximation, because the springs do not
interact.  Springs at -a < x < a have the stiffness G* and the friction bound G* (1 - h(x)) per unit
length.  Here h(x) is the depth for the contact radius x divided by the reference depth.  So the
spring at x begins to slide at the displacement (1 - h) u_lim, which is (1 - x^2) u_lim for a
sphere.  At d times the reference depth, it begins to slide at (d - h) u_lim if d > h.
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
    """Create a contact of `cells` springs on 0 < x < 1 and their mirror images, graded towards
    `focus`.

    `bound` is a force per unit length.  The weight of a spring is its length plus the length of its
    mirror image.
    """
    edges = np.sin(make_rings(cells, focus).psi)
    length = np.diff(edges)
    bound = 0.5 * np.diff(load_on_springs(pressure, edges, np.ones(1))[0]) / length
    influence = np.eye(cells) / pressure.G_star
    growth = Growth(pressure, edges, load_on_springs, influence_power=0, weight_power=1)
    return RadialContact(influence, bound, 2.0 * length, pressure.stiffness, growth)
