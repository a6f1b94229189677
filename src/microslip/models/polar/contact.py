"""Rings times angular modes: rotating scenes at any nu, translation at nu > 0, and both at once.

Points sit on rings at angles theta_j = (j + 1/2) pi / M, theta from the lateral axis; the other
half of the disc follows from symmetry:

- scenes that rotate: mirror image across the lateral axis (forward traction even, lateral odd);
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

from microslip.models import contact
from microslip.models.interrupts import unbroken
from microslip.models.path import Path
from microslip.models.polar import march as polar_march
from microslip.models.polar.angular_modes import (
    apply_sectors,
    influence_sectors,
    quickest,
    scaled,
    shifted_inverse,
)
from microslip.models.polar.folding import fold, unfold
from microslip.models.pull import Body, PulledMarch
from microslip.models.rings.contact import RadialContact
from microslip.models.rings.mesh import Focus, make_rings
from microslip.pressures.by_name import HERTZ
from microslip.pressures.pressure import Pressure

PENALTY = 1.0
"""Augmentation over the self-influence of a ring; iterations double at half and at twice it."""
ROTATING_RINGS = 12
"""Rings of a rotating contact at which that is best.  Narrow rings give way less than the whole
contact does, and the best augmentation lies between the two: it grows with the root of their
number."""

FEWEST_PROLONGED = 16
"""Rings below which tractions of a coarser contact are no better a start than the static limit."""


class PolarContact:
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

    has_sensitivity = False
    sticks = True
    radius = 1.0
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
        self.penalty = _penalty(cells, rotates) * self.compliance
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

    def at_phases(self, march: contact.March, start: np.ndarray) -> np.ndarray:
        """Tractions at every phase of a march from `start`, (steps + 1, 2, angles, cells)."""
        return start + np.concatenate(
            [np.zeros((1, *start.shape)), np.cumsum(march.stages[0].sum(axis=1), axis=0)]
        )

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; shapes (2, angles, cells)."""
        folded = np.empty((self._parts, self._half // 2, state.shape[2]))
        image, out = np.empty_like(folded), np.empty(state.shape)
        fold(np.ascontiguousarray(state), folded)
        apply_sectors(self.influence, folded, image)
        unfold(image, out)
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

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """theta -> pi - theta, lateral traction negated."""
        image = state[:, ::-1, :] * contact.MIRROR
        return np.roll(image, self._half, axis=1) if self.whole else image

    @property
    def _parts(self):
        """Of folded tractions."""
        return 8 if self.whole else 4

    def _without_what_cancels(self, forces):
        """Set to zero what symmetry forbids, and the half disc that is not resolved cancels."""
        if not self.whole:
            forces[:, contact.LATERAL if self.rotates else contact.TORQUE] = 0.0

    @property
    def _points(self):
        """The contact for compiled code."""
        return polar_march.Points(
            self.influence,
            self.inverse,
            self.penalty,
            self.weight,
            (self.forward_position, self.lateral_position),
            self._parts,
        )

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        sensitivity: bool = False,
        previous: contact.March | None = None,
    ) -> contact.March:
        """March along `path`; see models.contact.Contact."""
        forces = np.zeros((path.steps + 1, 3))
        if previous is None:
            stages = np.empty((2, *path.stages.shape[:2], *state.shape))
        else:
            stages = previous.stages.copy()
        state, residual, iterations = unbroken(
            polar_march.march,
            self._points,
            path.under(self.bound[None] if path.depth is None else self.bounds_along(path)),
            np.ascontiguousarray(state),
            tolerance,
            polar_march.Stages(stages[0], stages[1], previous is not None),
            forces,
        )
        self._without_what_cancels(forces)
        solves = path.stages.shape[0] * path.stages.shape[1]
        return contact.March(state, forces, residual, iterations, solves, stages=stages)

    def pulled_march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        body: Body,
        start: np.ndarray,
        previous: PulledMarch | None = None,
    ) -> PulledMarch:
        """March from which a body may stay behind or run ahead; see models.pull.PullsContact."""
        bounds = self.bound[None] if path.depth is None else self.bounds_along(path)
        besides = np.empty((1 + path.stages.shape[0] * path.stages.shape[1], 3, 0))
        return self._pulled_along(
            path, (bounds, besides), state, tolerance, (body, start), previous
        )

    def _pulled_along(self, path, imposed, state, tolerance, pulled, previous):
        """The PulledMarch along a path; imposed: friction bounds, and what each ring does besides,
        see pulled_march.py; pulled: a pull.Body and where it is."""
        from microslip.models.polar.pulled_march import (  # only now: it takes a while to load
            PulledStages,
            pulled_march,
        )

        (bounds, besides), (body, start), shape = imposed, pulled, path.stages.shape[:2]
        if previous is None:
            stages = np.empty((2, *shape, *state.shape)), np.zeros(shape)
        else:
            stages = tuple(part.copy() for part in previous.stages)
        forces, moved = np.zeros((path.steps + 1, 3)), np.empty((path.steps + 1, 2))
        state, residual, iterations = unbroken(
            pulled_march,
            self._points,
            (path.under(bounds), besides),
            body.along(path, start),
            np.ascontiguousarray(state),
            PulledStages(stages[0][0], stages[0][1], stages[1], previous is not None),
            (float(tolerance), forces, moved),
        )
        self._without_what_cancels(forces)
        return PulledMarch(
            state, forces, residual, iterations, shape[0] * shape[1], stages=stages, body=moved
        )


def _interpolated(wanted, given, values, axis):
    """Linear between the given places along an axis, constant beyond them."""
    return np.apply_along_axis(lambda line: np.interp(wanted, given, line), axis, values)


def _penalty(cells, rotates):
    """Augmentation over the self-influence of a ring."""
    return PENALTY * (cells / ROTATING_RINGS) ** 0.5 if rotates else PENALTY


@lru_cache(maxsize=32)
def _prepared(cells, angles, rotates, poisson, focus, pressure, *, whole):
    """The operator, (A + penalty)^-1, and the self-influence of each ring."""
    key = (cells, angles, rotates, poisson, focus, pressure)
    operator, compliance = influence_sectors(*key, whole=whole)
    inverse = shifted_inverse(operator, _penalty(cells, rotates) * compliance)
    return quickest(operator), quickest(inverse), compliance
