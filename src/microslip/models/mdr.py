"""The method of dimensionality reduction: a row of independent springs with friction.

For tangential loading in one direction it reproduces the half-space exactly (Cattaneo and Mindlin,
any axisymmetric profile); with two components of slip it is an approximation, since its springs
know nothing of each other.  Springs at -a < x < a have the stiffness G* per length, and Hertz's
parabola gives each the friction bound 3/4 (1 - x^2) per length (dimensionless), so that it yields
at (1 - x^2) u_lim.  At another indentation d these are (d - x^2) u_lim, for |x| < sqrt(d).
"""

from __future__ import annotations

import numpy as np

from microslip.depth import Growth, load_on_springs
from microslip.hertz import G_STAR
from microslip.models.radial import RadialContact
from microslip.rings import make_rings


def mdr_contact(cells, focus=None):
    """``cells`` springs on 0 < x < 1 with their mirror images, gathered around x = ``focus``.

    The spring at x stands for both halves of a ring: what a spring carries is force over length.
    """
    edges = np.sin(make_rings(cells, focus).psi)
    length = np.diff(edges)
    bound = 0.75 * (1.0 - np.diff(edges**3) / (3.0 * length))
    growth = Growth(edges, load_on_springs, influence_power=0, weight_power=1)
    return RadialContact(np.eye(cells) / G_STAR, bound, 2.0 * length, growth)
