"""The solver asked for a motion in SI units, and for the amplitude that takes friction away."""

from __future__ import annotations

import math
from dataclasses import replace

from microslip.adaptive.point import Result, solve
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion, groups, solver_scene

LARGEST_AMPLITUDE = 1e4
"""Dimensionless amplitude beyond which no smaller friction is looked for."""
SMALLEST_AMPLITUDE = 1e-6
"""Dimensionless amplitude, nearly, below which no larger friction is looked for."""


class _NoAnswerError(Exception):
    """The solver has no number at an amplitude; its reason is found again there."""


def friction_of(
    contact: TwoBodies, motion: RealMotion, tolerance: float, **contacts: str
) -> Result:
    """What microslip.solve says of a motion; contacts: what it is told of several, if anything."""
    velocity, size = groups(motion, contact)
    fast = min(velocity, LARGEST["velocity"])  # beyond, the vibration does nothing
    settings = {"poisson": contact.poisson, "pressure": contact.pressure, "tolerance": tolerance}
    return solve(solver_scene(motion, contact), fast, size, **settings, **contacts)


def motion_for(
    contact: TwoBodies, motion: RealMotion, *, share: float, tolerance: float, given: object
) -> RealMotion:
    """The motion with the least amplitude that takes a share of friction away.

    Parameters
    ----------
    motion : RealMotion
        Without its amplitude.
    share, tolerance : float
        The share, 0 to 1, and the accepted error of mu_macro, dimensionless.
    given : object
        The share as it was given, for messages.

    Returns
    -------
    RealMotion
        Where the solver has no answer on the way, the motion that it has none for: so its reason
        is told.

    Raises
    ------
    InputError
        Where no amplitude, or every one, takes that much friction away.
    """
    from scipy.optimize import brentq

    if share < tolerance:
        raise InputError("reduction", given, f"allowed is at least the tolerance, {tolerance:g}")
    last = motion

    def missing(log_amplitude):
        nonlocal last
        last = replace(motion, amplitude=math.exp(log_amplitude))
        answer = friction_of(contact, last, tolerance)
        found = answer.mu_macro
        if not math.isfinite(found):
            raise _NoAnswerError
        if motion.speed == 0.0 and found <= answer.mu_macro_error:
            found = 0.0  # of static friction nothing is left, which no run says to the last digit
        return found - (1.0 - share)

    unit = contact.u_lim / (contact.contact_radius if motion.scene == "bore" else 1.0)
    low, high = math.log(SMALLEST_AMPLITUDE * unit), math.log(unit)
    slides = "the one that lets the contact slide"
    try:
        if missing(low) < 0.0:
            problem = f"the smallest amplitude tried, {SMALLEST_AMPLITUDE:g} times {slides}, takes"
            raise InputError("reduction", given, f"{problem} more away at this speed")
        while missing(high) > 0.0:
            high += math.log(2.0)
            if high > math.log(LARGEST_AMPLITUDE * unit):
                problem = f"no amplitude up to {LARGEST_AMPLITUDE:g} times {slides} takes"
                raise InputError("reduction", given, f"{problem} that much friction away")
        least = brentq(missing, low, high, xtol=0.1 * tolerance)
    except _NoAnswerError:
        return last
    return replace(motion, amplitude=math.exp(least))
