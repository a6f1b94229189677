"""The static limit: what resists a forward motion infinitely slower than the oscillation.

Let +-q_osc be the tractions at the two turning points of the oscillation alone, their mean removed.
As the forward velocity vanishes, every point that still sticks at times has to drift forward by a
little in each period, at instants when |R + q_osc| reaches the bound, R being the constant part of
its traction.  Drift so slow does not change q_osc, and the flow rule makes R the best there is:

    maximise  R . e_forward   subject to   |R + q_osc| <= g  and  |R - q_osc| <= g   at every point,

a ratcheting counterpart of Melan's shakedown theorem.  In between the turning points q_osc runs
along the segment that joins them, so these two instants are the only ones that count.  Motions on
a loop, and a load that oscillates, are in static_loop.py.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.models.contact import Contact, March
from microslip.models.path import EULER, Path, make_path
from microslip.motions.problem import Problem

STEPS = 4
"""Steps from one turning point to the next.  Between them the slip of each point keeps its
direction and only grows, so that backward Euler steps of any size end in the same tractions.  (A
method of second order may end a step below the bound, and the residual feels the square root.)"""


def at_turning_points(problem: Problem) -> bool:
    """Whether the static limit follows from the turning points: motion on a line under a constant
    load."""
    return problem.straight and not problem.motion.loads


class StaticState(NamedTuple):
    """The static limit at the first turning point, see the docstring of this module.

    Attributes
    ----------
    residual, oscillating : np.ndarray
        Constant tractions R, and tractions q_osc; shape of the contact's states.
    solver_residual : float
        Sum over the steps of what the step solver left, a force over mu F_z.
    solves : int
        Number of these steps.
    """

    residual: np.ndarray
    oscillating: np.ndarray
    solver_residual: float
    solves: int


def oscillating_part(contact: Contact, oscillation: Callable, step_tolerance: float) -> np.ndarray:
    """Tractions at the first turning point under the oscillation alone, mean removed.

    oscillation(phase) -> rigid displacement without forward motion; the phase -pi/2 is the turning
    point meant.  Shape of the contact's states.
    """
    # by Masing's rule the first quarter from a stress-free start already ends on the closed loop,
    # and at the other turning point tractions are the same with the opposite sign
    return -_quarter_march(contact, oscillation, step_tolerance).state


def _quarter_march(contact: Contact, oscillation: Callable, step_tolerance: float) -> March:
    """The March from a stress-free start to the second turning point."""
    start = np.zeros((2, *contact.lateral_position.shape))
    return contact.march(_quarter(oscillation), start, step_tolerance)


@lru_cache(maxsize=32)
def _quarter(oscillation: Callable) -> Path:
    """The path from the mean position to the second turning point."""
    return make_path(oscillation, np.linspace(0.0, np.pi / 2, STEPS // 2 + 1), EULER)


def residual_part(oscillating: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """The constant tractions R, point by point; arrays (2, ...), forward component first.

    The two discs |R +- q| <= g intersect in a lens.  Its point furthest forward is the forward tip
    of one of the discs where the other contains it, else the forward corner of the lens.
    """
    q_forward, q_lateral = oscillating
    size = np.hypot(q_forward, q_lateral)
    height = np.sqrt(np.maximum(bound**2 - size**2, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = np.where(size > 0.0, np.abs(q_lateral) / size, 1.0)
        turn = np.where(size > 0.0, -np.sign(q_lateral) * q_forward / size, 0.0)
    corner = height * np.stack([slope, turn])
    # the disc whose centre lies behind has its tip inside the other one, if any has
    ahead = np.abs(q_forward)
    tip = np.stack([bound - ahead, -np.sign(q_forward) * q_lateral])
    other = np.hypot(bound - 2.0 * ahead, 2.0 * q_lateral)
    residual = np.where(other <= bound, tip, corner)
    return np.where(size < bound, residual, 0.0)


def static_state(contact: Contact, oscillation: Callable, step_tolerance: float) -> StaticState:
    """The StaticState of a contact; arguments as for `oscillating_part`."""
    march = _quarter_march(contact, oscillation, step_tolerance)
    residual = residual_part(-march.state, contact.bound)
    return StaticState(residual, -march.state, march.residual, march.solves)
