"""The static limit for motions on a loop and for oscillating normal loads.

The limit is a separate problem at every point, see static_limit.py.  For a motion on a line, only
two instants of the period matter; here, all of them do.  Let q(t) be the periodic tractions of the
oscillation alone and g(t) the friction bound.  A constant traction s can be added if |q + s| <= g
at all times.  At a point that drifts forward, s has the largest forward component:

    mu F_z mu_static = Integral { mean of q_forward
                                  + max s_forward : |q(t) + s| <= g(t) for all t } dA.

At points that slip in every period of the oscillation alone, s is 0, since q reaches the bound in
directions that balance.  At these points, the mean of q remains: a loop without half-period
symmetry drags the contact along.  At points that never slip, q has an arbitrary constant part, and
the maximum does not depend on it.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from microslip.contact.contact import FORWARD, Contact
from microslip.contact.path import Path
from microslip.motions.problem import Problem
from microslip.solver.means import mean_forces
from microslip.solver.search import Goal, PeriodicState, PeriodMap, find_periodic_state
from microslip.solver.snapshots import bounds_at_phases, frames

SLOW_LOOP = 0.02
"""The stick zone of the static limit determines the state on a loop if the drift is below this
value, in u_lim per radian of phase."""
MARCHES, MOST_ROUNDS = 120, 3
"""Largest number of marches in a search for the periodic state, and largest number of searches.  An
accelerated search that stalls because of rounding errors is restarted."""
HALVINGS = 50
"""Number of bisections in the search for the largest shift, enough to reach the rounding error."""


class LoopLimit(NamedTuple):
    """The static limit of a contact, see the docstring of this module.

    Attributes
    ----------
    periodic : period_map.PeriodicState
        The periodic state of the oscillation alone.
    shift : np.ndarray, shape (2, ...)
        Shift s at every point.
    force : float
        Mean forward force, divided by mu F_z.
    solver_residual : float
        Residual of the step solver, as a force divided by mu F_z.  It is summed over two marches:
        the last march of the search and the march that computes the tractions.
    solves : int
        Number of stages in these two marches.
    """

    periodic: PeriodicState
    shift: np.ndarray
    force: float
    solver_residual: float
    solves: int


def loop_limit(
    contact: Contact, problem: Problem, path: Path, tolerance: float, step_tolerance: float
) -> LoopLimit:
    """Compute the static limit from the periodic state of the oscillation alone.

    Parameters
    ----------
    contact : contact.Contact
        The contact.
    problem : problem.Problem
        The problem at velocity 0.
    path : path.Path
        Path over a period, or half a period.
    tolerance, step_tolerance : float
        Tolerances of the state and of a step, as forces divided by mu F_z.

    Returns
    -------
    LoopLimit
        The limit; `periodic.converged` is False if the search failed.
    """
    mirror = problem.half_period_mirror
    period_map = PeriodMap(contact, path, mirror=mirror)
    shape = np.broadcast_shapes(contact.bound.shape, contact.lateral_position.shape)
    start = np.zeros((2, *shape))
    goal, rounds = Goal(tolerance, step_tolerance, MARCHES), []
    for _ in range(MOST_ROUNDS):
        periodic = find_periodic_state(period_map, start, goal)
        rounds.append(periodic)
        start = periodic.start
        if periodic.converged:
            break
    counts = ("marches", "iterations", "solves")
    periodic = replace(periodic, **{n: sum(getattr(one, n) for one in rounds) for n in counts})
    force = float(mean_forces(contact, problem, path, periodic.forces)[FORWARD])
    residual, solves = periodic.solver_residual, path.solves
    if not contact.sticks:
        return LoopLimit(periodic, np.zeros((2, *shape)), force, residual, solves)
    march = frames(contact, path, start, step_tolerance, periodic)
    residual, solves = residual + march.residual, solves + march.solves
    tractions = march.tractions
    bounds = np.broadcast_to(bounds_at_phases(contact, path), tractions[:, 0].shape)
    if mirror:
        bounds = np.concatenate([bounds, bounds])
        tractions = np.concatenate([tractions, [contact.mirrored(q) for q in tractions]])
    shift = largest_shift(tractions, bounds)
    force += float(np.sum(contact.weight * shift[FORWARD]))
    return LoopLimit(periodic, shift, force, residual, solves)


def largest_shift(tractions: np.ndarray, bounds: np.ndarray) -> np.ndarray:
    """Among the shifts s with |q + s| <= g at all phases, find the one with the largest forward
    component.

    The discs |q + s| <= g are convex, and so is their intersection.  The intersection contains
    s = 0 and therefore every forward shift below the largest one.

    Parameters
    ----------
    tractions : np.ndarray, shape (phases, 2, ...)
        Tractions q, forward component first.
    bounds : np.ndarray, shape (phases, ...) or broadcast to it
        Friction bounds g.  Tractions exceed them only by rounding errors.

    Returns
    -------
    np.ndarray, shape (2, ...)
        Shift s at every point.  Its lateral component is the middle of the allowed interval, or 0
        if the forward component is 0.
    """
    forward, lateral = tractions[:, 0], tractions[:, 1]
    bounds = np.maximum(bounds, np.hypot(forward, lateral))  # so that s = 0 is allowed
    least, most = np.zeros(forward.shape[1:]), 2.0 * bounds.min(axis=0)

    def reach(shift: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Whether a forward shift lies inside the discs of all phases, and bounds on the lateral
        shift."""
        across = bounds**2 - (forward + shift) ** 2
        width = np.sqrt(np.maximum(across, 0.0))
        ends = (-lateral - width).max(axis=0), (width - lateral).min(axis=0)
        return (across >= 0.0).all(axis=0), *ends

    for _ in range(HALVINGS):
        shift = 0.5 * (least + most)
        fits, low, high = reach(shift)
        fits &= low <= high
        least, most = np.where(fits, shift, least), np.where(fits, most, shift)
    _, low, high = reach(least)
    return np.array([least, np.where(least > 0.0, 0.5 * (low + high), 0.0)])
