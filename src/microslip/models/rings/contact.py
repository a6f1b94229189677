"""Rings: exact for translation at nu = 0, where the traction vector depends on the radius alone.

The compiled work is done in tangent.py (the linear part of a step), newton_step.py (one step) and
march.py (a march, and its derivative, which makes the periodic state a Newton problem).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import scipy

from microslip.models import contact
from microslip.models.interrupts import unbroken
from microslip.models.path import Path
from microslip.models.pull import Body, PulledMarch
from microslip.models.rings import march as ring_march
from microslip.models.rings.influence import ring_influence
from microslip.models.rings.mesh import Focus, make_rings
from microslip.models.rings.tangent import RingSystem, cholesky
from microslip.models.varying_load import Growth, load_on_rings
from microslip.pressures.by_name import HERTZ
from microslip.pressures.pressure import Pressure


class RadialContact:
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
        Of the whole, see models.contact.Contact; None: that of the matrix.
    growth : varying_load.Growth or None
        Of the rings; without it the normal load cannot change.

    Attributes
    ----------
    edges : np.ndarray or None, shape (cells + 1,)
        Radii between the rings of the reference contact, None where there are none.
    """

    has_sensitivity = True
    sticks = True
    angles = 1
    radius = 1.0
    edges = None

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
        self._stiffness = 0.5 * (weighted + weighted.T)
        self._factor = cholesky(self._stiffness)
        self._system = RingSystem(self._stiffness, self._factor, self.weight)
        if stiffness is None:  # the force that moves all points by one
            stiffness = weight @ np.linalg.solve(self._stiffness, weight)
        self.stiffness = float(stiffness)

    @staticmethod
    def resolved(
        cells: int, focus: Focus | float | None = None, pressure: Pressure = HERTZ
    ) -> RadialContact:
        """The half-space on `cells` rings refined around the radius `focus`."""
        return _resolved(cells, focus, pressure)

    def at_indentation(self, deepest: float, start: float) -> RadialContact:
        """The same rings spread over the contact at its `deepest`, with the bound at `start`.

        Both are depths (see varying_load.py), deepest > 0.
        """
        growth, radius = self.growth, float(self.growth.pressure.radius(deepest))
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

    def _effective_radii(self):
        """Radius of the contact that is as stiff as the first k rings, stuck together, for k from 0
        to all; shape (cells + 1,).

        It is a little less than their outer edge.  A ring joins the contact halfway from the radius
        without it to that with it: then a growing contact has the right stiffness in the mean.
        Were it to join where the edge of the contact reaches it, all of it would be held too early
        by its inner part, an error of first order.
        """
        upper = np.triu(self._factor)
        np.fill_diagonal(upper, 1.0 / np.diag(upper))
        part = scipy.linalg.solve_triangular(upper, self.weight, trans="T")
        # w^T B^-1 w of the first k rings
        return np.concatenate([[0.0], np.cumsum(part**2) * self.radius / self.stiffness])

    def bounds(self, depths: np.ndarray, edge: np.ndarray | None = None) -> np.ndarray:
        """Mean friction bound of each ring at each depth, shape (len(depths), cells).

        edge: radii (len(depths),) that say which rings are in contact, by default those of the
        contact.  What is outside of these rings counts for the last of them.
        """
        load_within = self.growth.load_within(self.growth.pressure, self.growth.edges, depths)
        edge = self.growth.pressure.radius(depths) if edge is None else edge
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
        stages = path.stages.shape[1]
        ends = self.growth.pressure.radius(path.depth[::stages])
        shift = 0.5 - 1.0 / (1.0 + path.carry[-1].sum())
        seen = ends.copy()
        seen[:-1] += shift * np.diff(ends)  # the last as it is: there the next march begins
        edge = np.repeat(seen[:-1, None], stages, axis=1)
        edge[:, -1] = seen[1:]
        return self.bounds(path.depth, np.append(seen[:1], edge))

    def at_phases(self, march: contact.March, start: np.ndarray) -> np.ndarray:
        """Tractions at every phase of a march from `start`, (steps + 1, 2, 1, cells)."""
        stages = march.solves // (len(march.forces) - 1)
        return march.stages[::stages, :, None]

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q; shapes (2, 1, cells)."""
        return state @ self.influence.T

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """Lateral traction negated."""
        return state * contact.MIRROR

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        sensitivity: bool = False,
        previous: contact.March | None = None,
    ) -> contact.March:
        """March along `path` (translations only); see models.contact.Contact.

        The stages of the result, and of `previous`, are the tractions at the start and after
        every stage, (1 + steps stages, 2, cells).
        """
        stages = path.stages.shape[0] * path.stages.shape[1]
        known = None if previous is None else previous.stages
        if known is None or known.shape != (1 + stages, 2, len(self.bound)):
            known = np.empty((0, 2, 0))
        end, tractions, forces, residual, iterations, derivative = unbroken(
            ring_march.march,
            self._system,
            path.under(self.bound[None] if path.depth is None else self.bounds_along(path)),
            np.ascontiguousarray(state[:, 0]),
            known,
            tolerance,
            sensitivity,
        )
        return contact.March(
            state=end[:, None],
            forces=forces,
            residual=residual,
            iterations=iterations,
            solves=stages,
            sensitivity=derivative if sensitivity else None,
            stages=tractions,
        )

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
        imposed = path.under(bounds), np.empty((0, 2, 0))
        return self._pulled_along(path, imposed, state, tolerance, (body, start), previous)

    def _pulled_along(self, path, imposed, state, tolerance, pulled, previous):
        """The PulledMarch along a path that is imposed, see pulled_march.py; pulled: a pull.Body
        and where it is."""
        from microslip.models.rings.pulled_march import pulled_march  # only now: it takes a while

        body, start = pulled
        stages = path.stages.shape[0] * path.stages.shape[1]
        known = None if previous is None else previous.stages
        if known is None or known[0].shape != (1 + stages, 2, len(self.bound)):
            known = np.empty((0, 2, 0)), np.empty(0)
        end, tractions, places, moved, forces, residual, iterations = unbroken(
            pulled_march,
            self._system,
            imposed,
            body.along(path, start),
            np.ascontiguousarray(state[:, 0]),
            known,
            (float(tolerance), self.stiffness),
        )
        return PulledMarch(
            state=end[:, None],
            forces=forces,
            residual=residual,
            iterations=iterations,
            solves=stages,
            stages=(tractions, places),
            body=moved,
        )


@lru_cache(maxsize=32)
def _resolved(cells, focus, pressure):
    """Shared by runs that differ in their motion only: a contact never changes."""
    rings = make_rings(cells, focus, pressure)
    near, _ = ring_influence(rings.psi, 1, False, modulus=pressure.G_star)
    growth = Growth(pressure, np.sin(rings.psi), load_on_rings, influence_power=1, weight_power=2)
    return RadialContact(near[0], rings.bound, rings.area, pressure.stiffness, growth)
