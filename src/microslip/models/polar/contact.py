"""Rings times angular modes: rotating motions at any nu, translation at nu > 0, and both at once.

Points sit on rings at angles theta_j = (j + 1/2) pi / M, theta from the lateral axis; the other
half of the disc follows from symmetry:

- motions that rotate: mirror image across the lateral axis (forward traction even, lateral odd);
- translation: point symmetry, traction(-z) = traction(z), so even modes only.

A motion that does both has neither symmetry, and the points of the other half are resolved, too.

Coulomb's law is asked for at the points; the elastic operator is block-diagonal in the angular
modes, one small ring matrix each (two modes m and 2 - m together where nu > 0).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from microslip.models import contact
from microslip.models.polar.angular_modes import ROTATION, TRANSLATION, WHOLE, influence_modes
from microslip.models.rings.contact import RadialContact, width_of
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.system_contact import Layout, SystemContact
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure

FEWEST_PROLONGED = 16
"""Rings below which tractions of a coarser contact are no better a start than the static limit."""


class PolarContact(SystemContact):
    """Rings times points on the disc (see models.contact.Contact); states: (2, angles, cells).

    Parameters
    ----------
    cells, angles : int
        Rings, and points of each on half the disc.
    rotates : bool
        Mirror symmetry of rotating motions, else point symmetry of translations.
    poisson : float
        Poisson's ratio.
    focus : mesh.Focus, float or None
        Where the rings gather.
    pressure : pressure.Pressure
        One that depends on the radius alone.
    whole : bool
        Whether the other half of the disc is resolved as well; states: (2, 2 angles, cells).

    Raises
    ------
    ValueError
        Where the half disc cannot be filled.
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
        if not whole:  # what the half disc that is not resolved cancels
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
        """The contact with these arguments, which runs that differ in their motion share."""
        return PolarContact(cells, angles, rotates, poisson, focus, pressure, whole=whole)

    def at_indentation(self, deepest: float, start: float) -> PolarContact:
        """A contact with these points spread over the largest contact area of a period.

        The arguments are those of RadialContact.at_indentation.
        """
        out = self.unprepared()
        loaded = RadialContact.resolved(*self._made_of).at_indentation(deepest, start)
        out.bounds, out.bounds_along = loaded.bounds, loaded.bounds_along
        out.radius = radius = loaded.radius
        out.forward_position = self.forward_position * radius
        out.lateral_position = self.lateral_position * radius
        out.bound, out.weight = loaded.bound, self.weight * radius**2
        out.operators = self.operators.joined([self.operators], np.array([radius]))
        out.compliance = self.compliance * radius
        out.stiffness = self.stiffness * radius
        return out

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Tractions of the same contact on other rings and angles, (2, angles, cells) of these,
        brought to the points of this one; None where it does not turn, its load changes, or its
        rings are too few for that to be of use.

        What is interpolated is the share of the friction bound.
        """
        few = len(self.rings.radius) < FEWEST_PROLONGED
        grows = hasattr(self, "bounds")
        if few or grows or not self.rotates or self.whole:
            return None
        _, focus, pressure = self._made_of
        rings, count = make_rings(state.shape[2], focus, pressure), state.shape[1]
        share = state / rings.bound
        # forward tractions are even across the lateral axis, where the angles begin and end
        beyond = share[:, [0, -1]] * contact.MIRROR
        share = np.concatenate([beyond[:, :1], share, beyond[:, 1:]], axis=1)
        given, wanted = ((np.arange(-1, count + 1) + 0.5) / count, self._theta / np.pi)
        share = _interpolated(wanted, given, share, axis=1)
        return _interpolated(self.rings.radius, rings.radius, share, axis=2) * self.bound


def _interpolated(
    wanted: np.ndarray, given: np.ndarray, values: np.ndarray, axis: int
) -> np.ndarray:
    """Linear between the given places along an axis, constant beyond them."""
    return np.apply_along_axis(lambda line: np.interp(wanted, given, line), axis, values)
