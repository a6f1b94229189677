"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.
"""

from __future__ import annotations

import numpy as np

from microslip.solver import anderson, newton
from microslip.solver.period_map import PeriodicState, PeriodMap

MOST_MARCHES = 200


def find_periodic_state(
    period_map: PeriodMap,
    start: np.ndarray,
    tolerance: float,
    step_tolerance: float,
    most_marches: int = MOST_MARCHES,
    inverse: np.ndarray | None = None,
) -> PeriodicState:
    """March periods until the state repeats itself to the tolerance.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map over a (half) period.
    start : np.ndarray
        Tractions, of the shape of the contact's states.
    tolerance, step_tolerance : float
        Of the state and of a step, forces over mu F_z.
    most_marches : int
        Marches to try.
    inverse : np.ndarray or None, shape (start.size, start.size)
        That of a search from a start near by, if there was one.

    Returns
    -------
    period_map.PeriodicState
        Never raises for want of convergence: see `converged` there.
    """
    if period_map.contact.has_sensitivity:
        return newton.search(period_map, start, tolerance, step_tolerance, most_marches, inverse)
    return anderson.search(period_map, start, tolerance, step_tolerance, most_marches)
