"""The static limit: friction of a forward motion that is infinitely slow.

Let +-q_osc be the tractions of the oscillation alone at its two turning points, after subtracting
their mean.  Let R be the constant part of the traction at a point.  As the forward velocity
vanishes, every point slips forward a little in each period when |R + q_osc| reaches the friction
bound g.  Such a slow drift does not change q_osc, and by the flow rule R solves the problem

    maximise  R . e_forward   subject to   |R + q_osc| <= g  and  |R - q_osc| <= g   at every point.

This is the counterpart of Melan's shakedown theorem for ratcheting.  Between the turning points,
the oscillating traction moves along the segment from -q_osc to q_osc, so only these two instants
matter.  For motions on a loop and for oscillating loads, see static_loop.py.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple, cast

import numpy as np

from microslip.contact.contact import Contact, DirectContact, full_slip, rigid_displacement
from microslip.contact.path import EULER, Path, make_path
from microslip.motions.problem import Problem

STEPS = 4
"""Number of steps from one turning point to the next.  Between turning points, the slip of each
point grows in a constant direction, so backward Euler gives the same tractions for any number of
steps.  A second-order method can end a step below the bound, and R depends on the square root of
the distance from the bound."""


def at_turning_points(problem: Problem) -> bool:
    """Whether the tractions at the turning points determine the static limit.

    This is the case for a motion on a line under a constant load.
    """
    return problem.straight and not problem.motion.loads


class StaticState(NamedTuple):
    """The static limit at the first turning point, see the docstring of this module.

    Attributes
    ----------
    residual, oscillating : np.ndarray
        Constant tractions R, and tractions q_osc at the first turning point; both have the shape of
        the contact's states.
    solver_residual : float
        Residual of the step solver summed over the steps, as a force divided by mu F_z.
    solves : int
        Number of steps.
    """

    residual: np.ndarray
    oscillating: np.ndarray
    solver_residual: float
    solves: int


@lru_cache(maxsize=32)
def _quarter(oscillation: Callable) -> Path:
    """The path from the mean position to the second turning point."""
    return make_path(oscillation, np.linspace(0.0, np.pi / 2, STEPS // 2 + 1), EULER)


def residual_part(oscillating: np.ndarray, bound: np.ndarray) -> np.ndarray:
    """Constant tractions R at every point; arrays of shape (2, ...), forward component first.

    The two discs |R +- q| <= g intersect in a lens.  R is the forward tip of one disc if the other
    disc contains it, otherwise the forward corner of the lens.
    """
    q_forward, q_lateral = oscillating
    size = np.hypot(q_forward, q_lateral)
    height = np.sqrt(np.maximum(bound**2 - size**2, 0.0))
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = np.where(size > 0.0, np.abs(q_lateral) / size, 1.0)
        turn = np.where(size > 0.0, -np.sign(q_lateral) * q_forward / size, 0.0)
    corner = height * np.stack([slope, turn])
    # only the disc whose centre is further back can have its tip inside the other disc
    ahead = np.abs(q_forward)
    tip = np.stack([bound - ahead, -np.sign(q_forward) * q_lateral])
    other = np.hypot(bound - 2.0 * ahead, 2.0 * q_lateral)
    residual = np.where(other <= bound, tip, corner)
    return np.where(size < bound, residual, 0.0)


def static_state(contact: Contact, oscillation: Callable, step_tolerance: float) -> StaticState:
    """Compute the StaticState of a contact.

    `oscillation(phase)` returns the rigid displacement without forward motion.  The first turning
    point is at the phase -pi/2.
    """
    start = np.zeros((2, *contact.lateral_position.shape))
    # by Masing's rule the first quarter period from a stress-free start ends on the closed loop, at
    # the second turning point; the tractions at the first one have the opposite sign
    march = contact.march(_quarter(oscillation), start, step_tolerance)
    residual = residual_part(-march.state, contact.bound)
    return StaticState(residual, -march.state, march.residual, march.solves)


def loop_energy(
    contact: Contact, oscillation: Callable, oscillating: np.ndarray | None = None
) -> float:
    """Energy that an oscillation on a line dissipates in a period, divided by mu F_z u_lim.

    Each slipping point slips in a constant direction.  By Masing's rule, it slips twice as far
    between the turning points as in the first loading.  So the energy is four times the friction
    bound times the slip of the first loading, summed over the points.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    oscillation : callable
        Rigid displacement at a phase, as in `static_state`.
    oscillating : np.ndarray or None
        Tractions of the oscillation at the first turning point, see StaticState.  None for a
        contact that never sticks; the tractions are then computed directly.
    """
    if oscillating is None:
        path = make_path(oscillation, np.pi * np.array([-0.5, 0.5, 1.5]), EULER)
        oscillating = cast(DirectContact, contact).periodic_state(path, mirror=False)
    place = np.array(oscillation(np.array(-0.5 * np.pi)), dtype=float)
    slip = rigid_displacement(contact, place) - contact.displacement(oscillating)
    return 4.0 * float(np.vdot(contact.weight * full_slip(contact, *oscillating), slip))
