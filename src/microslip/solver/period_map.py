"""The map of tractions over a (half) period, and the goal and the result of the search for its
fixed point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from microslip.models.contact import Contact
from microslip.models.path import Path

if TYPE_CHECKING:
    from microslip.states.search import Inertia

MOST_MARCHES = 200
"""Default limit on the number of marches in a search."""


class Goal(NamedTuple):
    """Goal of a search for the periodic state.

    Attributes
    ----------
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.
    most_marches : int
        Largest number of marches.
    near : bool
        Whether the initial state is near the periodic state.  In this case, the first steps are
        solved more accurately.
    """

    tolerance: float
    step_tolerance: float
    most_marches: int = MOST_MARCHES
    near: bool = False


@dataclass(frozen=True, eq=False)
class PeriodicState:
    """Result of a search for the periodic state.

    Attributes
    ----------
    forces : np.ndarray, shape (steps + 1, 3)
        Forces at the phases of the last (half) period.
    start : np.ndarray
        State at the beginning of the last (half) period.
    residual : float
        Upper bound on the change of the state by the plain map, as a force divided by mu F_z.
    distance : float
        Estimated distance from the fixed point, as a force divided by mu F_z.
    solver_residual : float
        Residual of the step solver summed over the stages of the last (half) period.
    marches : int
        Number of marches.
    iterations, solves : int
        Number of iterations of the step solver and number of stages, summed over all marches.
    converged : bool
        Whether the distance is within the tolerance.
    body : np.ndarray or None, shape (steps + 1, 2)
        x and x' of a driven body at the phases of the last (half) period; None without a drive.
    fields : np.ndarray or None
        contact.March.fields of the last (half) period, used as the initial guess for a march from
        `start`.
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
    """Data for the error estimate of slow motions, whose states change little in a period.

    If the plain map still changes the state by a force r, the velocity of the state has a relative
    error of r / `gain`.  Only the difference between the force and the static limit depends on the
    velocity.  So the error of the force is at most r / `gain` times this difference.

    Attributes
    ----------
    static_force : float
        Mean forward force of the static limit, divided by mu F_z; NaN if unknown.
    full : float
        Mean forward force in full slip, the largest possible force.
    gain : float
        Rise of the force in a (half) period for a contact without slip.
    least : float
        Mean forward force below which a state sticks and changes slowly.  It approximately equals
        the static limit.  NaN means that `static_force` is used.
    """

    static_force: float
    full: float
    gain: float
    least: float = np.nan


class PeriodMap:
    """The map of a contact's state over a path.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    path : path.Path
        Path over half a period, from turning point to turning point.  Without `mirror`, the path
        covers a whole period.
    drift_rate : DriftRate or None
        Data for slow motions, or None if the motion is not slow.
    mirror : bool
        Whether the other half of the period is the lateral mirror image of the path.
    """

    def __init__(
        self, contact: Contact, path: Path, drift_rate: DriftRate | None = None, mirror: bool = True
    ):
        self.contact, self.path, self.drift_rate, self.mirror = contact, path, drift_rate, mirror

    def image(self, state: np.ndarray) -> np.ndarray:
        """Convert the tractions at the end of an interval to those at the start of the next
        interval.

        The map is linear.
        """
        return self.contact.mirrored(state) if self.mirror else state

    def parts(self, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Split a state into tractions and (x, x') of a driven body; here (x, x') is (0, 0)."""
        return state, np.zeros(2)

    def state(self, tractions: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Build a state from tractions.  `place`, (x, x') of a driven body, is not used here."""
        return tractions

    def inertia(self) -> Inertia | None:
        """Extrapolation of the motion of a driven body; None without a driven body."""
        return None
