"""The amplitude, the speed or the load at which vibration takes a share of friction away."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.si.dimensionless import groups
from microslip.si.request import Request

LARGEST_AMPLITUDE = 1e4
"""Largest dimensionless amplitude that is tried."""
SMALLEST_AMPLITUDE = 1e-6
"""Smallest dimensionless amplitude that is tried."""
SPEEDS = 1e-9, 1e6
"""Smallest and largest dimensionless velocity that is tried, over 1 and the amplitude."""
STRIDE = 0.05
"""Step in the logarithm of the sought quantity for the slope of friction."""


class NotAttainedError(InputError):
    """No contact, or every one, has so much of its friction taken away: known by solving alone."""


class _NoAnswerError(Exception):
    """The solver has no number at an amplitude; its reason is found again there."""


@dataclass(frozen=True)
class _Line:
    """A line of requests along which friction falls.

    at: the request at a place of it; low, start, high: the place to begin from, where one beyond
    the wanted one is first looked for, and where no longer; size: the sought quantity at a place,
    in the SI; every, none: in words, the end that takes too much away, and all places; end: where
    friction is least, if that is known; rate: derivative of the logarithm of the size by the place.
    """

    at: Callable[[float], Request]
    low: float
    start: float
    high: float
    size: Callable[[float], float]
    every: str
    none: str
    end: float | None = None
    rate: float = 1.0


def reduce_friction(request: Request) -> tuple[Request, float]:
    """The request with the least amplitude, the largest speed or the largest load at which
    vibration takes the wanted share of friction away, and the error of that quantity in its SI
    unit.

    Where the solver has no answer on the way, the request that it has none for, with the error NaN.

    Raises
    ------
    NotAttainedError
        Where none, or every one, takes that much friction away.
    InputError
        For a share that cannot be looked for.
    """
    from scipy.optimize import brentq

    share, tolerance = request.share, request.tolerance
    reduction = request.arguments["reduction"]
    assert share is not None and request.sought is not None  # as of every request with a reduction
    _refuse_share(request, share)
    line = _LINES[request.sought](request, share)
    last, error, seen = request, 0.0, []

    def missing(place: float) -> float:
        nonlocal last, error
        last = line.at(place)
        answer = last.solve(last.groups[0], tolerance)
        found, error = answer.mu_macro, answer.mu_macro_error
        if not math.isfinite(found):
            raise _NoAnswerError
        if last.motion.speed == 0.0 and found <= error:
            found = 0.0  # of static friction nothing is left, which no run says to the last digit
        seen.append((100.0 * (1.0 - found), 100.0 * error))
        return found - (1.0 - share)

    try:
        if missing(line.low) < 0.0:
            problem = f"{line.every} takes more away: {number_text(*min(seen))} %"
            raise NotAttainedError("reduction", reduction, problem)
        high = line.start
        if line.end is not None and missing(line.end) > 0.0:
            high = math.inf
        while high > line.high or missing(high) > 0.0:
            if high >= line.high:
                problem = f"{line.none} takes more than {number_text(*max(seen))} % away"
                raise NotAttainedError("reduction", reduction, problem)
            high = min(high + math.log(2.0), line.high)
        place = brentq(missing, line.low, high, xtol=0.1 * tolerance)
        here = missing(place)
        error_here = error
        slopes = [missing(place - STRIDE) - here, here - missing(place + STRIDE)]
    except _NoAnswerError:
        return last, math.nan
    steep = [slope / STRIDE for slope in slopes if slope > 0.0]
    wrong = (abs(here) + error_here) / min(steep) if steep else math.inf
    return line.at(place), line.rate * line.size(place) * wrong


def _refuse_share(request: Request, share: float) -> None:
    """Raise InputError for a share that no solve can find."""
    allowed, motion, tolerance = "", request.motion, request.tolerance
    if share < tolerance:
        allowed = f"allowed is at least the tolerance, {tolerance:g}"
    elif motion.spins and share == 1.0:
        allowed = "allowed is less than all of it: the centre of a contact that turns always sticks"
    elif request.sought != "speed" and motion.speed and share > 1.0 - tolerance:
        allowed = f"allowed is at most {100.0 * (1.0 - tolerance):g} %, 100 % less the tolerance"
        allowed += ": at a speed some friction is left"
    if allowed:
        raise InputError("reduction", request.arguments["reduction"], allowed)


def _amplitudes(request: Request, _share: float) -> _Line:
    """Places are logarithms of amplitudes."""
    contact = request.contact
    unit = contact.u_lim / (contact.contact_radius if request.motion.spins else 1.0)
    slides = "the one that lets the contact slide"
    return _Line(
        lambda place: request.at(amplitude=unit * math.exp(place)),
        math.log(SMALLEST_AMPLITUDE),
        0.0,
        math.log(LARGEST_AMPLITUDE),
        lambda place: unit * math.exp(place),
        f"the smallest amplitude tried, {SMALLEST_AMPLITUDE:g} times {slides}, at this speed",
        f"no amplitude up to {LARGEST_AMPLITUDE:g} times {slides}",
    )


def _speeds(request: Request, _share: float) -> _Line:
    """Places are logarithms of speeds, the fastest first."""
    size, unit = request.groups[1], request.speed_unit
    if not request.motion.spins and size is not None:
        unit *= max(1.0, size)  # a rigid contact compares the speed with that of the vibration
    slowest, fastest = SPEEDS
    return _Line(
        lambda place: request.at(speed=unit * math.exp(-place)),
        -math.log(fastest),
        0.0,
        -math.log(slowest),
        lambda place: unit * math.exp(-place),
        f"the largest speed tried, {fastest * unit:.2g} m/s,",
        "no speed",
        math.inf,
    )


def _loads(request: Request, share: float) -> _Line:
    """Places are logarithms of the dimensionless amplitude, which falls by a power of the load."""
    contact, motion = request.contact, request.motion

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
        lambda place: request.at(contact=contact.with_load(load_at(place))),
        low,
        math.log(0.01 * share),
        high,
        load_at,
        f"the largest load tried, {load_at(low):.2g} N,",
        f"of those tried, down to {load_at(high):.2g} N, no load",
        rate=1.0 / power,
    )


_LINES = {"amplitude": _amplitudes, "speed": _speeds, "load": _loads}
