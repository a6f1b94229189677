"""The static limit of a real contact, and the smallest constant force that moves it."""

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
from microslip.si.request import Request

TOLERANCE = 1e-3
"""Largest accepted error of mu_static under a force, dimensionless."""
TOLERANCE_OF_COMBINED = 1e-2
"""Smallest tolerance of mu_static for a motion with several oscillations, dimensionless.  Smaller
errors take more than a minute."""


def static_limit(request: Request) -> Result | None:
    """mu_macro in the limit of vanishing speed; None for a steady motion."""
    if request.motion.steady:
        return None
    tolerance = request.tolerance
    if request.drive.force is not None:  # request.tolerance applies to the speed here
        tolerance = min(tolerance, TOLERANCE)
    return request.solve(0.0, tolerance_of(request, tolerance))


def tolerance_of(request: Request, tolerance: float) -> float:
    """The tolerance of a static limit.  It is larger for a motion with several oscillations."""
    return max(tolerance, TOLERANCE_OF_COMBINED) if request.motion.several else tolerance


def equals_static_limit(request: Request) -> bool | float | None:
    """Return True if the force threshold equals the static limit, else the value of the threshold.

    The threshold equals the static limit if the oscillation exerts no forward force.  Otherwise, a
    contact without mass follows the forward oscillation.  If there is no other oscillation, the
    threshold is mu F_z.

    Returns
    -------
    bool, float or None
        True if the two are equal.  Otherwise, the threshold divided by mu F_z, or None if it is
        unknown.
    """
    if request.motion.steady:
        return 0.0  # under a steady spin any force moves the contact
    problem = request.problem()
    if not oscillates_forward(problem) or is_even(problem):
        return True
    holds = not request.drive.mass and not oscillates(without_forward_motion(problem))
    return 1.0 if holds else None


def force_threshold(request: Request, limit: Result | None) -> Estimate | None:
    """Smallest constant force that moves the contact, divided by mu F_z.

    A contact without mass follows the forward oscillation.  The contact's threshold is the static
    limit of the other components.  This limit is needed, and thus computed, only if a force is
    prescribed.

    Parameters
    ----------
    request : Request
        The request.
    limit : Result or None
        The static limit of the motion; None for a steady motion.

    Returns
    -------
    Estimate or None
        The threshold; None if it is unknown or was not computed.
    """
    share = equals_static_limit(request)
    if share is True:
        assert limit is not None  # the motion oscillates
        return limit.friction
    if share is not None:
        return Estimate(share)
    held = without_forward_motion(request.problem())
    if request.drive.mass or request.drive.force is None or not is_even(held):
        return None
    return solve(held, tolerance=TOLERANCE).friction


def largest_force(request: Request) -> float:
    """Smallest constant force under which the contact runs away, divided by mu F_z.

    It is 1 for a body with a mass.  Otherwise it is the smallest normal load in a period divided by
    the mean load.
    """
    if request.drive.mass or request.motion.steady:
        return 1.0
    return min(1.0, least_load(request.problem()))
