"""The map of tractions over one (half) period; goal and result of a search for its fixed point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from microslip.models.contact import Contact
from microslip.models.path import Path

if TYPE_CHECKING:
    from microslip.states.search import Inertia

MOST_MARCHES = 200
"""Largest number of marches in a search, by default."""


class Goal(NamedTuple):
    """Tolerances of a search for the periodic state, and its largest number of marches.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, forces over mu F_z.
    most_marches : int
        Marches to try.
    near : bool
        Whether the start is near the state, so that only well solved steps tell what is left.
    """

    tolerance: float
    step_tolerance: float
    most_marches: int = MOST_MARCHES
    near: bool = False


@dataclass(frozen=True, eq=False)
class PeriodicState:
    """Result of the search.

    Attributes
    ----------
    forces : np.ndarray, shape (steps + 1, 3)
        Over the last (half) period marched.
    start : np.ndarray
        Tractions at its beginning.
    residual : float
        What the plain map still changed, a bound on a force over mu F_z.
    distance : float
        Estimated distance from the fixed point, likewise.
    solver_residual : float
        Sum over the stages of the last period.
    marches : int
        Maps marched.
    iterations, solves : int
        Iterations and stages of the step solver, over all marches.
    converged : bool
        Whether the distance is within the tolerance.
    body : np.ndarray or None, shape (steps + 1, 2)
        x and x' of a driven contact over the last (half) period, see models.contact.March.
    fields : np.ndarray or None
        contact.March.fields of the last (half) period: the initial guess of a march from `start`.
    """

    forces: np.ndarray
    start: np.ndarray
    residual: float
    distance: float
    solver_residual: float
    marches: int
    iterations: int
    solves: int
    converged: bool
    body: np.ndarray | None = None
    fields: np.ndarray | None = None


@dataclass(frozen=True)
class DriftRate:
    """How slowly a state can go wrong.

    A state whose plain map still changes a share of the gain moves forward at a velocity wrong by
    that share, and as the force depends on the velocity only through its excess over the static
    limit, at most the same share of the excess is in doubt.

    Attributes
    ----------
    static_force : float
        Mean forward force of the static limit, over mu F_z; NaN where it is not known.
    full : float
        That of full slip, the largest that it can be.
    gain : float
        Force that a contact which does not slip gains in a march over a (half) period.
    least : float
        Mean forward force below which a state is stuck and changes slowly, roughly that of the
        static limit; NaN: that is `static_force`.
    """

    static_force: float
    full: float
    gain: float
    least: float = np.nan


class PeriodMap:
    """The map of a contact over a path.

    Parameters
    ----------
    contact : contact.Contact
        What is marched.
    path : path.Path
        Half a period, from turning point to turning point, whose second half is its lateral mirror
        image, or without `mirror` a whole one.
    drift_rate : DriftRate or None
        Given where the motion may be slow.
    mirror : bool
        See `path`.
    """

    def __init__(
        self, contact: Contact, path: Path, drift_rate: DriftRate | None = None, mirror: bool = True
    ):
        self.contact, self.path, self.drift_rate, self.mirror = contact, path, drift_rate, mirror

    def image(self, state: np.ndarray) -> np.ndarray:
        """Tractions at the start of the next interval, from those at the end of one; linear."""
        return self.contact.mirrored(state) if self.mirror else state

    def parts(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Tractions of a state, and x and x' of a driven body, 0 without one."""
        return state, np.zeros(2)

    def state(self, tractions: np.ndarray, place: np.ndarray) -> np.ndarray:
        """The state of tractions, and of x and x' of a driven body."""
        return tractions

    def inertia(self) -> Inertia | None:
        """No body is driven."""
        return None
