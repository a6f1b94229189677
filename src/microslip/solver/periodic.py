"""The periodic state: a fixed point of "march one (half) period", found without waiting for it.

The plain march forgets its start only after about 1/(2 pi v~) periods.  Here the map of the
tractions over one period is solved for its fixed point: by Newton's method where the model gives
the derivative of its march, else by Anderson acceleration.
"""

from __future__ import annotations

from microslip.solver import anderson, newton

MOST_LAPS = 200


def find_periodic_state(cycle, start, tolerance, step_tolerance, most_laps=MOST_LAPS, inverse=None):
    """March half periods until the state is periodic to ``tolerance`` (a force over mu F_z).

    cycle: cycle.Cycle, the map over half a period; start: state, shape of the contact; inverse:
    that of a search from a start near by, if there was one.  The returned forces belong to a march
    from the returned start, whose distance from the periodic state is ``distance``.  Never raises
    for want of convergence: see ``converged``.
    """
    if cycle.contact.has_sensitivity:
        return newton.search(cycle, start, tolerance, step_tolerance, most_laps, inverse)
    return anderson.search(cycle, start, tolerance, step_tolerance, most_laps)
