"""Rings times angular modes: rotating motions at any nu, translation at nu > 0, and both at once.

Points sit on rings at angles theta_j = (j + 1/2) pi / M, theta from the lateral axis; the other
half of the disc follows from symmetry:

- motions that rotate: mirror image across the lateral axis (forward traction even, lateral odd);
- translation: point symmetry, traction(-z) = traction(z), so even modes only.

A motion that does both has neither symmetry, and the points of the other half are resolved, too.

Coulomb's law is asked for at the points; the elastic operator is block-diagonal in the angular
modes, one small ring matrix each (two modes m and 2 - m together where nu > 0).  A step is solved
by ADMM: the quadratic part through the blocks factorised once, the friction bound point by point.
"""

from __future__ import annotations

from copy import copy
from functools import lru_cache

import numpy as np

from microslip.contacts.splitting import best_penalty, resolvent
from microslip.contacts.system import System
from microslip.models import contact
from microslip.models.path import Path
from microslip.models.polar.angular_modes import (
    Folded,
    apply_folded,
    influence_sectors,
    quickest,
    scaled,
    shifted_inverse,
)
from microslip.models.rings.contact import RadialContact
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.system_contact import SystemContact
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

    loaded = None
    """Rings that know the bounds while the normal load changes, a RadialContact."""

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
        self.rings = make_rings(cells, focus, pressure)
        self.rotates, self.stiffness = rotates, pressure.stiffness
        self.edges = np.sin(self.rings.psi)
        self.whole, self._half, self.angles = whole, angles, 2 * angles if whole else angles
        self._theta = theta = (np.arange(self.angles) + 0.5) * np.pi / angles
        self.lateral_position = np.cos(theta)[:, None] * self.rings.radius
        self.forward_position = np.sin(theta)[:, None] * self.rings.radius
        self.bound = self.rings.bound
        self.weight = self.rings.area / self.angles
        key = (cells, angles, rotates, poisson, focus, pressure)
        self.influence, self.inverse, self.compliance = _prepared(*key, whole=whole)
        self.penalty = best_penalty(self.compliance, cells)
        self._made_of = cells, focus, pressure

    def at_indentation(self, deepest: float, start: float) -> PolarContact:
        """The same points spread over the contact at its `deepest`, with the bound at `start`;
        see RadialContact.at_indentation."""
        out = copy(self)
        out.loaded = RadialContact.resolved(*self._made_of).at_indentation(deepest, start)
        out.radius = radius = out.loaded.radius
        out.forward_position = self.forward_position * radius
        out.lateral_position = self.lateral_position * radius
        out.bound, out.weight = out.loaded.bound, self.weight * radius**2
        out.influence = scaled(self.influence, radius)
        out.inverse = scaled(self.inverse, 1.0 / radius)
        out.compliance, out.penalty = self.compliance * radius, self.penalty * radius
        out.stiffness = self.stiffness * radius
        return out

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Mean friction bound of each ring at each depth, shape (len(depths), cells)."""
        return self.loaded.bounds(depths)

    def bounds_along(self, path: Path) -> np.ndarray:
        """Bounds at the start and at every stage of a path, (1 + steps stages, cells)."""
        return self.loaded.bounds_along(path)

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; shapes (2, angles, cells)."""
        out = np.empty(state.shape)
        apply_folded(self.system().compliance, np.ascontiguousarray(state), out)
        return out

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Tractions of the same contact on other rings and angles, (2, angles, cells) of these,
        brought to the points of this one; None where it does not turn, its load changes, or its
        rings are too few for that to be of use.

        What is interpolated is the share of the friction bound.
        """
        few = len(self.rings.radius) < FEWEST_PROLONGED
        if few or not self.rotates or self.whole or self.loaded is not None:
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

    def system(self) -> System:
        """The System of the points."""
        rows, n = self.forward_position.shape
        mirror = np.arange(rows * n).reshape(rows, n)[::-1]
        folded = np.empty((8 if self.whole else 4, self._half // 2, n))
        scratch = folded, np.empty_like(folded)
        resultants = np.ones(3)
        if not self.whole:  # what the half disc that is not resolved cancels
            resultants[contact.LATERAL if self.rotates else contact.TORQUE] = 0.0
        return System(
            compliance=Folded(self.influence, *scratch),
            solver=resolvent(Folded(self.inverse, *scratch), self.penalty, self.weight, rows),
            scale=self.compliance,
            weight=self.weight,
            positions=(self.forward_position, self.lateral_position),
            first=np.array([0, n]),
            mirror=np.roll(mirror, self._half if self.whole else 0, axis=0).ravel(),
            resultants=resultants,
            stiffness=float(self.stiffness),
        )


def _interpolated(wanted, given, values, axis):
    """Linear between the given places along an axis, constant beyond them."""
    return np.apply_along_axis(lambda line: np.interp(wanted, given, line), axis, values)


@lru_cache(maxsize=32)
def _prepared(cells, angles, rotates, poisson, focus, pressure, *, whole):
    """The operator, (A + penalty)^-1, and the self-influence of each ring."""
    key = (cells, angles, rotates, poisson, focus, pressure)
    operator, compliance = influence_sectors(*key, whole=whole)
    inverse = shifted_inverse(operator, best_penalty(compliance, cells))
    return quickest(operator), quickest(inverse), compliance
