"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.
"""

from __future__ import annotations

from microslip import anderson, newton
from microslip.cycle import Cycle

MAX_PERIODS = 200


def find_periodic_state(
    contact,
    path,
    start,
    tolerance,
    step_tolerance,
    pace=None,
    inverse=None,
    max_periods=MAX_PERIODS,
):
    """March half periods until the state is periodic to ``tolerance`` (a force over mu F_z).

    contact: models.contact.Contact; path: half a period, from turning point to turning point, whose
    second half is its lateral mirror image; start: state, shape of the contact; pace: if the motion
    may be slow, see cycle.Pace; inverse: that of a search from a start near by, if there was one.
    The returned forces belong to a march from the returned start, whose distance from the periodic
    state is ``distance``.  Never raises for want of convergence: see ``converged``.
    """
    cycle = Cycle(contact, path, pace)
    if contact.has_sensitivity:
        return newton.search(cycle, start, tolerance, step_tolerance, max_periods, inverse)
    return anderson.search(cycle, start, tolerance, step_tolerance, max_periods)
