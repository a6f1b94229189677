"""Units and lines of printed predictions."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

from microslip.foundation.number_text import EXACT_DIGITS, error_text, number_text

WIDTH = 18
"""Width of the name at the start of a line, in characters."""
PREFIXES = (
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("", 1.0),
    ("m", 1e-3),
    ("u", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
)
LENGTHS = (("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9), ("pm", 1e-12))
LEAST_LENGTH = 1e-2
"""Lengths in an answer have the largest unit in which u_lim is at least this number.  The contact
radius is a few hundred times larger, so its value is between 1 and a few thousand."""
LEAST_SPEED = 0.1
"""Speeds in an answer have the largest unit in which the highest speed is at least this number."""
NEWTONS = 1e-2, 1e4
"""Range of forces that are printed in a unit without a prefix, N."""
QUANTILES, FIRST_ORDER = "quantiles", "first order"
"""Methods of computing an interval.  QUANTILES solves the static friction for the draws.
FIRST_ORDER assumes that the static friction is linear in each input."""
EXCLUDED = 1e-3
"""Probability below which an outcome counts as excluded."""


def line(title: str, text: str) -> str:
    """Format a line with its title."""
    return f"{title:<{WIDTH - 1}} {text}"


def unit_for(value: float, units: tuple, least: float = 1.0) -> tuple[str, float]:
    """Select the largest unit (name, size) for which the value is at least `least`."""
    return next((one for one in units if abs(value) >= least * one[1]), units[-1])


def prefixed(value: float, base: str) -> tuple[str, float]:
    """The unit with the largest metric prefix that leaves the value at least 1.  For 0, the unit
    has no prefix."""
    prefix, size = unit_for(value or 1.0, PREFIXES)
    return f"{prefix}{base}", size


def prefixed_text(value: float, base: str, digits: int = EXACT_DIGITS) -> str:
    """Format an exact quantity with a metric prefix.  value: in the SI unit `base`."""
    name, size = prefixed(value, base)
    return number_text(value / size, unit=name, digits=digits)


def force_unit(newtons: float) -> tuple[str, float]:
    """The unit for all forces in an answer."""
    low, high = NEWTONS
    within = low <= abs(newtons) < high or not math.isfinite(newtons)
    return ("N", 1.0) if within else prefixed(newtons, "N")


def probability_text(chance: float, error: float) -> str:
    """Format a probability in per cent with its error, or as a bound if it is close to 0 or 1.

    A probability is close to 0 or 1 if the distance is below EXCLUDED or below the error.  The
    bound includes the error.
    """
    distance = min(chance, 1.0 - chance)
    if distance >= max(EXCLUDED, error):
        return number_text(100.0 * chance, 100.0 * error, "%")
    bound = error_text(100.0 * min(1.0, max(EXCLUDED, distance + error)))
    return f"below {bound} %" if chance < 0.5 else f"above {100 - Decimal(bound)} %"


def in_unit(value: float, error: float, unit: tuple[str, float]) -> str:
    """Format a quantity and its error in the unit (name, size).  Both values are in SI units."""
    name, size = unit
    return number_text(value / size, error / size, name)


def length_unit(u_lim: float) -> tuple[str, float]:
    """The unit for all lengths in an answer."""
    return unit_for(u_lim, LENGTHS, LEAST_LENGTH)


def speed_unit(speed: float, u_lim: float) -> tuple[str, float]:
    """The unit for all speeds in an answer.

    speed: largest speed, m/s; u_lim: replaces a speed that is 0 or not finite.
    """
    usual = speed and math.isfinite(speed)
    name, size = unit_for(speed, LENGTHS, LEAST_SPEED) if usual else length_unit(u_lim)
    return f"{name}/s", size


def not_converged(prediction: Any) -> list[str]:
    """Lines for all quantities whose error estimate is above the tolerance."""
    lines = []
    if not prediction.converged and prediction.outcome != "runs away":
        name = "mu_macro" if prediction.force_N is None else "speed"
        lines.append(f"NOT CONVERGED: {prediction.sought or name}: {prediction.reason}")
    if prediction.mu_static_reason:
        lines.append(f"NOT CONVERGED: static friction: {prediction.mu_static_reason}")
    return lines


def runs_away(prediction: Any) -> str:
    """A sentence about a contact that accelerates without limit."""
    if prediction.force < 1.0:
        return f"it {prediction.reason}"
    unit = force_unit(prediction.friction_force_still_N)
    still = in_unit(prediction.friction_force_still_N, 0.0, unit)
    return f"it runs away: friction holds at most {still}, mu times the load"
