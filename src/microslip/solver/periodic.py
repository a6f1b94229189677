"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.
"""

from __future__ import annotations

import numpy as np

from microslip.solver import anderson, newton
from microslip.solver.period_map import Cycle, PeriodicState

MOST_LAPS = 200


def find_periodic_state(
    cycle: Cycle,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_laps: int = MOST_LAPS,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """March periods until the state repeats itself to the tolerance.

    Parameters
    ----------
    cycle : period_map.Cycle
        The map over a (half) period.
    start : np.ndarray
        Tractions, of the shape of the contact's states.
    tolerance, step_tolerance : float
        Of the state and of a step, forces over mu F_z.
    most_laps : int
        Marches to try.
    inverse : np.ndarray or None, shape (start.size, start.size)
        That of a search from a start near by, if there was one.

    Returns
    -------
    period_map.PeriodicState
        Never raises for want of convergence: see `converged` there.
    """
    if cycle.contact.has_sensitivity:
        return newton.search(cycle, start, tolerance, step_tolerance, most_laps, inverse)
    return anderson.search(cycle, start, tolerance, step_tolerance, most_laps)
