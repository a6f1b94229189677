"""Contact of rings.  It is exact for translations at nu = 0, because the tractions then depend on
the radius alone."""

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

    Use `resolved` to create the contact of an elastic half-space.

    Parameters
    ----------
    influence : np.ndarray, shape (cells, cells)
        Matrix that maps mean ring tractions to mean ring displacements.  It becomes symmetric if
        its rows are multiplied by `weight`.
    bound, weight : np.ndarray, shape (cells,)
        Friction bound and area of each ring.
    stiffness : float or None
        Stiffness of the whole contact, see models.contact.Contact; None to compute it from the
        matrix.
    growth : varying_load.Growth or None
        Scaling of the contact with the depth; None if the normal load is constant.

    Attributes
    ----------
    edges : np.ndarray or None, shape (cells + 1,)
        Radii between the rings of the reference contact; None without `growth`.
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
        if stiffness is None:  # force for a unit displacement of all rings
            stiffness = float(weight @ np.linalg.solve(self._weighted, weight))
        self.stiffness = float(stiffness)
        self.layout = Layout(1, 1, len(bound), width_of(len(bound)))
        self.mirror = np.arange(len(bound))
        self.operators = Matrices(packed(self._matrices(), self.layout.width))
        self.resultants = np.array([1.0, 1.0, 0.0])

    def _matrices(self) -> np.ndarray:
        """Matrices of the operator A and its resolvents, (operators, 1, cells, cells)."""
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
        """Return the contact of an elastic half-space with `cells` rings graded towards `focus`.

        Calls with equal arguments return the same object, which must not be modified.
        """
        rings = make_rings(cells, focus, pressure)
        near, _ = ring_influence(rings.psi, 1, False, modulus=pressure.G_star)
        edges = np.sin(rings.psi)
        growth = Growth(pressure, edges, load_on_rings, influence_power=1, weight_power=2)
        return RadialContact(near[0], rings.bound, rings.area, pressure.stiffness, growth)

    @property
    def _checked_growth(self) -> Growth:
        assert self.growth is not None  # otherwise the normal load is constant
        return self.growth

    def at_indentation(self, deepest: float, start: float) -> RadialContact:
        """Return a contact whose rings fill the largest contact area in a period.

        Parameters
        ----------
        deepest : float
            Largest depth (see varying_load.py), above 0.
        start : float
            Depth at the start of the period, for which `bound` is computed.
        """
        growth = self._checked_growth
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
        """Effective radii, (cells + 1,).  Without slip, a contact whose radius is entry k has the
        same stiffness as the first k rings.

        An effective radius is a little smaller than the outer edge of the rings.  A ring joins the
        contact when the contact radius reaches the mean of the effective radii without and with
        this ring.  A growing contact then has the correct stiffness on average.  If the ring joined
        as soon as the contact reached the ring's inner edge, it would stick too early.  This would
        be an error of first order.
        """
        part = np.linalg.solve(np.linalg.cholesky(self._weighted), self.weight)
        # w^T B^-1 w of the first k rings, B: weighted influence
        return np.concatenate([[0.0], np.cumsum(part**2) * self.radius / self.stiffness])

    def bounds(self, depths: np.ndarray, edge: np.ndarray | None = None) -> np.ndarray:
        """Mean friction bound of each ring at each depth, shape (len(depths), cells).

        edge: radii (len(depths),) inside which rings are in contact; None for the contact radii.
        Load outside these rings is added to the outermost of them.
        """
        growth = self._checked_growth
        load_within = growth.load_within(growth.pressure, growth.edges, depths)
        edge = growth.pressure.radius(depths) if edge is None else edge
        outside, most = edge[:, None] <= self._joins, load_within[:, -1:]
        load_within[:, 1:-1] = np.where(outside, most, load_within[:, 1:-1])
        return np.maximum(np.diff(load_within, axis=1), 0.0) / self.weight

    def bounds_along(self, path: Path) -> np.ndarray:
        """Friction bounds at the start and at every stage of a path, (1 + steps stages, cells).

        Rings join or leave the contact only at the last stage of a step, because the integrator
        would carry over a jump from an earlier stage to the later stages.  A ring that joins at the
        last stage is strained for the fraction 1 / (1 + carried) of the step, but on average it
        should be strained for half of the step.  The contact radius is therefore evaluated at an
        earlier time, to make up for the difference.
        """
        assert path.depth is not None  # otherwise the bounds are constant
        stages = path.stages.shape[1]
        ends = self._checked_growth.pressure.radius(path.depth[::stages])
        shift = 0.5 - 1.0 / (1.0 + path.carry[-1].sum())
        radii = ends.copy()
        radii[:-1] += shift * np.diff(ends)  # not the last one, where the next march begins
        edge = np.repeat(radii[:-1, None], stages, axis=1)
        edge[:, -1] = radii[1:]
        return self.bounds(path.depth, np.append(radii[:1], edge))


def width_of(rings: int) -> int:
    """Number of columns in a field for this number of rings: a multiple of 4, and at least
    LANES."""
    return max(-(-rings // 4) * 4, LANES)
