"""The amplitude, the speed or the load at which vibration takes a share of friction away."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from microslip.adaptive.point import Result, solve
from microslip.foundation.arguments import LARGEST
from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.si.bodies import TwoBodies
from microslip.si.dimensionless import RealMotion, groups, solver_motion, speed_unit
from microslip.si.motions import COMBINED, check_motion, unit_of_amplitude

LARGEST_AMPLITUDE = 1e4
"""Dimensionless amplitude beyond which no smaller friction is looked for."""
SMALLEST_AMPLITUDE = 1e-6
"""Dimensionless amplitude, nearly, below which no larger friction is looked for."""
SPEEDS = 1e-9, 1e6
"""Dimensionless velocities between which a speed is looked for, over 1 and the amplitude."""
STRIDE = 0.05
"""Step in the logarithm of the sought quantity, over which the slope of friction is taken."""
SOUGHT = ("amplitude", "speed", "load")
"""Quantities that a reduction can determine."""


@dataclass(frozen=True)
class Found:
    """A contact and a motion of which vibration takes the wanted share of friction away.

    Attributes
    ----------
    contact : TwoBodies
        With its load.
    motion : RealMotion
        With its amplitude and speed.
    error : float
        Largest error of what was looked for, in its SI unit, by estimate; NaN where the solver has
        no answer.
    """

    contact: TwoBodies
    motion: RealMotion
    error: float


@dataclass(frozen=True)
class _Line:
    """A line of contacts and motions along which friction falls.

    at: both at a place of it; low, start, high: the place to begin from, where one beyond the
    wanted one is first looked for, and where no longer; size: what is looked for at a place, in the
    SI; every, none: in words, the end that takes too much away, and all places; end: where friction
    is least, if that is known; rate: how much the logarithm of the size changes with the place.
    """

    at: Callable[[float], tuple[TwoBodies, RealMotion]]
    low: float
    start: float
    high: float
    size: Callable[[float], float]
    every: str
    none: str
    end: float | None = None
    rate: float = 1.0


class NotAttainedError(InputError):
    """No contact, or every one, has so much of its friction taken away: known by solving alone."""


class _NoAnswerError(Exception):
    """The solver has no number at an amplitude; its reason is found again there."""


def friction_of(
    contact: TwoBodies, motion: RealMotion, tolerance: float, **contacts: Any
) -> Result:
    """The result of microslip.solve for a motion; contacts: the `contacts` argument, if any."""
    velocity, size = groups(motion, contact)
    assert velocity is not None  # as of all that have a speed
    fast = min(velocity, LARGEST["velocity"])  # beyond, the vibration does nothing
    settings: dict[str, Any] = {
        "poisson": contact.poisson,
        "pressure": contact.pressure,
        "tolerance": tolerance,
    }
    return solve(solver_motion(motion, contact), fast, size, **settings, **contacts)


def sought_by(motion: str, reduction: object, given: Mapping[str, object]) -> str | None:
    """Name of the quantity to be found for a reduction: the missing one; None without a reduction.

    Raises InputError for a motion that is none or has no such thing, and where more than one thing
    or nothing is left to look for.
    """
    check_motion(motion)
    missing = [name for name in SOUGHT if given[name] is None]
    single = unit_of_amplitude(motion) is not None
    if reduction is None:
        if given["load"] is None:
            raise InputError("load", None, "needed")
        return None
    if not single and missing != ["speed"]:
        what = "several amplitudes" if motion in COMBINED else "no amplitude"
        raise InputError("reduction", reduction, f"{motion} has {what} to look for")
    if not missing:
        allowed = "allowed without an amplitude, a speed or a load, which is then looked for"
        raise InputError("reduction", reduction, allowed)
    if len(missing) > 1:
        allowed = f"one thing can be looked for, and {' and '.join(missing)} are not given"
        raise InputError("reduction", reduction, allowed)
    return missing[0]


def with_reduction(
    contact: TwoBodies,
    motion: RealMotion,
    sought: str,
    *,
    share: float,
    tolerance: float,
    given: object,
) -> Found:
    """The least amplitude, the largest speed or the largest load at which vibration takes a share
    of friction away.

    Parameters
    ----------
    contact, motion : TwoBodies, RealMotion
        Without what is looked for, or with any value of it.
    sought : str
        One of SOUGHT.
    share, tolerance : float
        The share, 0 to 1, and the accepted error of mu_macro, dimensionless.
    given : object
        The share as it was given, for messages.

    Returns
    -------
    Found
        Where the solver has no answer on the way, what it has none for: so its reason is told.

    Raises
    ------
    NotAttainedError
        Where none, or every one, takes that much friction away.
    InputError
        For a share that cannot be looked for.
    """
    from scipy.optimize import brentq

    if share < tolerance:
        raise InputError("reduction", given, f"allowed is at least the tolerance, {tolerance:g}")
    if motion.spins and share == 1.0:
        allowed = "allowed is less than all of it: the centre of a contact that turns always sticks"
        raise InputError("reduction", given, allowed)
    if sought != "speed" and motion.speed and share > 1.0 - tolerance:
        most = 100.0 * (1.0 - tolerance)
        allowed = f"allowed is at most {most:g} %, 100 % less the tolerance"
        allowed += ": at a speed some friction is left"
        raise InputError("reduction", given, allowed)
    line = _LINES[sought](contact, motion, share)
    last, error, seen = (contact, motion), 0.0, []

    def missing(place: float) -> float:
        nonlocal last, error
        last = line.at(place)
        answer = friction_of(*last, tolerance)
        found, error = answer.mu_macro, answer.mu_macro_error
        if not math.isfinite(found):
            raise _NoAnswerError
        if last[1].speed == 0.0 and found <= error:
            found = 0.0  # of static friction nothing is left, which no run says to the last digit
        seen.append((100.0 * (1.0 - found), 100.0 * error))
        return found - (1.0 - share)

    try:
        if missing(line.low) < 0.0:
            problem = f"{line.every} takes more away: {number_text(*min(seen))} %"
            raise NotAttainedError("reduction", given, problem)
        high = line.start
        if line.end is not None and missing(line.end) > 0.0:
            high = math.inf
        while high > line.high or missing(high) > 0.0:
            if high >= line.high:
                problem = f"{line.none} takes more than {number_text(*max(seen))} % away"
                raise NotAttainedError("reduction", given, problem)
            high = min(high + math.log(2.0), line.high)
        place = brentq(missing, line.low, high, xtol=0.1 * tolerance)
        here = missing(place)
        error_here = error
        slopes = [missing(place - STRIDE) - here, here - missing(place + STRIDE)]
    except _NoAnswerError:
        return Found(*last, math.nan)
    steep = [slope / STRIDE for slope in slopes if slope > 0.0]
    wrong = (abs(here) + error_here) / min(steep) if steep else math.inf
    return Found(*line.at(place), line.rate * line.size(place) * wrong)


def _amplitudes(contact: TwoBodies, motion: RealMotion, _share: float) -> _Line:
    """Places are logarithms of amplitudes."""
    unit = contact.u_lim / (contact.contact_radius if motion.spins else 1.0)
    slides = "the one that lets the contact slide"
    return _Line(
        lambda place: (contact, replace(motion, amplitude=unit * math.exp(place))),
        math.log(SMALLEST_AMPLITUDE),
        0.0,
        math.log(LARGEST_AMPLITUDE),
        lambda place: unit * math.exp(place),
        f"the smallest amplitude tried, {SMALLEST_AMPLITUDE:g} times {slides}, at this speed",
        f"no amplitude up to {LARGEST_AMPLITUDE:g} times {slides}",
    )


def _speeds(contact: TwoBodies, motion: RealMotion, _share: float) -> _Line:
    """Places are logarithms of speeds, the fastest first."""
    motion = replace(motion, speed=0.0)
    _, size = groups(motion, contact)
    unit = speed_unit(motion, contact)
    if not motion.spins and size is not None:
        unit *= max(1.0, size)  # a rigid contact compares the speed with that of the vibration
    slowest, fastest = SPEEDS
    return _Line(
        lambda place: (contact, replace(motion, speed=unit * math.exp(-place))),
        -math.log(fastest),
        0.0,
        -math.log(slowest),
        lambda place: unit * math.exp(-place),
        f"the largest speed tried, {fastest * unit:.2g} m/s,",
        "no speed",
        math.inf,
    )


def _loads(contact: TwoBodies, motion: RealMotion, share: float) -> _Line:
    """Places are logarithms of the dimensionless amplitude, which falls by a power of the load."""

    def size_at(load: float) -> float:
        size = groups(motion, contact.with_load(load))[1]
        assert size is not None  # as of all that oscillate
        return size

    here = contact.load
    if not size_at(here) > 0.0:
        raise InputError("amplitude", motion.amplitude, "allowed is above 0 with a reduction")
    power = math.log(size_at(here) / size_at(8.0 * here)) / math.log(8.0)

    def load_at(place: float) -> float:
        return here * (size_at(here) / math.exp(place)) ** (1.0 / power)

    # Under a large load nothing slips, and under a small one a bore is fast: what vibration takes
    # away is largest between, and the first load from above is looked for in small steps.
    low, high = math.log(SMALLEST_AMPLITUDE), math.log(LARGEST_AMPLITUDE)
    return _Line(
        lambda place: (contact.with_load(load_at(place)), motion),
        low,
        math.log(0.01 * share),
        high,
        load_at,
        f"the largest load tried, {load_at(low):.2g} N,",
        f"of those tried, down to {load_at(high):.2g} N, no load",
        rate=1.0 / power,
    )


_LINES = {"amplitude": _amplitudes, "speed": _speeds, "load": _loads}
