"""A contact that a force pulls: where it stays, where it runs away, and near which velocity it is.

Friction never falls with the velocity (theory/bounds.py), whatever pulls.  So a constant force at
which the contact could stay where it is, is one at which it comes to rest, and a force above one at
which it moves, moves it faster.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.motions.drive import Drive
from microslip.motions.motion import LOOP
from microslip.motions.problem import Problem
from microslip.theory import paper

RETURNED = 1e-12
"""Share of the amplitude below which a forward oscillation is rounding."""

CLOSEST_FORCE = 0.9999
"""Force from which on up to 1 no run finds a velocity: tried with transverse oscillation, runs are
solved up to 0.9998, where a period already takes the contact 200 amplitudes further."""
CLOSEST_STEADY_FORCE = 1.0 - 1e-7
"""Largest force on a steady rotation: rounding of its friction, 1.1e-16, moves the velocity by
1.1e-16 / (2 (1 - force)) of itself, which reaches the stated error (1e-9) here."""
FIRST_DRIFT, FACTOR = 0.1, 4.0
SLOWEST, FASTEST = 1e-6, 1e6
"""Drift in a radian at which the search for a velocity begins, what it is multiplied by from one
run to the next, and where it ends."""
FLATTEST = 1e-6
"""Smallest slope of friction taken from a pair of runs, over the relative rise of the velocity."""
HALVINGS = 2
"""Halvings of the last interval of velocities, on a logarithmic scale."""


def drive_of(problem: Problem) -> Drive:
    """The drive of a problem that has one."""
    assert problem.drive is not None
    return problem.drive


def force_of(problem: Problem) -> float:
    """The force of a problem that is under one."""
    force = drive_of(problem).force
    assert force is not None
    return force


def without_forward_motion(problem: Problem) -> Problem:
    """The problem, its contact not oscillating along the direction of the force.

    A constant force on a contact without mass keeps the forward force of the contact constant: the
    contact goes along with a forward oscillation, as if there were none.
    """
    return replace(problem, follows=True) if oscillates_forward(problem) else problem


def oscillates_forward(problem: Problem) -> bool:
    """Whether the oscillation alone moves the contact, or one of several, forward and back."""
    if problem.parts:
        return any(oscillates_forward(part.problem) for part in problem.parts)
    forward = problem.oscillation(LOOP)[0]
    return float(np.ptp(forward)) > RETURNED * max(problem.size, 1.0)


def oscillates(problem: Problem) -> bool:
    """Whether anything oscillates at all."""
    if problem.parts:
        return any(oscillates(part.problem) for part in problem.parts)
    parts = problem.oscillation(LOOP)
    moves = max(float(np.ptp(part)) for part in parts) > RETURNED * max(problem.size, 1.0)
    return moves or (problem.depth is not None and problem.size > 0.0)


def is_even(problem: Problem) -> bool:
    """Whether the oscillation alone exerts no forward force at any time.

    Then the contact does not tell a constant force from a velocity that vanishes, and moves from
    the static limit on.  So do several contacts on a body, each of which exerts none, or has an
    opposite that exerts the same force the other way.
    """
    if problem.parts:
        return all(is_even(part.problem) for part in problem.parts) or problem.is_balanced
    motion, pressure = problem.motion, problem.pressure
    if oscillates_forward(problem) or not motion.half_disc:
        return False
    if motion.rotates:
        return pressure.is_round or (pressure.mirrored and not motion.loads)
    return pressure.is_round or pressure.mirrored or problem.poisson == 0.0


def least_load(problem: Problem) -> float:
    """Least normal load in a period, over its mean."""
    if not problem.motion.periodic or problem.depth is None:
        return 1.0
    loads = problem.pressure.total(np.asarray(problem.depth(LOOP), dtype=float))
    if problem.parts:
        loads = np.array([part.share for part in problem.parts]) @ loads
    return max(float(loads.min()), 0.0) / problem.mean_load


def runs_away(problem: Problem) -> str:
    """Why there is no mean velocity, as one line; "" if there is one."""
    force = force_of(problem)
    if abs(force) >= 1.0:
        return f"runs away: the force {force:g} is all that friction can hold, or more"
    least = least_load(problem)
    if drive_of(problem).mass == 0.0 and force >= least:
        return (
            f"runs away: without mass it slides off where the normal load is least, {least:.3g} of "
            "its mean, and friction holds no more than that"
        )
    return ""


def refuse_nearly_full(problem: Problem) -> None:
    """Raise InputError for a force so close to full friction that no velocity can be computed."""
    steady, force = not problem.motion.periodic, force_of(problem)
    closest = CLOSEST_STEADY_FORCE if steady else CLOSEST_FORCE
    if not closest <= abs(force) < 1.0 or runs_away(problem):
        return
    held = problem if drive_of(problem).mass else without_forward_motion(problem)
    if not steady and not oscillates(held):
        return
    allowed = (
        f"allowed is a force below {closest:.9g} (of mu times the mean normal load), or from 1 "
    )
    allowed += (
        "on, where the contact runs away; in between the velocity is too large to be computed"
    )
    raise InputError("force", force, allowed)


def refuse_steady(problem: Problem) -> None:
    """Raise InputError where the velocity of a steady motion under a force has no closed form."""
    if problem.motion.name != "continuous-bore" or not problem.pressure.is_round:
        force, place = force_of(problem), f"{problem.motion.name} under {problem.pressure.name}"
        raise InputError("force", force, f"allowed is none for {place}, which has no closed form")


def steady_velocity(problem: Problem) -> float:
    """Velocity of a steady rotation under its force, 0 to below 1, from Eqs 17 and 21; it is for
    the caller to `refuse_steady` before."""
    from scipy.optimize import brentq  # only now: these take a while to load

    from microslip.theory import axisymmetric

    pressure, force = problem.pressure, force_of(problem)

    def left(velocity: float) -> float:
        if pressure.hertzian:
            return float(paper.bore_forward(velocity)) - force
        return float(axisymmetric.bore_of(pressure.bound, velocity)[0]) - force

    high = 1.0
    while left(high) < 0.0 and high < FASTEST:
        high *= FACTOR
    return float(brentq(left, 0.0, high, xtol=1e-14, rtol=1e-14)) if force > 0.0 else 0.0


class Near(NamedTuple):
    """A place on the curve of friction over velocity.

    Attributes
    ----------
    velocity : float
        In the unit of the motion.
    slope : float
        About how much friction rises there with the velocity.
    """

    velocity: float
    slope: float


def velocity_near(problem: Problem, force: float, friction_at: Callable[[float], float]) -> Near:
    """Velocity at which a contact that is moved resists with a force, to a factor of about two.

    It is where the search for a contact that is pulled begins, and what its path is cut into steps
    for: no answer depends on it but by its error.

    Parameters
    ----------
    problem : problem.Problem
        What is moved.
    force : float
        Over mu times the mean normal load.
    friction_at : callable
        friction_at(velocity) -> mean forward force likewise, NaN where there is none.
    """
    unit = problem.unit_drift

    @cache
    def at(drift: float) -> float:
        return friction_at(drift / unit)

    low, high = FIRST_DRIFT / FACTOR, FIRST_DRIFT
    while high < FASTEST and at(high) < force:
        low, high = high, FACTOR * high
    while low > SLOWEST and at(low) > force:
        low, high = low / FACTOR, low
    slope = (at(high) - at(low)) / (high - low) * unit
    for _ in range(HALVINGS):
        middle = float(np.sqrt(low * high))
        if at(middle) < force:
            low = middle
        else:
            high = middle
    return Near(float(np.sqrt(low * high)) / unit, max(slope, FLATTEST / high * unit))
