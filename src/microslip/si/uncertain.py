"""Uncertain inputs: "0.3 +- 0.03", "10 N +- 5 %".

The number after +- is a standard uncertainty.  It is propagated by two predictions, at one standard
uncertainty below and above the value.  Half the difference between the predictions is the
contribution of the input.  The inputs are independent, so the total is the root of the sum of
squares (JCGM 100, Guide to the Expression of Uncertainty in Measurement, 5.1).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

from microslip.foundation.errors import InputError
from microslip.si.outcomes import RequestAt, UncertainInput, half_difference, outcome_columns
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import EXCLUDED
from microslip.si.reduction import NotAttainedError
from microslip.si.request import Request

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
    request: Request,
    request_at: RequestAt,
    answer: Callable[[Request], Prediction],
) -> Prediction:
    """Add the uncertainty to a Prediction for the central values.

    Parameters
    ----------
    prediction, request : Prediction, Request
        The Prediction for the central values, without its uncertainty, and its Request.
    request_at, answer : callable
        Functions request_at(changes) -> Request and answer(request) -> Prediction.
    """
    uncertain = [
        UncertainInput(name, one.si - one.deviation, one.si + one.deviation)
        for name, one in request.inputs.quantities.items()
        if one.deviation is not None
    ]
    if not uncertain:
        return prediction

    def at_end(name: str, end: float) -> Prediction | None:
        try:
            return answer(request_at({name: end}))
        except NotAttainedError:
            return None
        except InputError as error:
            problem = f"at one standard uncertainty, {end:.6g}: {error.argument}: {error.allowed}"
            raise request.inputs.error(name, problem) from None

    ends = {one.name: (at_end(one.name, one.low), at_end(one.name, one.high)) for one in uncertain}
    columns: dict[str, Any] = {
        column: math.sqrt(sum(half_difference(*pair, name) ** 2 for pair in ends.values()))
        for name, column in SPREADS.items()
        if getattr(prediction, name, None) is not None
    }
    columns |= outcome_columns(prediction, request, uncertain, request_at, ends)
    if columns.get("probability_runs_away", 0.0) > EXCLUDED:
        columns["speed_spread_m_s"] = math.inf
    return replace(prediction, uncertainty=columns)
