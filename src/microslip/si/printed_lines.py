"""Units and lines of the answers about real contacts."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

from microslip.foundation.number_text import error_text, number_text

WIDTH = 18
"""Columns of the name in front of a line."""
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
"""Smallest number that u_lim may be in the unit of all lengths of an answer: the contact radius,
which is some hundred times larger, is then a number from 1 to a few thousands."""
NEWTONS = 1e-2, 1e4
"""Forces between which the unit is N, without a prefix."""
REFERENCE_LOADS_OF_DRIVING = (
    "u_lim and the contact radius are those of the load without oscillation (the reference load); "
    "forces and powers follow from mu times the mean load"
)
"""Sentence beside a propulsion line where the normal load oscillates."""
QUANTILES, FIRST_ORDER = "quantiles", "first order"
"""How an interval follows from the uncertain inputs: of draws, whose static friction is solved for,
or of a static friction that is linear in each input."""
EXCLUDED = 1e-3
"""Probability below which an outcome is as good as excluded."""


def line(title: str, text: str) -> str:
    """A line of the answer."""
    return f"{title:<{WIDTH - 1}} {text}"


def unit_for(value: float, units: tuple, least: float = 1.0) -> tuple[str, float]:
    """The largest of some units, (name, size), in which a value is at least `least`."""
    return next((one for one in units if abs(value) >= least * one[1]), units[-1])


def prefixed(value: float, base: str, least: float = 1.0) -> tuple[str, float]:
    """The unit with a prefix in which a value is at least `least`, or without one for 0."""
    prefix, size = unit_for(value or 1.0, PREFIXES, least)
    return f"{prefix}{base}", size


def force_unit(newtons: float) -> tuple[str, float]:
    """The unit of all forces of an answer."""
    low, high = NEWTONS
    within = low <= abs(newtons) < high or not math.isfinite(newtons)
    return ("N", 1.0) if within else prefixed(newtons, "N")


def probability_text(chance: float, error: float) -> str:
    """A probability in percent with its error; a bound where it is close to 0 or 1.

    It is close if its distance is below EXCLUDED or its error; the bound includes the error.
    """
    distance = min(chance, 1.0 - chance)
    if distance >= max(EXCLUDED, error):
        return number_text(100.0 * chance, 100.0 * error, "%")
    bound = error_text(100.0 * min(1.0, max(EXCLUDED, distance + error)))
    return f"below {bound} %" if chance < 0.5 else f"above {100 - Decimal(bound)} %"


def in_unit(value: float, error: float, unit: tuple[str, float]) -> str:
    """A quantity and its error, both in SI units, in a unit (name, size)."""
    name, size = unit
    return number_text(value / size, error / size, name)


def length_unit(u_lim: float) -> tuple[str, float]:
    """The unit of all lengths of an answer."""
    return unit_for(u_lim, LENGTHS, LEAST_LENGTH)


def not_converged(found: Any) -> list[str]:
    """Lines for every quantity whose error is larger than its tolerance."""
    lines = []
    if not found.converged and found.outcome != "runs away":
        name = "mu_macro" if found.force_N is None else "speed"
        reason = found.vibration_power_reason
        name = "vibration power" if reason else found.sought or name
        lines.append(f"NOT CONVERGED: {name}: {reason or found.reason}")
    if found.mu_static_reason:
        lines.append(f"NOT CONVERGED: static friction: {found.mu_static_reason}")
    return lines


def runs_away(found: Any) -> str:
    """Sentence about a contact that accelerates without end."""
    if found.force < 1.0:
        return f"it {found.reason}"
    unit = force_unit(found.friction_force_still_N)
    still = in_unit(found.friction_force_still_N, 0.0, unit)
    return f"it runs away: friction holds no more than {still}, mu times the load"
