"""The steady state of a motion without oscillation, found by marching."""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import FORWARD, TORQUE, Contact, energy_norm, forward_slip
from microslip.contact.path import EULER, make_path
from microslip.motions.problem import Problem
from microslip.solver.effort import Effort
from microslip.solver.run import Run
from microslip.solver.tolerances import STEP_SHARE

STEADY_STRETCH = 8
"""Number of steps in a stretch.  The state is checked after each stretch."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""
MAX_STRETCHES = 200
"""Largest number of stretches."""


def steady_state(contact: Contact, problem: Problem, tolerance: float) -> Run:
    """March a steady motion until its tractions no longer change.

    Parameters
    ----------
    contact : contact.Contact
        The contact, in full forward slip at the start.
    problem : problem.Problem
        The steady motion; its velocity sets the length of a step.
    tolerance : float
        Tolerance of the state, as a force divided by mu F_z.

    Returns
    -------
    Run
        Forces and tractions at the end of the march, and the residual of the last stretch.  The run
        is not converged if the tractions still change after MAX_STRETCHES stretches.
    """
    step_tolerance = STEP_SHARE * tolerance
    step = STEADY_TRAVEL / max(1.0, problem.velocity)
    state, iterations, solves = forward_slip(contact), 0, 0
    previous = distance = np.inf
    for stretch in range(MAX_STRETCHES):
        phase = step * STEADY_STRETCH * stretch + step * np.arange(STEADY_STRETCH + 1)
        march = contact.march(make_path(problem.displacement, phase, EULER), state, step_tolerance)
        change = energy_norm(contact, march.state - state)
        state = march.state
        iterations += march.iterations
        solves += march.solves
        # the remaining changes are a geometric series
        if np.isfinite(previous):
            ratio = min(change / previous, 0.9) if previous > 0.0 else 0.0
            distance = change / (1.0 - ratio)
        previous = change
        if distance <= tolerance:
            break
    solved = march.residual <= march.solves * step_tolerance
    values = {
        "friction": float(march.forces[-1, FORWARD]),
        "torque": float(march.forces[-1, TORQUE]) / problem.pressure.torque,
    }
    return Run(
        values,
        distance=float(distance),
        residual=march.residual,
        effort=Effort.of(solves, iterations, state.size),
        reason="" if distance <= tolerance and solved else f"no steady state: {distance:.1e} left",
        state=state,
    )
