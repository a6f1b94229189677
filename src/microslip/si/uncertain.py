"""Uncertain inputs: "0.3 +- 0.03", "10 N +- 5 %".

The number after +- is a standard uncertainty.  It is propagated by two predictions, at one standard
uncertainty below and above the value.  Half the difference between the predictions is the
contribution of the input.  The inputs are independent, so the total is the root of the sum of
squares (JCGM 100, Guide to the Expression of Uncertainty in Measurement, 5.1).
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si.inputs import QUANTITIES, unit_of
from microslip.si.outcomes import Ends, UncertainInput, half_difference, uncertainty_of_outcomes
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import EXCLUDED
from microslip.si.quantities import read
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request, request_of

EXACT = ("phase", "density", "counter_density", "reduction")
"""Quantities that are always exact."""
SPREADS = {
    "mu_macro": "mu_macro_spread",
    "mu_apparent": "mu_apparent_spread",
    "friction_force_N": "friction_force_spread_N",
    "speed_m_s": "speed_spread_m_s",
    "sought_value": "sought_spread",
}
"""Columns with the standard uncertainties, keyed by attributes of a Prediction."""
_SPREAD = re.compile(r"(.*?)\s*(?:\+-|\+/-|±)\s*(.*)", re.S)


def without_uncertainty(
    motion: object, arguments: Mapping[str, Any]
) -> tuple[dict[str, Any], list[UncertainInput]]:
    """Central values of the arguments of `predict`, and a list of the uncertain inputs.

    Raises InputError for a text with an invalid uncertainty.
    """
    plain, uncertain = dict(arguments), []
    for name in QUANTITIES:
        parts = None if name in EXACT else _parts(arguments.get(name))
        if parts is not None:
            plain[name] = parts[0]
            uncertain.append(_uncertain(name, arguments[name], parts, unit_of(name, motion)))
    return plain, uncertain


def refuse_uncertainty(arguments: Mapping[str, object], where: str) -> None:
    """Raise InputError for the first argument with an uncertainty.  where: description of the
    command."""
    for name, value in arguments.items():
        if _parts(value) is not None:
            raise InputError(name, value, f"allowed is a quantity without uncertainty for {where}")


def _parts(value: object) -> tuple[str, str] | None:
    """Texts of a value and of its uncertainty, or None for an exact value."""
    match = _SPREAD.fullmatch(value) if isinstance(value, str) else None
    return None if match is None else (match[1], match[2])


def _uncertain(name: str, value: str, parts: tuple[str, str], unit: str) -> UncertainInput:
    """An uncertain input in SI units.  Raises InputError if the text is invalid."""
    text, spread = parts
    try:
        centre = read(name, text, unit, low=QUANTITIES[name].low).si
        if spread.endswith("%") and not text.endswith("%"):
            size = abs(centre) * read(name, spread, "", low_open=False).si
        else:
            size = read(name, spread, unit, low_open=False).si
    except InputError as error:
        allowed = f"in it {error.value!r}: {error.allowed}, as in '10 N +- 5 %'"
        raise InputError(name, value, allowed) from None
    if not size < abs(centre):
        raise InputError(name, value, "allowed is an uncertainty below the value")
    return UncertainInput(name, " ".join(value.split()), centre - size, centre + size)


def with_uncertainty(
    prediction: Prediction,
    motion: str,
    plain: Mapping[str, Any],
    uncertain: list[UncertainInput],
    answer: Callable[[Request], Prediction],
) -> Prediction:
    """Add the uncertainty to a Prediction for the central values.

    Parameters
    ----------
    prediction : Prediction
        The Prediction for the central values, without its uncertainty.
    motion : str
        The motion.
    plain : mapping
        Arguments of `predict` with the central values.
    uncertain : list of UncertainInput
        The uncertain arguments.
    answer : callable
        Function answer(request) -> Prediction.
    """

    def request_at(changes: Mapping[str, float]) -> Request:
        return request_of(motion, {**plain, **changes})

    def at_end(name: str, end: float) -> Prediction | None:
        try:
            return answer(request_at({name: end}))
        except NotAttainedError:
            return None
        except InputError as error:
            problem = f"at one standard uncertainty, {end:.6g}: {error.argument}: {error.allowed}"
            raise InputError(name, plain[name], problem) from None

    ends: Ends = {
        one.name: (at_end(one.name, one.low), at_end(one.name, one.high)) for one in uncertain
    }
    columns: dict[str, Any] = {
        column: math.sqrt(sum(half_difference(*pair, name) ** 2 for pair in ends.values()))
        for name, column in SPREADS.items()
        if getattr(prediction, name, None) is not None
    }
    columns |= uncertainty_of_outcomes(prediction, uncertain, request_at, ends)
    if columns.get("probability_runs_away", 0.0) > EXCLUDED:
        columns["speed_spread_m_s"] = math.inf
    texts = {one.name: one.text for one in uncertain}
    return replace(prediction, uncertainty=columns, understood=prediction.understood | texts)
