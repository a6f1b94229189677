"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.
"""

from __future__ import annotations

import numpy as np

from microslip.solver import anderson, newton
from microslip.solver.period_map import Goal, PeriodicState, PeriodMap


def find_periodic_state(period_map: PeriodMap, start: np.ndarray, goal: Goal) -> PeriodicState:
    """March periods until the state repeats itself to the tolerance.

    Parameters
    ----------
    period_map : period_map.PeriodMap
        The map over a (half) period.
    start : np.ndarray
        Tractions, of the shape of the contact's states.
    goal : period_map.Goal
        What to reach.

    Returns
    -------
    period_map.PeriodicState
        Never raises for want of convergence: see `converged` there.
    """
    find = newton.search if period_map.contact.has_sensitivity else anderson.search
    return find(period_map, start, goal)
