"""Uncertainty of the static limit and probability of each outcome under a force.

The uncertain inputs are independent and normally distributed.  The draws form a low-discrepancy
sequence, so that equal requests have equal draws.  Forces and amplitudes are tabulated as functions
of one input at a time.  The changes in their logarithms are then added.  This is exact for power
laws, such as those of Hertz's theory.  The static limit is solved at a few amplitudes and
interpolated.

A draw outside the physical range is replaced by the closest physical value.  For example, a
negative load becomes 0, and a Poisson's ratio above 0.5 becomes 0.5.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import FIRST_ORDER, QUANTILES
from microslip.si.request import Request
from microslip.si.static_curve import static_limits
from microslip.si.static_limit import equals_static_limit, largest_force

DRAWS = 2**16
"""Number of draws.  The error of a probability is below 1e-3."""
DEVIATIONS = np.linspace(-4.0, 4.0, 17)
"""Nodes of the table along one input, in standard deviations from its central value.  One draw in
16000 is outside the table."""
SMALLEST_SHARE = 1e-2
"""Smallest tabulated value of a positive quantity, divided by the quantity's central value.  If 0
is not a physical value, this value replaces smaller draws."""
BISECTIONS = 12
"""Number of bisections in the search for the limit of the accepted values.  The limit is accurate
to 2**-12 times half a standard deviation."""
TOWARDS_ZERO = 2.0
"""Largest ratio between neighbouring nodes below the central value.  Interpolation of logarithms is
exact for power laws.  Other functions vary little over a factor of 2."""
SAME_SHARE = 9
"""Number of decimals used to compare amplitude ratios.  Further digits are rounding errors."""
INTERVAL = 0.025, 0.975
"""Probabilities of the quantiles at the ends of a 95 % interval."""
DEVIATIONS_OF_INTERVAL = 1.959964
"""Half the width of a 95 % interval of a normal distribution, in standard deviations."""


@dataclass(frozen=True)
class UncertainInput:
    """An uncertain argument of `predict`.

    Attributes
    ----------
    name : str
        Name of the argument.
    low, high : float
        The value minus and plus one standard deviation, in SI units.
    """

    name: str
    low: float
    high: float

    @property
    def value(self) -> float:
        return 0.5 * (self.low + self.high)

    @property
    def deviation(self) -> float:
        return 0.5 * (self.high - self.low)


Ends = Mapping[str, tuple[Prediction | None, Prediction | None]]
"""For each input, by name: predictions at one standard deviation below and above its value.  A
prediction is None if it has no solution."""
RequestAt = Callable[[Mapping[str, float]], Request]
"""Function request_at(changes) -> Request.  changes: values of arguments by name."""


class _State(NamedTuple):
    """Closed-form quantities for one set of inputs.

    Attributes
    ----------
    mu, still, largest, amplitude, poisson : float
        Coefficient of friction, dimensionless; friction without vibration and smallest force at
        which the contact runs away, N; dimensionless amplitude (0 without an oscillation);
        Poisson's ratio.
    shape : tuple
        All other quantities on which the static limit depends.
    """

    mu: float
    still: float
    largest: float
    amplitude: float
    poisson: float
    shape: tuple


class _Draws(NamedTuple):
    """Quantities of a _State at each draw, shape (DRAWS,), and the prescribed force, N.

    `one_shape` is True if all tabulated states have the same shape.
    """

    mu: np.ndarray
    still: np.ndarray
    largest: np.ndarray
    amplitude: np.ndarray
    poisson: np.ndarray
    force: np.ndarray | None
    one_shape: bool


def outcome_columns(
    prediction: Prediction,
    request: Request,
    inputs: list[UncertainInput],
    request_at: RequestAt,
    ends: Ends,
) -> dict[str, Any]:
    """Columns for the uncertainty of the static limit and for the probabilities of the outcomes.

    prediction, request: the Prediction and the Request for the central values.
    """
    if request.sought is not None:
        return _normal_intervals(prediction, ends.values())
    share = equals_static_limit(request)
    numbers = _normal_numbers(len(inputs))
    draws = _at(numbers, request, inputs, request_at)
    fields: dict[str, Any] = {}
    if not request.motion.steady:
        value, error = _static_of(prediction, request, draws, ends, numbers)
        solved = draws.one_shape or not request.groups[1]
        fields["interval_method"] = QUANTILES if solved else FIRST_ORDER
        fields |= _distribution("mu_static", value)
        fields |= _distribution("mu_static_apparent", draws.mu * value)
    if share is not None and share is not True:
        value, error = np.full(DRAWS, share), np.zeros(DRAWS)
    if share is not None:
        fields |= _distribution("force_threshold", draws.still * value, "_N")
    if draws.force is None:
        return fields
    away = draws.force >= draws.largest
    fields["probability_runs_away"] = float(np.mean(away))
    fields["probability_error"] = _error_of_draws(away)
    if share is None:
        return fields
    fields |= _distribution("safety_factor", _ratio(draws.still * value, draws.force))
    stays = {
        sign: ~away & (draws.force < draws.still * (value + sign * error)) for sign in (0, -1, 1)
    }
    probability = {sign: float(np.mean(one)) for sign, one in stays.items()}
    fields["probability_stays"] = probability[0]
    fields["probability_moves"] = max(0.0, 1.0 - probability[0] - fields["probability_runs_away"])
    fields["probability_error"] = max(
        *(abs(probability[sign] - probability[0]) for sign in (-1, 1)),
        _error_of_draws(away),
        _error_of_draws(stays[0]),
    )
    return fields


def _error_of_draws(outcome: np.ndarray) -> float:
    """Error estimate of a probability.  outcome: array that is True for each draw with this
    outcome.

    The estimate is the difference between the even and the odd draws.  It is at least log(DRAWS) /
    DRAWS, the order of the sequence's discrepancy.
    """
    halves = [float(np.mean(outcome[first::2])) for first in (0, 1)]
    return max(abs(halves[0] - halves[1]), math.log(DRAWS) / DRAWS)


def half_difference(low: Prediction | None, high: Prediction | None, name: str) -> float:
    """Half the difference between two predictions in the field `name`.

    It is infinite if, in one prediction, there is no solution or the contact runs away.
    """
    if low is None or high is None:
        return math.inf
    half = 0.5 * (getattr(high, name) - getattr(low, name))
    return math.inf if math.isnan(half) else half


def _normal_intervals(
    prediction: Prediction, ends: Iterable[tuple[Prediction | None, Prediction | None]]
) -> dict[str, Any]:
    """Columns for the uncertainty of a search result, to first order in each input.

    Draws are not used, because each draw would need a separate search.
    """
    fields: dict[str, Any] = {"interval_method": FIRST_ORDER}
    for name, unit in (("mu_static", ""), ("mu_static_apparent", ""), ("force_threshold", "_N")):
        value = getattr(prediction, name + unit)
        if value is None:
            continue
        deviation = math.hypot(*(half_difference(*pair, name + unit) for pair in ends))
        fields[f"{name}_spread{unit}"] = deviation
        fields[f"{name}_low{unit}"] = max(0.0, value - DEVIATIONS_OF_INTERVAL * deviation)
        fields[f"{name}_high{unit}"] = value + DEVIATIONS_OF_INTERVAL * deviation
    return fields


def _ratio(threshold: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Threshold divided by force.  It is infinite if only the force is 0, and 0 if both are 0."""
    without = np.where(threshold > 0.0, math.inf, 0.0)
    return np.divide(threshold, force, out=without, where=force > 0.0)


def _distribution(name: str, draws: np.ndarray, unit: str = "") -> dict[str, Any]:
    """Columns for the standard deviation and the 95 % interval.  Draws can be infinite."""
    low, high = np.quantile(draws, INTERVAL, method="nearest")
    return {
        f"{name}_spread{unit}": math.inf if np.isinf(draws).any() else float(np.std(draws)),
        f"{name}_low{unit}": float(low),
        f"{name}_high{unit}": float(high),
    }


def _normal_numbers(count: int) -> np.ndarray:
    """Draws of independent standard normal numbers, shape (DRAWS, count).

    They form a Kronecker sequence.  Its irrational numbers are powers of the root of
    x^(count + 1) = x + 1.
    """
    from scipy.special import ndtri

    root = 2.0
    for _ in range(60):  # each step reduces the error by at least a factor of 2
        root = (1.0 + root) ** (1.0 / (count + 1.0))
    steps = root ** -np.arange(1.0, count + 1.0)
    return ndtri(np.mod(0.5 + np.arange(1.0, DRAWS + 1.0)[:, None] * steps, 1.0))


def _state(request: Request) -> _State:
    contact, motion, still = request.contact, request.motion, request.still
    amplitude = request.groups[1] or 0.0
    shape: tuple[object, ...] = (contact.pressure,)
    if amplitude and motion.several:
        shape += tuple(round(one / amplitude, SAME_SHARE) for one in request.parts.values())
    if motion.stroke is not None and not motion.stroke.columns.keys() <= {"forward", "lateral"}:
        shape += (contact.load, contact.contact_radius)
    largest = still * largest_force(request)
    return _State(contact.mu, still, largest, amplitude, contact.poisson, shape)


def _at(
    numbers: np.ndarray, request: Request, inputs: list[UncertainInput], request_at: RequestAt
) -> _Draws:
    """The draws, interpolated along one input at a time.  numbers: normal numbers, shape (DRAWS,
    inputs)."""
    centre, force, one_shape = _state(request), request.drive.force, True
    forces = None if force is None else np.full(DRAWS, force)
    poisson = np.full(DRAWS, centre.poisson)
    logarithms = {
        name: np.full(DRAWS, _log(getattr(centre, name)))
        for name in ("mu", "still", "largest", "amplitude")
    }
    broken, at_rest = np.zeros((2, DRAWS), dtype=bool)
    for column, one in zip(numbers.T, inputs, strict=True):
        drawn = one.value + column * one.deviation
        signed = drawn * math.copysign(1.0, one.value)
        broken |= (signed <= 0.0) & (one.name in ("mu", "load"))
        at_rest |= (signed <= 0.0) & (one.name == "amplitude")
        places, states = _along(one, request_at)
        one_shape &= all(state.shape == centre.shape for state in states)
        where = np.log(np.maximum(signed, SMALLEST_SHARE * abs(one.value)))
        for name in logarithms:
            change = np.array([_log(getattr(state, name)) for state in states])
            logarithms[name] += np.interp(where, places, change - _log(getattr(centre, name)))
        change = np.array([state.poisson - centre.poisson for state in states])
        poisson += np.interp(where, places, change)
        if one.name == "force":
            forces = np.maximum(drawn, 0.0)
    values = {name: np.where(broken, 0.0, np.exp(one)) for name, one in logarithms.items()}
    values["amplitude"] = np.where(at_rest, 0.0, np.exp(logarithms["amplitude"]))
    return _Draws(**values, poisson=poisson, force=forces, one_shape=one_shape)


SMALLEST_LOGARITHM = -700.0
"""Logarithm of a number near 1e-304, which replaces the logarithm of 0."""


def _log(value: float) -> float:
    return math.log(value) if value > 0.0 else SMALLEST_LOGARITHM


def _along(one: UncertainInput, request_at: RequestAt) -> tuple[np.ndarray, list[_State]]:
    """Logarithms of one input's absolute value at the nodes, in ascending order, and the states
    there.

    If `predict` rejects a node, the last node is at the limit of the accepted values.
    """
    sign = math.copysign(1.0, one.value)
    sizes = np.sort(sign * (one.value + DEVIATIONS * one.deviation))
    least = SMALLEST_SHARE * abs(one.value)
    within = sizes[sizes >= least]
    if within.size < sizes.size:
        count = math.ceil(math.log(within[0] / least) / math.log(TOWARDS_ZERO)) + 1
        within = np.concatenate([np.geomspace(least, within[0], count + 1)[:-1], within])

    def state_at(size: float) -> _State | None:
        try:
            return _state(request_at({one.name: sign * float(size)}))
        except InputError:
            return None

    def last_accepted(size: float, refused: float) -> float:
        for _ in range(BISECTIONS):
            middle = 0.5 * (size + refused)
            size, refused = (size, middle) if state_at(middle) is None else (middle, refused)
        return size

    states = {float(size): state_at(size) for size in within}
    for (size, state), (after, following) in pairwise(list(states.items())):
        if (state is None) != (following is None):
            pair = (after, size) if state is None else (size, after)
            end = last_accepted(*pair)
            states[end] = state_at(end)
    accepted = sorted(size for size, state in states.items() if state is not None)
    return np.log(accepted), [state for size in accepted if (state := states[size]) is not None]


def _static_of(
    prediction: Prediction, request: Request, draws: _Draws, ends: Ends, numbers: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """mu_static of all draws, and the error estimates.  numbers: see `_at`."""
    static, static_error = prediction.mu_static, prediction.mu_static_error
    assert static is not None and static_error is not None  # the motion oscillates
    if not math.isfinite(static):
        return np.full(DRAWS, np.nan), np.full(DRAWS, np.inf)
    if not request.groups[1]:
        return np.full(DRAWS, static), np.full(DRAWS, static_error)
    if draws.one_shape:
        forces = None if draws.force is None else (draws.still, draws.force)
        centre = static, static_error
        return static_limits(request, centre, draws.amplitude, draws.poisson, forces)
    value = np.full(DRAWS, static)
    for column, (low, high) in zip(numbers.T, ends.values(), strict=True):
        changes = [
            0.0 if one is None or one.mu_static is None else one.mu_static - static
            for one in (low, high)
        ]
        value += np.where(column < 0.0, -column * changes[0], column * changes[1])
    return np.clip(value, 0.0, 1.0), np.full(DRAWS, static_error)
