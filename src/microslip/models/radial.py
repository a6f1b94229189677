"""Rings: exact for translation at nu = 0, where the traction vector depends on the radius alone.

The compiled work is done in ring_factors (the linear part of a step), ring_kernels (one step) and
ring_march (a march, and its derivative, which makes the periodic state a Newton problem).
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from microslip.halfspace import ring_influence
from microslip.hertz import G_STAR
from microslip.models import contact, ring_march
from microslip.models.ring_factors import cholesky
from microslip.pressures import HERTZ
from microslip.rings import make_rings


class RadialContact:
    """Contact of ``cells`` rings (see models.contact.Contact); states have shape (2, 1, cells).

    influence: (cells, cells), mean ring tractions to ring-averaged displacements, symmetric once
    its rows are weighted; bound, weight: friction bound and area of each ring; stiffness: of the
    whole, see there, by default that of the matrix.  ``resolved`` builds
    the half-space's; the elastic slider is the one-ring contact of unit compliance.
    """

    has_sensitivity = True
    sticks = True
    angles = 1

    def __init__(self, influence, bound, weight, stiffness=None):
        self.influence = np.ascontiguousarray(influence, dtype=float)
        self.bound, self.weight = bound, weight
        self.compliance = np.diag(self.influence)
        self.forward_position = self.lateral_position = np.zeros((1, len(bound)))
        weighted = weight[:, None] * self.influence
        self._stiffness = 0.5 * (weighted + weighted.T)
        self._factor = cholesky(self._stiffness)
        if stiffness is None:  # the force that moves all points by one
            stiffness = weight @ np.linalg.solve(self._stiffness, weight)
        self.stiffness = float(stiffness)

    @staticmethod
    def resolved(cells, focus=None, pressure=HERTZ):
        """The half-space on ``cells`` rings refined around the radius ``focus``."""
        return _resolved(cells, focus, pressure)

    def displacement(self, state):
        """A q; shapes (2, 1, cells)."""
        return state @ self.influence.T

    def mirrored(self, state):
        """Lateral traction negated."""
        return state * contact.MIRROR

    def march(self, path, state, tolerance, sensitivity=False, previous=None):
        """March along ``path`` (translations only); see models.contact.Contact.

        The stages of the result, and of ``previous``, are the tractions at the start and after
        every stage, (1 + steps stages, 2, cells).
        """
        stages = path.stages.shape[0] * path.stages.shape[1]
        known = None if previous is None else previous.stages
        if known is None or known.shape != (1 + stages, 2, len(self.bound)):
            known = np.empty((0, 2, 0))
        end, tractions, forces, residual, iterations, derivative = ring_march.march(
            self._stiffness,
            self._factor,
            self.bound,
            self.weight,
            (path.positions, path.stages, path.carry, path.end),
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


@lru_cache(maxsize=32)
def _resolved(cells, focus, pressure):
    """Shared by runs that differ in their motion only: a contact never changes."""
    rings = make_rings(cells, focus, pressure)
    near, _ = ring_influence(rings.psi, 1, False)
    influence = near[0] * (G_STAR / pressure.G_star)
    return RadialContact(influence, rings.bound, rings.area, pressure.stiffness)
