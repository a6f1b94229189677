"""Search for the amplitude, speed or load that gives a requested reduction of friction."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.foundation.number_text import number_text
from microslip.si.contact import Contact, contact_of
from microslip.si.inputs import Inputs
from microslip.si.output import Value
from microslip.si.solve import TOLERANCE, solve_at

AMPLITUDES = 1e-6, 1e4
"""Smallest and largest dimensionless amplitude of the search."""
SPEEDS = 1e-9, 1e6
"""Smallest and largest dimensionless velocity of the search.  For a translation with an amplitude
above 1, the velocity is divided by the amplitude."""
LOAD = 1e-12
"""Load, N, at which groups are computed in a search for the load.  It is so small that Hertz's
theory applies to all bodies."""
STEP = 0.05
"""Step of the finite difference for the slope of friction.  The difference is taken in the
logarithm of the unknown."""


class NoSolutionError(InputError):
    """The requested reduction is outside the range of the search."""


class _SolverFailureError(Exception):
    """The solver has no result at a point of the search."""


def find_reduction(inputs: Inputs) -> tuple[Contact, Value]:
    """The contact with the smallest amplitude, the largest speed or the largest load that gives the
    reduction, and this quantity in its SI unit.

    If the solver fails, the contact is that at which it failed, and the error is NaN.  Raises
    NoSolutionError if the reduction is outside the range of the search, and InputError if an input
    is invalid.
    """
    from scipy.optimize import brentq

    name, share, tolerance = str(inputs.search), inputs.reduction, inputs.tolerance or TOLERANCE
    _check_share(inputs, share, tolerance)
    (scale, power, low, high, last_place), unit = _line(inputs, name, share), inputs.unit(name)
    least, towards = ("smallest", "up") if name == "amplitude" else ("largest", "down")
    last: Any = None
    error, reductions = 0.0, []

    def size(place: float) -> float:
        """The unknown in its SI unit."""
        return scale * math.exp(power * place)

    def excess(place: float) -> float:
        """mu_macro minus the requested mu_macro."""
        nonlocal last, error
        last = Contact(inputs.at(**{name: size(place)}))
        answer = solve_at(last, last.velocity, tolerance)
        friction, error = answer.mu_macro, answer.mu_macro_error
        if not math.isfinite(friction):
            raise _SolverFailureError
        if last.inputs.speed == 0.0 and friction <= error:
            friction = 0.0  # the whole contact slides; the remaining friction is an error
        reductions.append((100.0 * (1.0 - friction), 100.0 * error))
        return friction - (1.0 - share)

    def refusal(end: str, reduction: str) -> NoSolutionError:
        allowed = f"{end} {unit}, reduces friction by more{reduction} %"
        return NoSolutionError("reduction", inputs.given["reduction"], allowed)

    try:
        if excess(low) < 0.0:
            end = f"the {least} {name} of the search, {size(low):.2g}"
            raise refusal(end, f": {number_text(*reductions[0])}")
        if name == "speed" and excess(math.inf) > 0.0:
            high = last_place
        while excess(high) > 0.0:
            if high >= last_place:
                end = f"no {name} of the search, {towards} to {size(high):.2g}"
                raise refusal(end, f" than {number_text(*max(reductions))}")
            high = min(high + math.log(2.0), last_place)
        place = brentq(excess, low, high, xtol=0.1 * tolerance)
        here, error_here = excess(place), error
        slopes = [excess(place - STEP) - here, here - excess(place + STEP)]
    except _SolverFailureError:
        return last, Value(getattr(last.inputs, name), math.nan)
    steep = [slope / STEP for slope in slopes if slope > 0.0]
    place_error = (abs(here) + error_here) / min(steep) if steep else math.inf
    root = size(place)
    try:
        contact = contact_of(replace(inputs, search=None).at(**{name: root}))
    except InputError as problem:
        allowed = f"it takes a {name} of {root:.3g} {unit}; {problem}"
        raise inputs.error("reduction", allowed) from None
    return contact, Value(root, abs(power) * root * place_error)


def _check_share(inputs: Inputs, share: float, tolerance: float) -> None:
    """Raise InputError for a reduction that no search can determine."""
    most = f"{100.0 * (1.0 - tolerance):g} %, 100 % minus the tolerance: at a speed some friction"
    spins, moves = inputs.kind.unit == "rad", inputs.search != "speed" and inputs.speed
    for name, is_refused, allowed in (
        ("reduction", share < tolerance, f"at least the tolerance, {tolerance:g}"),
        ("reduction", spins and share == 1.0, "less than 100 %: the centre always sticks"),
        ("reduction", moves and share > 1.0 - tolerance, f"at most {most} remains"),
        ("amplitude", inputs.search == "load" and inputs.amplitude == 0.0, "above 0"),
    ):
        if is_refused:
            raise inputs.error(name, f"allowed with a reduction is {allowed}")


def _line(inputs: Inputs, name: str, share: float) -> tuple[float, float, float, float, float]:
    """The unknown as scale * exp(power * place), along which friction decreases with the place.

    Returns
    -------
    tuple of float
        Scale, power, first place, initial guess of the bracket's upper end, and last place.
    """
    low, high = (math.log(one) for one in AMPLITUDES)
    spins = inputs.kind.unit == "rad"
    if name == "amplitude":  # a place is the logarithm of the dimensionless amplitude
        contact = Contact(inputs.at(amplitude=0.0))
        unit = contact.u_lim / (contact.contact_radius if spins else 1.0)
        return unit, 1.0, low, 0.0, high
    if name == "speed":  # a place is minus the logarithm of the speed
        contact = Contact(inputs.at(speed=0.0))
        unit = contact.speed_unit
        if not (contact.steady or spins):
            unit *= max(1.0, float(contact.amplitude))  # the speed of the vibration
        slow, fast = (-math.log(one) for one in SPEEDS)
        return unit, -1.0, fast, 0.0, slow
    # A place is the logarithm of the dimensionless amplitude, which is a power of the load with a
    # negative exponent.  Under a large load nothing slips, and under a small load the dimensionless
    # velocity of a bore is large.  The reduction is largest in between.  Small steps from large
    # loads downwards find the first load with the requested reduction.
    first, second = (float(Contact(inputs.at(load=f * LOAD)).amplitude) for f in (1.0, 8.0))
    power = math.log(8.0) / math.log(second / first)
    return LOAD * first**-power, power, low, math.log(0.01 * share), high
