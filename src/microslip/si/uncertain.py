"""Quantities that are known to within a spread: "0.3 +- 0.03", "10 N +- 5 %".

A spread is a standard uncertainty.  Each is carried through by predictions at both of its ends,
half of whose difference is its share; shares of independent quantities add up in squares (JCGM 100,
Guide to the Expression of Uncertainty in Measurement, 5.1).
"""

from __future__ import annotations

import functools
import inspect
import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si.motions import unit_of_amplitude
from microslip.si.outcomes import UncertainInput, with_outcomes
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import EXCLUDED
from microslip.si.quantities import read
from microslip.si.question import asked as question_of
from microslip.si.reduction import NotAttainedError

UNITS = {
    "mu": "",
    "load": "N",
    "radius": "m",
    "counter_radius": "m",
    "radius_across": "m",
    "contact_radius": "m",
    "speed": "m/s",
    "young": "Pa",
    "nu": "",
    "force": "N",
    "amplitude": "m",
    "forward_amplitude": "m",
    "rotation_amplitude": "rad",
    "load_amplitude": "N",
    "frequency": "Hz",
    "rotation": "rad/s",
    "drive_stiffness": "N/m",
    "mass": "kg",
    "damping": "N*s/m",
}
"""Arguments that may have a standard uncertainty, and their SI units; the amplitude of some motions
has another one."""
FIELDS = {
    "mu_macro": "mu_macro_spread",
    "mu_apparent": "mu_apparent_spread",
    "friction_force_N": "friction_force_spread_N",
    "speed_m_s": "speed_spread_m_s",
    "sought_value": "sought_spread",
}
"""Attributes of a Prediction with an uncertainty, and the fields that hold it."""
_SPREAD = re.compile(r"(.*?)\s*(?:\+-|\+/-|±)\s*(.*)", re.S)


def with_spreads(predict: Callable) -> Callable:
    """predict, of which arguments in UNITS may be texts with a spread."""

    @functools.wraps(predict)
    def asked(motion: str, **arguments: Any) -> Prediction:
        plain, spread = without_spreads(motion, arguments)
        found = predict(motion, **plain)
        if not spread:
            return found
        ends = {
            name: (
                _predicted(predict, motion, plain, name, low),
                _predicted(predict, motion, plain, name, high),
            )
            for name, (low, high) in spread.items()
        }
        squares = {name: 0.0 for name in FIELDS if getattr(found, name) is not None}
        for low, high in ends.values():
            for field in squares:
                squares[field] += _half_of_difference(low, high, field) ** 2
        texts = {name: " ".join(str(arguments[name]).split()) for name in spread}
        spreads = {FIELDS[field]: math.sqrt(value) for field, value in squares.items()}
        inputs = [
            UncertainInput(name, 0.5 * (low + high), 0.5 * (high - low))
            for name, (low, high) in spread.items()
        ]
        every = dict.fromkeys(inspect.signature(predict).parameters) | {"power": False} | plain
        del every["motion"]
        spreads |= with_outcomes(
            found, inputs, lambda changes: question_of(motion, every | dict(changes)), ends
        )
        if (spreads.get("probability_runs_away") or 0.0) > EXCLUDED:
            spreads["speed_spread_m_s"] = math.inf
        return replace(found, **spreads, understood=found.understood | texts)

    return asked


def without_spreads(motion: object, arguments: Mapping[str, object]) -> tuple[dict, dict]:
    """Arguments of predict without the spreads in them, and the ends of those that have one.

    Raises InputError for a spread that is none.
    """
    plain, ends = dict(arguments), {}
    for name, unit in UNITS.items():
        parts = _parts(arguments.get(name))
        if parts is None:
            continue
        if name == "amplitude" and isinstance(motion, str):
            unit = unit_of_amplitude(motion) or unit
        plain[name], ends[name] = parts[0], _ends(name, arguments[name], parts, unit)
    return plain, ends


def refuse_spreads(arguments: Mapping[str, object], where: str) -> None:
    """Raise InputError for the first argument with a spread; where: what goes without spreads."""
    for name, value in arguments.items():
        if _parts(value) is not None:
            raise InputError(name, value, f"allowed is a quantity without uncertainty for {where}")


def _parts(value: object) -> tuple[str, str] | None:
    """Texts of a value and of its spread; None where there is no spread."""
    match = _SPREAD.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else (match[1], match[2])


def _ends(name: str, given: object, parts: tuple[str, str], unit: str) -> tuple[float, float]:
    """Both ends of a quantity in the SI; raises InputError for a spread that is none."""
    text, spread = parts
    low = -math.inf if name == "counter_radius" else 0.0
    try:
        value = read(name, text, unit, low=low).si
        if spread.endswith("%") and not text.endswith("%"):
            size = abs(value) * read(name, spread, "", low_open=False).si
        else:
            size = read(name, spread, unit, low_open=False).si
    except InputError as error:
        allowed = f"in it {error.value!r}: {error.allowed}, as in '10 N +- 5 %'"
        raise InputError(name, given, allowed) from None
    if not size < abs(value):
        raise InputError(name, given, "allowed is a spread below the value")
    return value - size, value + size


def _half_of_difference(low: Prediction | None, high: Prediction | None, field: str) -> float:
    """Half the difference of a field of both; infinite where one of them has no value, because
    nothing has the wanted reduction, or the contact runs away."""
    if low is None or high is None:
        return math.inf
    half = 0.5 * (getattr(high, field) - getattr(low, field))
    return math.inf if math.isnan(half) else half


def _predicted(
    predict: Callable, motion: str, plain: dict, name: str, end: float
) -> Prediction | None:
    try:
        return predict(motion, **plain | {name: end})
    except NotAttainedError:
        return None
    except InputError as error:
        problem = f"at an end of its spread, {end:.6g}: {error.argument}: {error.allowed}"
        raise InputError(name, plain[name], problem) from None
