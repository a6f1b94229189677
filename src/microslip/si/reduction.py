"""Search for the amplitude, speed or load that gives a prescribed reduction of friction."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.si.request import Request

LARGEST_AMPLITUDE = 1e4
"""Largest dimensionless amplitude of the search."""
SMALLEST_AMPLITUDE = 1e-6
"""Smallest dimensionless amplitude of the search."""
SPEEDS = 1e-9, 1e6
"""Smallest and largest dimensionless velocity of the search.  For a translation with an amplitude
above 1, the velocity is divided by the amplitude."""
STRIDE = 0.05
"""Step of the finite difference for the slope of friction.  The difference is taken in the
logarithm of the unknown."""


class NotAttainedError(InputError):
    """The requested reduction is outside the range of the search.  This can be detected only by a
    solve."""


class _NoAnswerError(Exception):
    """The solver has no result at a point of the search."""


@dataclass(frozen=True)
class _Line:
    """The unknown quantity of a search as a function of a real number, called the place.

    Friction decreases as the place increases.

    Attributes
    ----------
    size : callable
        Function size(place) -> the quantity in its SI unit.
    low, start, high : float
        First place of the search, initial guess of the bracket's upper end, and last place.
    every, none : str
        Subjects of two error messages.  If the reduction is already too large at `low`, the subject
        is `every`.  If the reduction is too small everywhere, the subject is `none`.
    end : float or None
        Place with the least friction; None if this place is unknown.
    rate : float
        Derivative of log(size) with respect to the place.
    """

    size: Callable[[float], float]
    low: float
    start: float
    high: float
    every: str
    none: str
    end: float | None = None
    rate: float = 1.0


def reduce_friction(request: Request) -> tuple[Request, float]:
    """Search for the smallest amplitude, largest speed or largest load that gives a reduction.

    Returns
    -------
    tuple of Request and float
        The request that contains the solution, and the solution's error estimate in the SI unit.
        If the solver fails, the request at which it failed, and NaN.

    Raises
    ------
    NotAttainedError
        If all places of the search give a smaller reduction, or all give a larger one.
    InputError
        If no search can determine the quantity.
    """
    from scipy.optimize import brentq

    share, tolerance = request.inputs.si("reduction"), request.tolerance
    reduction = request.inputs.arguments["reduction"]
    assert share is not None and request.sought is not None  # the request has a reduction
    _check_share(request, share)
    sought: str = request.sought
    line = _LINES[sought](request, share)
    last, error, reductions = request, 0.0, []

    def excess(place: float) -> float:
        """mu_macro minus the requested mu_macro."""
        nonlocal last, error
        last = request.at(**{sought: line.size(place)})
        answer = last.solve(last.groups[0], tolerance)
        friction, error = answer.mu_macro, answer.mu_macro_error
        if not math.isfinite(friction):
            raise _NoAnswerError
        if last.motion.speed == 0.0 and friction <= error:
            friction = 0.0  # the whole contact slides; the remaining friction is an error
        reductions.append((100.0 * (1.0 - friction), 100.0 * error))
        return friction - (1.0 - share)

    try:
        if excess(line.low) < 0.0:
            problem = f"{line.every} reduces friction by more: {number_text(*min(reductions))} %"
            raise NotAttainedError("reduction", reduction, problem)
        high = line.start
        if line.end is not None and excess(line.end) > 0.0:
            high = math.inf
        while high > line.high or excess(high) > 0.0:
            if high >= line.high:
                problem = (
                    f"{line.none} reduces friction by more than {number_text(*max(reductions))} %"
                )
                raise NotAttainedError("reduction", reduction, problem)
            high = min(high + math.log(2.0), line.high)
        place = brentq(excess, line.low, high, xtol=0.1 * tolerance)
        here = excess(place)
        error_here = error
        slopes = [excess(place - STRIDE) - here, here - excess(place + STRIDE)]
    except _NoAnswerError:
        return last, math.nan
    steep = [slope / STRIDE for slope in slopes if slope > 0.0]
    place_error = (abs(here) + error_here) / min(steep) if steep else math.inf
    size = line.size(place)
    return request.at(**{sought: size}), line.rate * size * place_error


def _check_share(request: Request, share: float) -> None:
    """Raise InputError for a reduction that no search can determine."""
    allowed, motion, tolerance = "", request.motion, request.tolerance
    if share < tolerance:
        allowed = f"allowed is at least the tolerance, {tolerance:g}"
    elif motion.spins and share == 1.0:
        allowed = "allowed is less than 100 %: the centre of a contact that spins always sticks"
    elif request.sought != "speed" and motion.speed and share > 1.0 - tolerance:
        allowed = f"allowed is at most {100.0 * (1.0 - tolerance):g} %, 100 % minus the tolerance"
        allowed += ": at a speed some friction remains"
    if allowed:
        raise request.inputs.error("reduction", allowed)


def _amplitudes(request: Request, _share: float) -> _Line:
    """The line of amplitudes.  A place is the logarithm of the dimensionless amplitude."""
    contact = request.contact
    unit = contact.u_lim / (contact.contact_radius if request.motion.spins else 1.0)
    name = "u_lim divided by the contact radius" if request.motion.spins else "u_lim"
    return _Line(
        lambda place: unit * math.exp(place),
        math.log(SMALLEST_AMPLITUDE),
        0.0,
        math.log(LARGEST_AMPLITUDE),
        f"the smallest amplitude of the search, {SMALLEST_AMPLITUDE:g} times {name},",
        f"no amplitude up to {LARGEST_AMPLITUDE:g} times {name}",
    )


def _speeds(request: Request, _share: float) -> _Line:
    """The line of decreasing speeds.  The place is minus the logarithm of the speed."""
    size, unit = request.groups[1], request.speed_unit
    if not request.motion.spins and size is not None:
        unit *= max(1.0, size)  # at large amplitudes the speed of the vibration is the unit
    slowest, fastest = SPEEDS
    return _Line(
        lambda place: unit * math.exp(-place),
        -math.log(fastest),
        0.0,
        -math.log(slowest),
        f"the largest speed of the search, {fastest * unit:.2g} m/s,",
        "no speed",
        math.inf,
    )


def _loads(request: Request, share: float) -> _Line:
    """The line of loads.  A place is the logarithm of the dimensionless amplitude.

    The dimensionless amplitude is a power of the load, with a negative exponent.
    """
    load = request.contact.load
    size, smaller = (request.at(load=one).groups[1] for one in (load, 8.0 * load))
    assert size is not None and smaller is not None  # the motion oscillates
    if not size > 0.0:
        raise request.inputs.error("amplitude", "allowed is above 0 with a reduction")
    power = math.log(size / smaller) / math.log(8.0)

    def load_at(place: float) -> float:
        return load * (size / math.exp(place)) ** (1.0 / power)

    # Under a large load nothing slips, and under a small load the dimensionless velocity of a bore
    # is large.  The reduction is largest in between.  Small steps from large loads downwards find
    # the first load with the requested reduction.
    low, high = math.log(SMALLEST_AMPLITUDE), math.log(LARGEST_AMPLITUDE)
    return _Line(
        load_at,
        low,
        math.log(0.01 * share),
        high,
        f"the largest load of the search, {load_at(low):.2g} N,",
        f"no load of the search, down to {load_at(high):.2g} N,",
        rate=1.0 / power,
    )


_LINES = {"amplitude": _amplitudes, "speed": _speeds, "load": _loads}
