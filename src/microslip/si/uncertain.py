"""Uncertain inputs: "0.3 +- 0.03", "10 N +- 5 %".

The number behind +- is a standard uncertainty.  Each is propagated by predictions at both of its
ends: half of their difference is its contribution, and the contributions of independent quantities
add up in squares (JCGM 100, Guide to the Expression of Uncertainty in Measurement, 5.1).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si.inputs import QUANTITIES
from microslip.si.motions import unit_of_amplitude
from microslip.si.outcomes import Ends, UncertainInput, uncertainty_of_outcomes
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import EXCLUDED
from microslip.si.quantities import read
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request, request_of

EXACT = ("phase", "density", "counter_density", "reduction")
"""Quantities that have no uncertainty."""
SPREADS = {
    "mu_macro": "mu_macro_spread",
    "mu_apparent": "mu_apparent_spread",
    "friction_force_N": "friction_force_spread_N",
    "speed_m_s": "speed_spread_m_s",
    "sought_value": "sought_spread",
}
"""Attributes of a Prediction with an uncertainty, and the columns that hold it."""
_SPREAD = re.compile(r"(.*?)\s*(?:\+-|\+/-|±)\s*(.*)", re.S)


def without_uncertainty(
    motion: object, arguments: Mapping[str, Any]
) -> tuple[dict[str, Any], list[UncertainInput]]:
    """Arguments of predict without the uncertainties in them, and the uncertain ones.

    Raises InputError for an uncertainty that is none.
    """
    plain, uncertain = dict(arguments), []
    for name, quantity in QUANTITIES.items():
        parts = None if name in EXACT else _parts(arguments.get(name))
        if parts is not None:
            unit = quantity.unit
            if name == "amplitude" and isinstance(motion, str):
                unit = unit_of_amplitude(motion) or unit
            plain[name] = parts[0]
            uncertain.append(_uncertain(name, arguments[name], parts, unit))
    return plain, uncertain


def refuse_uncertainty(arguments: Mapping[str, object], where: str) -> None:
    """Raise InputError for the first argument with an uncertainty."""
    for name, value in arguments.items():
        if _parts(value) is not None:
            raise InputError(name, value, f"allowed is a quantity without uncertainty for {where}")


def _parts(value: object) -> tuple[str, str] | None:
    """Texts of a value and of its uncertainty; None where there is no uncertainty."""
    match = _SPREAD.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else (match[1], match[2])


def _uncertain(name: str, arguments: str, parts: tuple[str, str], unit: str) -> UncertainInput:
    """An uncertain input in the SI; raises InputError for an uncertainty that is none."""
    text, spread = parts
    try:
        value = read(name, text, unit, low=QUANTITIES[name].low).si
        if spread.endswith("%") and not text.endswith("%"):
            size = abs(value) * read(name, spread, "", low_open=False).si
        else:
            size = read(name, spread, unit, low_open=False).si
    except InputError as error:
        allowed = f"in it {error.value!r}: {error.allowed}, as in '10 N +- 5 %'"
        raise InputError(name, arguments, allowed) from None
    if not size < abs(value):
        raise InputError(name, arguments, "allowed is a spread below the value")
    return UncertainInput(name, " ".join(arguments.split()), value - size, value + size)


def with_uncertainty(
    found: Prediction,
    motion: str,
    plain: Mapping[str, Any],
    uncertain: list[UncertainInput],
    answer: Callable[[Request], Prediction],
) -> Prediction:
    """A Prediction for central values, with the uncertainty that follows from the inputs.

    plain: arguments at the central values; answered: answered(request) -> Prediction.
    """

    def request_at(changes: Mapping[str, float]) -> Request:
        return request_of(motion, {**plain, **changes})

    def at_end(name: str, end: float) -> Prediction | None:
        try:
            return answer(request_at({name: end}))
        except NotAttainedError:
            return None
        except InputError as error:
            problem = f"at an end of its spread, {end:.6g}: {error.argument}: {error.allowed}"
            raise InputError(name, plain[name], problem) from None

    ends: Ends = {
        one.name: (at_end(one.name, one.low), at_end(one.name, one.high)) for one in uncertain
    }
    columns: dict[str, Any] = {
        column: math.sqrt(sum(_half_of_difference(*pair, name) ** 2 for pair in ends.values()))
        for name, column in SPREADS.items()
        if getattr(found, name, None) is not None
    }
    columns |= uncertainty_of_outcomes(found, uncertain, request_at, ends)
    if columns.get("probability_runs_away", 0.0) > EXCLUDED:
        columns["speed_spread_m_s"] = math.inf
    texts = {one.name: one.text for one in uncertain}
    return replace(found, uncertainty=columns, understood=found.understood | texts)


def _half_of_difference(low: Prediction | None, high: Prediction | None, name: str) -> float:
    """Half the difference of a field of both; infinite where one of them has no value, because
    nothing has the wanted reduction, or the contact runs away."""
    if low is None or high is None:
        return math.inf
    half = 0.5 * (getattr(high, name) - getattr(low, name))
    return math.inf if math.isnan(half) else half
