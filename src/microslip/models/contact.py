"""Interface of the models: a discretised contact, and the result of a march."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from microslip.foundation.errors import SolverError
from microslip.models.path import Path

FORWARD, LATERAL, TORQUE = range(3)
"""Columns of the forces of a march."""

MIRROR = np.array([1.0, -1.0])[:, None, None]
"""Signs of forward and lateral tractions under the mirror lateral -> -lateral, shape (2, 1, 1)."""


@dataclass(frozen=True, eq=False)
class March:
    """The result of one march along a path.

    Attributes
    ----------
    state : np.ndarray, shape (2, n_angles, n_radii) or (2, n, n)
        Forward and lateral tractions at the end of the path.
    forces : np.ndarray, shape (steps + 1, 3)
        Forward force, lateral force, torque at each phase, over mu F_z and mu F_z a.
    residual : float
        Residual force of the step solver over mu F_z, summed over the stages.
    iterations, solves : int
        Step-solver iterations and stages.
    fields : np.ndarray or None, shape (1 + steps stages, shape of state)
        Unknown of the step solver at the start and after every stage.  It is the initial guess of a
        march along the same path from a similar state.
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
    """Source of initial guesses for a march: a March, or another object with `fields`."""

    @property
    def fields(self) -> np.ndarray | None:
        """See March."""


class StepFailure(SolverError):
    """Error of a march whose tractions are not finite, or whose step cannot be solved.

    The message becomes the reason in the result.
    """


class Contact(Protocol):
    """A discretised contact under a pressure.

    A contact whose normal load can change also has `at_indentation`, `bounds` and `bounds_along`
    (see RadialContact).

    Attributes
    ----------
    angles : int
        Number of angular points of a ring; 1 for contacts without them.
    bound, weight : np.ndarray
        Friction bound and area of each point; they broadcast to state[0].
    compliance : np.ndarray
        Displacement of each point under a unit traction on itself; broadcasts to state[0].
    forward_position, lateral_position : np.ndarray
        Coordinates of the points over a, with the shape of state[0].
    compiled : bool
        Whether compiled code searches for the periodic state.  The contact then has a `system`.
    stiffness : float
        Force over mu F_z for a uniform displacement u_lim without slip, or an upper bound on it.
    sticks : bool
        Whether points can stick, so that the static limit of friction is not 0.
    grading : float or None
        Grading of the steps towards the turning points; None for that of the problem.
    edges : np.ndarray or None, shape (cells + 1,)
        Radii between the rings; None for contacts without rings.
    radius : float
        Largest contact radius over the reference radius, if the normal load changes.  `bound` is
        then the friction bound at the start of a period.
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
        """Elastic displacement A q of each point under tractions q, with the shape of the state."""

    def prolonged(self, state: np.ndarray) -> np.ndarray | None:
        """Interpolate tractions of a coarser contact to the points of this one; None if
        impossible."""
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
        """March along a path.

        Parameters
        ----------
        path : Path
            The motion, cut into steps.
        state : np.ndarray
            Tractions at the start.
        tolerance : float
            Largest residual of every stage, a force over mu F_z.
        previous : Guess or None
            March along the same path from a similar state, for initial guesses.
        """


class DirectContact(Contact, Protocol):
    """A contact that computes its periodic state directly, without a search."""

    def periodic_state(self, path: Path, mirror: bool) -> np.ndarray:
        """Tractions of the periodic state at the start of the path.

        mirror: whether the path is half a period, and the other half is its mirror image.
        """


class GrowingContact(Contact, Protocol):
    """A contact whose normal load can change."""

    def bounds(self, depths: np.ndarray) -> np.ndarray:
        """Friction bounds at depths (n,), one row for each."""

    def bounds_along(self, path: Path) -> np.ndarray:
        """Friction bounds at the start and at every stage of a path, one row for each."""


def energy_norm(contact: Contact, change: np.ndarray) -> float:
    """Upper bound on the force (over mu F_z) of a change of tractions, from its elastic energy:
    |dF| <= sqrt(stiffness <dq, A dq>)."""
    energy = np.vdot(contact.weight * change, contact.displacement(change))
    return float(np.sqrt(contact.stiffness * max(energy, 0.0)))


def full_slip(contact: Contact, forward: np.ndarray, lateral: np.ndarray) -> np.ndarray:
    """Tractions on the friction bound in the direction of a field; 0 where the field is 0."""
    size = np.hypot(forward, lateral)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = np.where(size > 0, np.stack([forward, lateral]) / size, 0.0)
    return unit * contact.bound


def forward_slip(contact: Contact) -> np.ndarray:
    """Forward tractions on the friction bound: the state after sliding forward only."""
    out = np.zeros((2, *contact.forward_position.shape))
    out[FORWARD] = contact.bound
    return out


def forces(contact: Contact, state: np.ndarray) -> np.ndarray:
    """Forward force, lateral force (mu F_z) and torque (mu F_z a) of tractions, shape (3,)."""
    forward, lateral = loads = contact.weight * state
    torque = np.vdot(contact.lateral_position, forward) - np.vdot(contact.forward_position, lateral)
    return np.array([*loads.sum(axis=(1, 2)), torque])
