"""Uncertain inputs: "0.3 +- 0.03", "10 N +- 5 %".

The number after +- is a standard uncertainty.  It is propagated by two predictions, at one standard
uncertainty below and above the value.  Half the difference between the predictions is the
contribution of the input.  The inputs are independent, so the total is the root of the sum of
squares (JCGM 100, Guide to the Expression of Uncertainty in Measurement, 5.1).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si.outcomes import Ends, UncertainInput, half_difference, uncertainty_of_outcomes
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import EXCLUDED
from microslip.si.quantities import Quantity
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request, request_of

SPREADS = {
    "mu_macro": "mu_macro_spread",
    "mu_apparent": "mu_apparent_spread",
    "friction_force_N": "friction_force_spread_N",
    "speed_m_s": "speed_spread_m_s",
    "sought_value": "sought_spread",
}
"""Columns with the standard uncertainties, keyed by attributes of a Prediction."""


def with_uncertainty(
    prediction: Prediction,
    motion: str,
    arguments: Mapping[str, Any],
    quantities: Mapping[str, Quantity],
    answer: Callable[[Request], Prediction],
) -> Prediction:
    """Add the uncertainty to a Prediction for the central values.

    Parameters
    ----------
    prediction : Prediction
        The Prediction for the central values, without its uncertainty.
    motion, arguments : str, mapping
        The motion, and the arguments of `predict`.
    quantities : mapping of Quantity
        The quantities among the arguments.
    answer : callable
        Function answer(request) -> Prediction.
    """

    def request_at(changes: Mapping[str, float]) -> Request:
        return request_of(motion, {**arguments, **changes})

    def at_end(name: str, end: float) -> Prediction | None:
        try:
            return answer(request_at({name: end}))
        except NotAttainedError:
            return None
        except InputError as error:
            problem = f"at one standard uncertainty, {end:.6g}: {error.argument}: {error.allowed}"
            raise InputError(name, arguments[name], problem) from None

    uncertain = [
        UncertainInput(name, one.si - one.deviation, one.si + one.deviation)
        for name, one in quantities.items()
        if one.deviation is not None
    ]
    if not uncertain:
        return prediction
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
    return replace(prediction, uncertainty=columns)
