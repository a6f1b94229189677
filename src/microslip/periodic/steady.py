"""The steady state of a motion without oscillation, the fixed point of a march over any stretch."""

from __future__ import annotations

import numpy as np

from microslip.contact.contact import FORWARD, TORQUE, Contact, forward_slip
from microslip.contact.path import EULER, make_path
from microslip.periodic.budget import Effort
from microslip.periodic.run import STEP_SHARE, Run, unsolved
from microslip.periodic.search import Goal, PeriodMap, find_periodic_state
from microslip.scene.problem import Problem

STEADY_STRETCH = 8
"""Number of steps in a stretch."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""


def steady_state(contact: Contact, problem: Problem, tolerance: float) -> Run:
    """Find the steady state of a motion without oscillation.

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
        Forces and tractions of the steady state.
    """
    step = STEADY_TRAVEL / max(1.0, problem.velocity)
    path = make_path(problem.displacement, step * np.arange(STEADY_STRETCH + 1.0), EULER)
    goal = Goal(tolerance, STEP_SHARE * tolerance)
    steady = find_periodic_state(
        PeriodMap(contact, path, mirror=False), forward_slip(contact), goal
    )
    march = steady.march
    reason = unsolved(march.residual, march.solves, goal.step_tolerance)
    return Run(
        {
            "friction": float(march.forces[-1, FORWARD]),
            "torque": float(march.forces[-1, TORQUE]) / problem.pressure.torque,
        },
        distance=steady.distance,
        residual=march.residual,
        effort=Effort.of(steady.solves, steady.iterations, steady.start.size),
        reason=reason if steady.converged else f"no steady state: {steady.distance:.1e} left",
        state=march.state,
    )
