"""Contact of rings with angular modes, for rotations at any nu and for translations at nu > 0.

Points are on rings at the angles theta_j = (j + 1/2) pi / M from the lateral axis.  Only one half
of the disc is resolved; the other half follows from symmetry:

- for rotations, a reflection across the lateral axis (forward traction even, lateral traction odd);
- for translations, the point symmetry traction(-z) = traction(z), so that all modes are even.

A motion that combines a rotation and a translation has neither symmetry, so the whole disc is
resolved.

Coulomb's law holds at the points.  The elastic operator is block-diagonal in the angular modes,
with one ring matrix for each mode at nu = 0, and one for each pair m and 2 - m at nu > 0.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from microslip.contacts.operators import scaled
from microslip.models import contact
from microslip.models.polar.angular_modes import ROTATION, TRANSLATION, WHOLE, influence_modes
from microslip.models.rings.contact import RadialContact, width_of
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.system_contact import Layout, SystemContact
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

FEWEST_PROLONGED = 16
"""Smallest number of rings at which tractions from a coarser mesh are a better initial guess than
the static limit."""


class PolarContact(SystemContact):
    """Contact of points on rings and at angles (see models.contact.Contact); states have the shape
    (2, angles, cells).

    Parameters
    ----------
    cells, angles : int
        Number of rings, and number of points of each ring on half the disc.  The latter must be
        even.
    rotates : bool
        True for a rotation, which has mirror symmetry; False for a translation.
    poisson : float
        Poisson's ratio.
    focus : mesh.Focus, float or None
        Radii towards which the rings are graded.
    pressure : pressure.Pressure
        Pressure that depends on the radius alone.
    whole : bool
        Whether the whole disc is resolved; states then have shape (2, 2 angles, cells).

    Raises
    ------
    ValueError
        If `angles` is odd or below 2.
    """

    def __init__(
        self,
        cells: int,
        angles: int,
        rotates: bool,
        poisson: float = 0.0,
        focus: Focus | float | None = None,
        pressure: Pressure = HERTZ,
        *,
        whole: bool = False,
    ):
        if angles < 2 or angles % 2:
            raise ValueError(f"angles = {angles}: allowed is an even number of at least 2")
        self.rings = rings = make_rings(cells, focus, pressure)
        self.rotates, self.whole, self.stiffness = rotates, whole, pressure.stiffness
        self.edges = np.sin(rings.psi)
        self.angles = rows = 2 * angles if whole else angles
        self._theta = theta = (np.arange(rows) + 0.5) * np.pi / angles
        self.lateral_position = np.cos(theta)[:, None] * rings.radius
        self.forward_position = np.sin(theta)[:, None] * rings.radius
        self.bound, self.weight = rings.bound, rings.area / rows
        self.layout = Layout(1, rows, cells, width_of(cells))
        mirror = np.arange(rows * cells).reshape(rows, cells)[::-1]
        self.mirror = np.roll(mirror, angles if whole else 0, axis=0).ravel()
        symmetry = WHOLE if whole else ROTATION if rotates else TRANSLATION
        self.operators, self.compliance = influence_modes(
            rings, angles, symmetry, poisson, pressure.G_star, self.layout.width
        )
        self.resultants = np.ones(3)
        if not whole:  # the other half of the disc cancels this force
            self.resultants[contact.LATERAL if rotates else contact.TORQUE] = 0.0
        self._made_of = cells, focus, pressure

    @staticmethod
    @lru_cache(maxsize=32)
    def resolved(
        cells: int,
        angles: int,
        rotates: bool,
        poisson: float,
        focus: Focus | float | None,
        pressure: Pressure,
        *,
        whole: bool,
    ) -> PolarContact:
        """Return the contact with these arguments.  Calls with equal arguments return the same
        object, which must not be modified."""
        return PolarContact(cells, angles, rotates, poisson, focus, pressure, whole=whole)

    def at_indentation(self, deepest: float, start: float) -> PolarContact:
        """Return a contact whose points fill the largest contact area in a period.

        The arguments are those of RadialContact.at_indentation.
        """
        out = self.unprepared()
        loaded = RadialContact.resolved(*self._made_of).at_indentation(deepest, start)
        out.bounds, out.bounds_along = loaded.bounds, loaded.bounds_along
        out.radius = radius = loaded.radius
        out.forward_position = self.forward_position * radius
        out.lateral_position = self.lateral_position * radius
        out.bound, out.weight = loaded.bound, self.weight * radius**2
        out.operators = self.operators._replace(blocks=scaled(self.operators.blocks, radius))
        out.compliance = self.compliance * radius
        out.stiffness = self.stiffness * radius
        return out

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Interpolate tractions (2, angles, cells) from a coarser mesh to the points of this
        contact.

        Tractions are interpolated as fractions of the friction bound.  Returns None for
        translations, whole discs, changing loads and fewer than FEWEST_PROLONGED rings.
        """
        few = len(self.rings.radius) < FEWEST_PROLONGED
        grows = hasattr(self, "bounds")
        if few or grows or not self.rotates or self.whole:
            return None
        _, focus, pressure = self._made_of
        rings, count = make_rings(state.shape[2], focus, pressure), state.shape[1]
        share = state / rings.bound
        # extend the angles beyond the lateral axis, across which forward tractions are even
        beyond = share[:, [0, -1]] * contact.MIRROR
        share = np.concatenate([beyond[:, :1], share, beyond[:, 1:]], axis=1)
        angles = (np.arange(-1, count + 1) + 0.5) / count
        share = _interpolated(self._theta / np.pi, angles, share, axis=1)
        return _interpolated(self.rings.radius, rings.radius, share, axis=2) * self.bound


def _interpolated(x: np.ndarray, nodes: np.ndarray, values: np.ndarray, axis: int) -> np.ndarray:
    """Interpolate linearly along an axis, from values at the nodes to the points x.  Values are
    constant beyond the nodes."""
    return np.apply_along_axis(lambda line: np.interp(x, nodes, line), axis, values)
