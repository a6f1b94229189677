"""The static limit of a real contact, and the constant force from which on it moves."""

from __future__ import annotations

from typing import Any

from microslip.adaptive.point import Result, solve
from microslip.adaptive.under_force import (
    is_even,
    least_load,
    oscillates,
    oscillates_forward,
    without_forward_motion,
)
from microslip.estimate.estimate import Estimate
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealDrive, RealMotion, groups, solver_motion
from microslip.si.motions import COMBINED
from microslip.si.several import Carriers

TOLERANCE = 1e-3
"""Largest accepted error of mu_static, a ratio, under a force."""
TOLERANCE_OF_COMBINED = 1e-2
"""Smallest tolerance of mu_static where several oscillations meet: a smaller error takes more than
a minute."""


def static_limit(
    contact: TwoBodies,
    motion: RealMotion,
    carriers: Carriers,
    tolerance: float,
    *,
    under_force: bool,
) -> Result | None:
    """Friction at a vanishing speed over that without vibration; None for a steady motion.

    Parameters
    ----------
    contact, motion, carriers
        The contact, its motion, and how many contacts carry the body.
    tolerance : float
        Largest accepted error of the answer, as predict takes it.
    under_force : bool
        Whether a force is prescribed, for which this tolerance is relative to the speed.
    """
    _, size = groups(motion, contact)
    if size is None:
        return None
    if under_force:
        tolerance = min(tolerance, TOLERANCE)
    settings: dict[str, Any] = {
        "poisson": contact.poisson,
        "pressure": contact.pressure,
    } | carriers.settings
    return solve(
        solver_motion(motion, contact),
        0.0,
        size,
        tolerance=tolerance_of(motion, tolerance),
        **settings,
    )


def tolerance_of(motion: RealMotion, tolerance: float) -> float:
    """The tolerance of a static limit: as requested, except where several oscillations meet."""
    return max(tolerance, TOLERANCE_OF_COMBINED) if motion.name in COMBINED else tolerance


def equals_static_limit(
    contact: TwoBodies, motion: RealMotion, carriers: Carriers, mass: float | None
) -> bool | float | None:
    """The force threshold over mu F_z: True where it equals the static limit, else a number; None
    where it is not known.

    The threshold is the friction at vanishing speed where the oscillation exerts no forward force,
    or where the forces of several contacts cancel.  Otherwise a contact without mass moves along
    with the oscillation, and all of friction holds it if it does nothing else.
    """
    if motion.steady:
        return 0.0  # a steady spin turns all of friction aside
    problem = carriers.problem(motion, contact)
    if not oscillates_forward(problem) or is_even(problem):
        return True
    holds = not mass and not oscillates(without_forward_motion(problem))
    return 1.0 if holds else None


def force_threshold(
    contact: TwoBodies,
    motion: RealMotion,
    carriers: Carriers,
    drive: RealDrive,
    limit: Result | None,
) -> Estimate | None:
    """Smallest constant force that moves the contact, over mu F_z.

    None if it is unknown, or if it needs a solve of its own and no force is given.  A contact
    without mass follows the forward oscillation.  The threshold is then the static limit of the
    other components, computed here.

    limit: the static limit of the motion, None for a steady one.
    """
    share = equals_static_limit(contact, motion, carriers, drive.mass)
    if share is True:
        assert limit is not None  # as of all that oscillate
        return limit.friction
    if share is not None:
        return Estimate(share)
    held = without_forward_motion(carriers.problem(motion, contact))
    if drive.mass or drive.force is None or not is_even(held):
        return None
    return solve(held, tolerance=TOLERANCE).friction


def largest_force(
    contact: TwoBodies, motion: RealMotion, carriers: Carriers, mass: float | None
) -> float:
    """Constant force over mu F_z from which on the contact runs away.

    It is 1 with a mass; without one it is the least normal load in a period over the mean.
    """
    if mass or motion.steady:
        return 1.0
    return min(1.0, least_load(carriers.problem(motion, contact)))
