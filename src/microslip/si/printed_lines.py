"""Units and lines of the answers about real contacts."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import Any

from microslip.foundation.number_text import error_text, interval_text, number_text
from microslip.si.motions import unit_of_amplitude

WIDTH = 18
"""Columns of the name in front of a line."""
TIMES = (
    *(("years", 365.25 * 86400.0), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)),
    *(("s", 1.0), ("ms", 1e-3), ("us", 1e-6)),
)
PREFIXES = (("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("u", 1e-6), ("n", 1e-9), ("p", 1e-12))
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
REFERENCE_LOADS = (
    "stiffness, mass and damping are over mu times the load without oscillation (the reference "
    "load); force and mu_macro are over mu times the mean load"
)
"""Sentence beside groups of a drive where the normal load oscillates."""
ALONG_THE_PULL = (
    "it is not the force threshold, because the vibration is along the pull: at a prescribed speed "
    "it reverses the force, which reduces the mean; under a constant force a body without mass "
    "moves along with the vibration, and all of friction holds it"
)
"""Explanation of a static friction below the force threshold."""
UNKNOWN_THRESHOLD = (
    "it is not the force threshold, because part of the vibration is along the pull; whether a "
    "constant force moves the contact is computed for a given force"
)
"""Explanation of a static friction without a force threshold."""

QUANTILES, FIRST_ORDER = "quantiles", "first order"
"""How an interval follows from the uncertain inputs: of draws, whose static friction is solved for,
or of a static friction that is linear in each input."""
FROM_INPUTS = "from the uncertain inputs"
FROM_LINEAR_MODEL = (
    f"{FROM_INPUTS} to first order: static friction is taken to be linear in each of them"
)
"""Origin of an interval by quantiles, and to first order."""

NO_SPREAD_OF_SPEED = "none of the speed: the contact may run away"
"""Text where a speed within the uncertainties is infinite."""
STAYS_WITHIN_SPREADS = "none of the speed: the contact may move"
"""Text where the contact stays one standard deviation around the inputs, but may move further."""
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


def pressure_text(pascals: float) -> str:
    """A largest pressure with its unit."""
    return in_unit(pascals, 0.0, ("MPa", 1e6)) if math.isfinite(pascals) else "infinite, at the tip"


def length_unit(u_lim: float) -> tuple[str, float]:
    """The unit of all lengths of an answer."""
    return unit_for(u_lim, LENGTHS, LEAST_LENGTH)


def unit_of_sought(found: Any) -> str:
    """SI unit of the quantity that a reduction looks for."""
    if found.sought == "amplitude" and unit_of_amplitude(found.motion) == "rad":
        return "rad"
    return {"amplitude": "m", "speed": "m/s", "load": "N"}[found.sought]


def requested_quantity(found: Any) -> str:
    """Name of the quantity that `converged` and `reason` are about."""
    if found.vibration_power_reason:
        return "vibration power"
    if found.sought is not None:
        return found.sought
    return "mu_macro" if found.force_N is None else "speed"


def not_converged(found: Any) -> list[str]:
    """Lines for every quantity whose error is larger than its tolerance."""
    lines = []
    if not found.converged and found.outcome != "runs away":
        reason = found.vibration_power_reason or found.reason
        lines.append(f"NOT CONVERGED: {requested_quantity(found)}: {reason}")
    if found.mu_static_reason:
        lines.append(f"NOT CONVERGED: static friction: {found.mu_static_reason}")
    return lines


def runs_away(found: Any) -> str:
    """Sentence about a contact that accelerates without end."""
    if found.force is not None and found.force < 1.0:
        return f"it {found.reason}"
    unit = force_unit(found.friction_force_still_N)
    still = in_unit(found.friction_force_still_N, 0.0, unit)
    return f"it runs away: friction holds no more than {still}, mu times the load"


def interval_lines(
    ends: tuple[float | None, float | None],
    error: float,
    method: str | None,
    unit: tuple[str, float] = ("", 1.0),
) -> list[str]:
    """The line of an interval that follows from the uncertain inputs, if there is one.

    ends, error: ends of the interval and their error estimate in SI units; method: see Prediction.
    """
    low, high = ends
    if low is None or high is None:
        return []
    name, size = unit
    text = interval_text(low / size, high / size, name, error=error / size)
    origin = FROM_LINEAR_MODEL if method == FIRST_ORDER else FROM_INPUTS
    return [line("", f"95 % interval {text}, {origin}")]
