"""The one contract of the models that march: what a contact is, and what a march returns."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from microslip.foundation.errors import SolverError
from microslip.models.path import Path

FORWARD, LATERAL, TORQUE = range(3)
"""Columns of the forces."""

MIRROR = np.array([1.0, -1.0])[:, None, None]
"""Signs of forward and lateral tractions in the mirror image, shape (2, 1, 1)."""


@dataclass(frozen=True, eq=False)
class March:
    """The result of one march along a path.

    Attributes
    ----------
    state : np.ndarray, shape (2, n_angles, n_radii) or (2, n, n)
        Forward and lateral tractions at the end.
    forces : np.ndarray, shape (steps + 1, 3)
        Forward force, lateral force, torque at each phase, over mu F_z and mu F_z a.
    residual : float
        Residual force of the step solver over mu F_z, summed over the stages.
    iterations, solves : int
        Step-solver iterations and stages.
    fields : np.ndarray or None, shape (1 + steps stages, shape of state)
        Unknown of the step solver at the start and after every stage: the initial guess of a march
        of the same path from a start near by.
    body : np.ndarray, shape (steps + 1, 2)
        Displacement x of a driven body ahead of the path, and its derivative x' by the phase; empty
        for models without drives.
    """

    state: np.ndarray
    forces: np.ndarray
    residual: float
    iterations: int
    solves: int
    fields: np.ndarray | None = None
    body: np.ndarray = field(default_factory=lambda: np.empty((0, 2)))


class Guess(Protocol):
    """Source of the initial guesses of a march: a March, or an object with the same `fields`."""

    @property
    def fields(self) -> np.ndarray | None:
        """See March."""


class StepFailure(SolverError):
    """A march cannot go on: tractions are not finite, or a step stays unsolved.  The message is the
    reason that a result gives."""


class Contact(Protocol):
    """A discretised contact under given pressure.

    A contact whose normal load may change also has at_indentation, bounds and bounds_along;
    one of rings may tell its edges, for rings to be gathered at one of them: see
    RadialContact.

    Attributes
    ----------
    angles : int
        Angular points of a ring; 1 for contacts without them.
    bound, weight : np.ndarray
        Friction bound and area of each point, broadcast to state[0].
    compliance : np.ndarray
        Displacement of a point under unit traction on itself, broadcast likewise.
    forward_position, lateral_position : np.ndarray
        Where the points are (units a), same shape.
    compiled : bool
        Whether compiled code searches for the periodic state: then it has a `system`.
    stiffness : float
        Force over mu F_z per uniform displacement u_lim without slip, at least.
    sticks : bool
        Whether points may stick, so that something is left of it in the static limit.
    grading : float or None
        Grading of the steps towards the turning points; None: that of the problem.
    edges : np.ndarray or None, shape (cells + 1,)
        Radii between the rings; None for contacts without rings.
    radius : float
        Largest contact radius over the reference radius, where the normal load changes.  `bound` is
        then that at the start of a period.  Contacts under constant load need no `radius`: it is 1.
    """

    angles: int
    bound: np.ndarray
    weight: np.ndarray
    compliance: np.ndarray
    forward_position: np.ndarray
    lateral_position: np.ndarray
    compiled: bool
    stiffness: float
    sticks: bool
    grading: float | None = None
    edges: np.ndarray | None = None

    def displacement(self, state: np.ndarray) -> np.ndarray:
        """A q: elastic displacement of each point, same shape as the state."""

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Tractions of a coarser contact at the points of this one; None if there is no way."""
        return None

    def mirrored(self, state: np.ndarray) -> np.ndarray:
        """The state after lateral -> -lateral (lateral traction negated)."""

    def march(
        self,
        path: Path,
        state: np.ndarray,
        tolerance: float,
        previous: Guess | None = None,
    ) -> March:
        """March along a path from a state; every stage is solved to `tolerance` (a force).

        previous: a March of the same path from a start near by, whose tractions are first guesses.
        """


class DirectContact(Contact, Protocol):
    """A contact that computes its periodic state directly, without a search."""

    def periodic_state(self, path: Path, mirror: bool) -> np.ndarray:
        """Tractions of the periodic state at the start of the path.

        mirror: whether the path is half a period, whose mirror image is the other half.
        """


class GrowingContact(Contact, Protocol):
    """A contact whose normal load may change."""

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Friction bounds at each depth, one a row."""

    def bounds_along(self, path: Path) -> np.ndarray:
        """Friction bounds at the start and at every stage of a path, one a row."""


def energy_norm(contact: Contact, change: np.ndarray) -> float:
    """Bound on the force (over mu F_z) that a change of tractions carries, from its energy:
    |dF| <= sqrt(stiffness <dq, A dq>)."""
    energy = np.vdot(contact.weight * change, contact.displacement(change))
    return float(np.sqrt(contact.stiffness * max(energy, 0.0)))


def full_slip(contact: Contact, forward: np.ndarray, lateral: np.ndarray) -> np.ndarray:
    """Tractions on the bound along the field (forward, lateral); zero field: no traction."""
    size = np.hypot(forward, lateral)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = np.where(size > 0, np.stack([forward, lateral]) / size, 0.0)
    return unit * contact.bound


def forward_slip(contact: Contact) -> np.ndarray:
    """Every point on its bound, forward: the state of a contact that only ever slid forward."""
    out = np.zeros((2, *contact.forward_position.shape))
    out[FORWARD] = contact.bound
    return out


def forces(contact: Contact, state: np.ndarray) -> np.ndarray:
    """Forward force, lateral force (mu F_z) and torque (mu F_z a) of tractions, shape (3,)."""
    forward, lateral = loads = contact.weight * state
    torque = np.vdot(contact.lateral_position, forward) - np.vdot(contact.forward_position, lateral)
    return np.array([*loads.sum(axis=(1, 2)), torque])
