"""The steady state of a motion that does not oscillate: marched until its tractions stand still."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from microslip.models.contact import Contact, energy_norm, forward_slip
from microslip.models.path import EULER, make_path

STEADY_STRETCH = 8
"""Steps marched between two looks at whether a steady motion has reached its steady state."""
STEADY_TRAVEL = 0.5
"""Largest rigid displacement of a steady motion in one step, in u_lim."""
MAX_STRETCHES = 200


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The steady state that a steady motion reaches.

    Attributes
    ----------
    state : np.ndarray
        Tractions.
    forces : np.ndarray, shape (3,)
        Forward, lateral, torque.
    distance : float
        Estimated distance from the steady state, a force over mu F_z.
    solver_residual : float
        Residual force of the step solver over mu F_z, summed over the last stretch.
    stretches, iterations, solves : int
        Number of stretches marched, and the effort (see run.Run).
    converged : bool
        Whether the distance is within the tolerance and every step was solved.
    """

    state: np.ndarray
    forces: np.ndarray
    distance: float
    solver_residual: float
    stretches: int
    iterations: int
    solves: int
    converged: bool


def steady_state(
    contact: Contact,
    displacement: Callable,
    velocity: float,
    tolerance: float,
    step_tolerance: float,
) -> SteadyState:
    """March a steady motion until its tractions stand still.

    Parameters
    ----------
    contact : contact.Contact
        In full forward slip at the start.
    displacement : callable
        displacement(phase) -> (forward, lateral, angle).
    velocity : float
        Dimensionless, for the length of a step.
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, forces over mu F_z.

    Returns
    -------
    SteadyState
        Not converged where it does not settle in time.
    """
    step = STEADY_TRAVEL / max(1.0, velocity)
    state, iterations, solves = forward_slip(contact), 0, 0
    previous = distance = np.inf
    for stretch in range(1, MAX_STRETCHES + 1):
        phase = step * STEADY_STRETCH * (stretch - 1) + step * np.arange(STEADY_STRETCH + 1)
        march = contact.march(make_path(displacement, phase, EULER), state, step_tolerance)
        change = energy_norm(contact, march.state - state)
        state = march.state
        iterations += march.iterations
        solves += march.solves
        # the changes of a contraction fall geometrically; what is left is their tail
        if np.isfinite(previous):
            ratio = min(change / previous, 0.9) if previous > 0.0 else 0.0
            distance = change / (1.0 - ratio)
        previous = change
        if distance <= tolerance:
            break
    solved = march.residual <= march.solves * step_tolerance
    return SteadyState(
        state,
        march.forces[-1],
        distance,
        march.residual,
        stretch,
        iterations,
        solves,
        bool(distance <= tolerance and solved),
    )
