"""Rings: exact for translation at nu = 0, where the traction vector depends on the radius alone."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from microslip.contacts.lanes import LANES
from microslip.contacts.operators import Matrices, packed
from microslip.contacts.splitting import PENALTIES, best_penalty
from microslip.models.path import Path
from microslip.models.rings.influence import ring_influence
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.system_contact import Layout, SystemContact
from microslip.models.varying_load import Growth, load_on_rings
from microslip.pressures.hertz import HERTZ
from microslip.pressures.pressure import Pressure


class RadialContact(SystemContact):
    """Contact of rings (see models.contact.Contact); states have shape (2, 1, cells).

    `resolved` builds the half-space's; the elastic slider is the one-ring contact of unit
    compliance.

    Parameters
    ----------
    influence : np.ndarray, shape (cells, cells)
        Mean ring tractions to ring-averaged displacements, symmetric once its rows are weighted.
    bound, weight : np.ndarray, shape (cells,)
        Friction bound and area of each ring.
    stiffness : float or None
        Stiffness of the whole contact, see models.contact.Contact; None: that of the matrix.
    growth : varying_load.Growth or None
        Growth of the contact with the depth; None: the normal load is constant.

    Attributes
    ----------
    edges : np.ndarray or None, shape (cells + 1,)
        Radii between the rings of the reference contact, None where there are none.
    """

    angles = 1
    edges: np.ndarray | None = None
    _joins: np.ndarray

    def __init__(
        self,
        influence: np.ndarray,
        bound: np.ndarray,
        weight: np.ndarray,
        stiffness: float | None = None,
        growth: Growth | None = None,
    ):
        self.influence = np.ascontiguousarray(influence, dtype=float)
        self.bound, self.weight, self.growth = bound, weight, growth
        if growth is not None:
            self.edges = growth.edges
        self.compliance = np.diag(self.influence)
        self.forward_position = self.lateral_position = np.zeros((1, len(bound)))
        weighted = weight[:, None] * self.influence
        self._weighted = 0.5 * (weighted + weighted.T)
        if stiffness is None:  # the force that moves all points by one
            stiffness = float(weight @ np.linalg.solve(self._weighted, weight))
        self.stiffness = float(stiffness)
        self.layout = Layout(1, 1, len(bound), width_of(len(bound)))
        self.mirror = np.arange(len(bound))
        self.operators = Matrices(packed(self._matrices(), self.layout.width))
        self.resultants = np.array([1.0, 1.0, 0.0])

    def _matrices(self) -> np.ndarray:
        """A and its resolvents, (operators, 1, cells, cells)."""
        weight = self.weight
        penalty = best_penalty(self.compliance, len(weight))
        shifts = PENALTIES[:, None, None] * np.diag(weight * penalty)
        resolvents = np.linalg.inv(self._weighted + shifts) * weight
        return np.concatenate([self._weighted[None] / weight[:, None], resolvents])[:, None]

    @staticmethod
    @lru_cache(maxsize=32)
    def resolved(
        cells: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ
    ) -> RadialContact:
        """The half-space on `cells` rings refined around the radius `focus`.

        Runs that differ in their motion alone share this object, which must not be changed.
        """
        rings = make_rings(cells, focus, pressure)
        near, _ = ring_influence(rings.psi, 1, False, modulus=pressure.G_star)
        edges = np.sin(rings.psi)
        growth = Growth(pressure, edges, load_on_rings, influence_power=1, weight_power=2)
        return RadialContact(near[0], rings.bound, rings.area, pressure.stiffness, growth)

    @property
    def _known_growth(self) -> Growth:
        assert self.growth is not None  # else the normal load cannot change
        return self.growth

    def at_indentation(self, deepest: float, start: float) -> RadialContact:
        """A contact with these rings spread over the largest contact area of a period.

        deepest: largest depth (see varying_load.py), above 0.  start: depth at the start of the
        period, at which the friction bound is taken.
        """
        growth = self._known_growth
        radius = float(growth.pressure.radius(deepest))
        out = RadialContact(
            self.influence * radius**growth.influence_power,
            self.bound,
            self.weight * radius**growth.weight_power,
            self.stiffness * radius,
            growth._replace(edges=growth.edges * radius),
        )
        out.radius, out.edges = radius, self.edges
        radii = out._effective_radii()
        out._joins = 0.5 * (radii[1:-1] + radii[2:])
        out.bound = out.bounds(np.array([start]))[0]
        return out

    def _effective_radii(self) -> np.ndarray:
        """Radius of the contact that is as stiff as the first k rings, stuck together, for k from 0
        to all; shape (cells + 1,).

        It is a little less than their outer edge.  A ring joins the contact halfway from the radius
        without it to that with it: then a growing contact has the right stiffness in the mean.
        Were it to join where the edge of the contact reaches it, all of it would be held too early
        by its inner part, an error of first order.
        """
        part = np.linalg.solve(np.linalg.cholesky(self._weighted), self.weight)
        # w^T B^-1 w of the first k rings
        return np.concatenate([[0.0], np.cumsum(part**2) * self.radius / self.stiffness])

    def bounds(self, depths: np.ndarray, edge: np.ndarray | None = None) -> np.ndarray:
        """Mean friction bound of each ring at each depth, shape (len(depths), cells).

        edge: radii (len(depths),) that say which rings are in contact, by default those of the
        contact.  What is outside of these rings counts for the last of them.
        """
        growth = self._known_growth
        load_within = growth.load_within(growth.pressure, growth.edges, depths)
        edge = growth.pressure.radius(depths) if edge is None else edge
        outside, most = edge[:, None] <= self._joins, load_within[:, -1:]
        load_within[:, 1:-1] = np.where(outside, most, load_within[:, 1:-1])
        return np.maximum(np.diff(load_within, axis=1), 0.0) / self.weight

    def bounds_along(self, path: Path) -> np.ndarray:
        """Bounds at the start and at every stage of a path, (1 + steps stages, cells).

        Rings join or leave at the last stage of a step only: what jumps at an earlier one would be
        carried on by the integrator.  At a steady rate a ring that joins there has been stretched
        for the share 1 / (1 + carried) of the step, where it should be half of it in the mean: the
        edge of the contact is seen as early as makes up for it.
        """
        assert path.depth is not None  # else the bounds stay what they are
        stages = path.stages.shape[1]
        ends = self._known_growth.pressure.radius(path.depth[::stages])
        shift = 0.5 - 1.0 / (1.0 + path.carry[-1].sum())
        seen = ends.copy()
        seen[:-1] += shift * np.diff(ends)  # the last as it is: there the next march begins
        edge = np.repeat(seen[:-1, None], stages, axis=1)
        edge[:, -1] = seen[1:]
        return self.bounds(path.depth, np.append(seen[:1], edge))


def width_of(rings: int) -> int:
    """Columns of a field of so many rings: whole vectors, see lanes.py."""
    return max(-(-rings // 4) * 4, LANES)
