"""The static limit of a real contact, and the constant force from which on it moves."""

from __future__ import annotations

from microslip.adaptive.point import Result, solve
from microslip.adaptive.under_force import (
    is_even,
    least_load,
    oscillates,
    oscillates_forward,
    without_forward_motion,
)
from microslip.estimate.estimate import Estimate
from microslip.si.motions import COMBINED
from microslip.si.request import Request

TOLERANCE = 1e-3
"""Largest accepted error of mu_static, a ratio, under a force."""
TOLERANCE_OF_COMBINED = 1e-2
"""Smallest tolerance of mu_static where several oscillations meet: a smaller error takes more than
a minute."""


def static_limit(request: Request) -> Result | None:
    """Friction at a vanishing speed over that without vibration; None for a steady motion."""
    if request.motion.steady:
        return None
    tolerance = request.tolerance
    if request.drive.force is not None:  # for which the tolerance is relative to the speed
        tolerance = min(tolerance, TOLERANCE)
    return request.solve(0.0, tolerance_of(request, tolerance))


def tolerance_of(request: Request, tolerance: float) -> float:
    """The tolerance of a static limit: as requested, except where several oscillations meet."""
    combined = request.motion.name in COMBINED
    return max(tolerance, TOLERANCE_OF_COMBINED) if combined else tolerance


def equals_static_limit(request: Request) -> bool | float | None:
    """The force threshold over mu F_z: True where it equals the static limit, else a number; None
    where it is not known.

    The threshold is the friction at vanishing speed where the oscillation exerts no forward force,
    or where the forces of several contacts cancel.  Otherwise a contact without mass moves along
    with the oscillation, and all of friction holds it if it does nothing else.
    """
    if request.motion.steady:
        return 0.0  # a steady spin turns all of friction aside
    problem = request.problem()
    if not oscillates_forward(problem) or is_even(problem):
        return True
    holds = not request.drive.mass and not oscillates(without_forward_motion(problem))
    return 1.0 if holds else None


def force_threshold(request: Request, limit: Result | None) -> Estimate | None:
    """Smallest constant force that moves the contact, over mu F_z.

    None if it is unknown, or if it needs a solve of its own and no force is given.  A contact
    without mass follows the forward oscillation.  The threshold is then the static limit of the
    other components, computed here.

    limit: the static limit of the motion, None for a steady one.
    """
    share = equals_static_limit(request)
    if share is True:
        assert limit is not None  # as of all that oscillate
        return limit.friction
    if share is not None:
        return Estimate(share)
    held = without_forward_motion(request.problem())
    if request.drive.mass or request.drive.force is None or not is_even(held):
        return None
    return solve(held, tolerance=TOLERANCE).friction


def largest_force(request: Request) -> float:
    """Constant force over mu F_z from which on the contact runs away.

    It is 1 with a mass; without one it is the least normal load in a period over the mean.
    """
    if request.drive.mass or request.motion.steady:
        return 1.0
    return min(1.0, least_load(request.problem()))
