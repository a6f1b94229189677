"""Contact under a constant force: it stays at rest, moves at a mean velocity, or runs away.

Friction never decreases with the velocity (theory/bounds.py).  So the contact comes to rest under
every force that allows a state of rest.  A larger force moves the contact faster.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from microslip.contact.registry import MODELS
from microslip.foundation.errors import InputError
from microslip.motions.drive import Drive
from microslip.motions.motion import LOOP
from microslip.motions.problem import Problem
from microslip.theory import paper

RETURNED = 1e-12
"""A forward oscillation below this fraction of the amplitude is treated as a rounding error."""

CLOSEST_FORCE = 0.9999
"""Force divided by mu times the mean normal load.  From this force up to 1, no velocity is
computed.  With a transverse oscillation, runs converged up to 0.9998, where the contact already
advances by 200 amplitudes per period."""
CLOSEST_STEADY_FORCE = 1.0 - 1e-7
"""Largest force on a steady rotation, divided by mu times the mean normal load.  The rounding error
of the friction, 1.1e-16, causes a relative error of 1.1e-16 / (2 (1 - force)) in the velocity.  At
this force, the relative error is close to the stated 1e-9."""
FIRST_DRIFT, FACTOR = 0.1, 4.0
SLOWEST, FASTEST = 1e-6, 1e6
"""Search for the velocity: first drift per radian of phase, factor between two runs, and bounds."""
FLATTEST = 1e-6
"""Smallest accepted rise of friction between two runs, divided by the relative increase in
velocity."""
HALVINGS = 2
"""Number of bisections of the last velocity interval, on a logarithmic scale."""


def drive_of(problem: Problem) -> Drive:
    """Return the drive of a problem that has one."""
    assert problem.drive is not None
    return problem.drive


def force_of(problem: Problem) -> float:
    """Return the prescribed force of a problem that has one."""
    force = drive_of(problem).force
    assert force is not None
    return force


def without_forward_motion(problem: Problem) -> Problem:
    """The problem without the oscillation along the direction of the force.

    Under a constant force, the forward force on a contact without mass is constant.  Then the body
    follows the forward oscillation, which therefore has no effect.
    """
    return replace(problem, follows=True) if oscillates_forward(problem) else problem


def oscillates_forward(problem: Problem) -> bool:
    """Whether the oscillation has a forward component."""
    forward = problem.oscillation(LOOP)[0]
    return float(np.ptp(forward)) > RETURNED * max(problem.size, 1.0)


def oscillates(problem: Problem) -> bool:
    """Whether the motion or the normal load oscillates."""
    parts = problem.oscillation(LOOP)
    moves = max(float(np.ptp(part)) for part in parts) > RETURNED * max(problem.size, 1.0)
    return moves or (problem.depth is not None and problem.size > 0.0)


def is_even(problem: Problem) -> bool:
    """Whether the oscillation alone exerts no forward force at any time.

    In this case, the threshold of motion equals the static limit.
    """
    motion, pressure = problem.motion, problem.pressure
    if oscillates_forward(problem) or not motion.half_disc:
        return False
    if motion.rotates:
        return pressure.is_round or (pressure.mirrored and not motion.loads)
    return pressure.is_round or pressure.mirrored or problem.poisson == 0.0


def least_load(problem: Problem) -> float:
    """Smallest normal load in a period, divided by the mean normal load."""
    if not problem.motion.periodic or problem.depth is None:
        return 1.0
    loads = problem.pressure.total(np.asarray(problem.depth(LOOP), dtype=float))
    return max(float(loads.min()), 0.0) / problem.mean_load


def runs_away(problem: Problem) -> str:
    """Reason why the contact has no mean velocity; empty if it has one."""
    force = force_of(problem)
    if abs(force) >= 1.0:
        return f"runs away: the force {force:g} is at least full friction"
    least = least_load(problem)
    if drive_of(problem).mass == 0.0 and force >= least:
        return (
            f"runs away: without mass it slides off at the least normal load, {least:.3g} of the "
            "mean, which limits the friction"
        )
    return ""


def refuse_drive(problem: Problem, model: str) -> None:
    """Raise InputError if the model or the motion cannot be combined with the drive."""
    motion, drive = problem.motion, drive_of(problem)
    pulls = "stiffness" if drive.force is None else "force"
    if drive.force is not None and drive.force < 0.0 and not problem.propels:
        allowed = f"allowed is a number of at least 0: {motion.name} propels nothing"
        raise InputError("force", drive.force, allowed)
    if not MODELS[model].drivable:
        raise InputError("model", model, f"supports no {pulls}, only a prescribed velocity")
    if drive.force is not None:
        if not motion.periodic:
            refuse_steady(problem)
        refuse_nearly_full(problem)
    elif motion.periodic and problem.velocity == 0.0 and not is_even(problem):
        allowed = f"allowed is a number above 0 for {motion.name} with a spring"
        raise InputError("velocity", 0.0, allowed)


def refuse_nearly_full(problem: Problem) -> None:
    """Raise InputError if the force is too close to full friction to compute a velocity."""
    steady, force = not problem.motion.periodic, force_of(problem)
    closest = CLOSEST_STEADY_FORCE if steady else CLOSEST_FORCE
    if not closest <= abs(force) < 1.0 or runs_away(problem):
        return
    at_rest = problem if drive_of(problem).mass else without_forward_motion(problem)
    if not steady and not oscillates(at_rest):
        return
    allowed = (
        f"allowed is a force below {closest:.9g} (of mu times the mean normal load), or from 1 "
    )
    allowed += (
        "on, where the contact runs away; in between the velocity is too large to be computed"
    )
    raise InputError("force", force, allowed)


def refuse_steady(problem: Problem) -> None:
    """Raise InputError if the velocity of a steady motion under a force has no closed form."""
    if problem.motion.name != "continuous-bore" or not problem.pressure.is_round:
        force, place = force_of(problem), f"{problem.motion.name} under {problem.pressure.name}"
        raise InputError("force", force, f"allowed is none for {place}, which has no closed form")


def steady_velocity(problem: Problem) -> float:
    """Velocity of a steady rotation under a force, computed from Eqs 17 and 21 for 0 <= force < 1.

    The caller must check the problem with `refuse_steady` first.
    """
    from scipy.optimize import brentq  # imported here because it loads slowly

    from microslip.theory import axisymmetric

    pressure, force = problem.pressure, force_of(problem)

    def imbalance(velocity: float) -> float:
        if pressure.hertzian:
            return float(paper.bore_forward(velocity)) - force
        return float(axisymmetric.bore_of(pressure.bound, velocity)[0]) - force

    high = 1.0
    while imbalance(high) < 0.0 and high < FASTEST:
        high *= FACTOR
    return float(brentq(imbalance, 0.0, high, xtol=1e-14, rtol=1e-14)) if force > 0.0 else 0.0


class Near(NamedTuple):
    """An approximate point on the friction-velocity curve.

    Attributes
    ----------
    velocity : float
        Velocity, in the unit of the motion.
    slope : float
        Approximate derivative of the friction with respect to the velocity.
    """

    velocity: float
    slope: float


def velocity_near(problem: Problem, force: float, friction_at: Callable[[float], float]) -> Near:
    """Find the velocity at which the friction equals a force, to within a factor of about two.

    The search for the velocity under the force starts from this velocity.  This velocity also
    determines the time steps.

    Parameters
    ----------
    problem : problem.Problem
        The problem at a prescribed velocity.
    force : float
        Force divided by mu times the mean normal load.
    friction_at : callable
        `friction_at(velocity)` returns the mean forward force in the unit of `force`, or NaN if a
        run failed.
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
