"""Uncertainty of the static limit and probability of each outcome under a force.

The uncertain inputs are independent and normally distributed.  A low-discrepancy sequence draws
them; the same request always gets the same draws.  Forces and amplitudes of a draw follow from
those along each input alone, whose logarithms add up: this is exact for power laws, such as those
of Hertz.  Friction at vanishing speed is a function of the amplitude, solved at a few of them.

A draw beyond the physical range is replaced by the closest physical value: a negative amplitude,
load, force or coefficient of friction by 0, a Poisson's ratio above 0.5 by 0.5.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from microslip.foundation.errors import InputError
from microslip.si.dimensionless import parts
from microslip.si.motions import COMBINED
from microslip.si.prediction import Prediction
from microslip.si.printed_lines import FIRST_ORDER, QUANTILES
from microslip.si.request import Request
from microslip.si.static_curve import static_limits
from microslip.si.static_limit import equals_static_limit, largest_force

DRAWS = 2**16
"""Number of draws: their error of a probability is below 1e-3."""
DEVIATIONS = np.linspace(-4.0, 4.0, 17)
"""Standard deviations from the central value at which the closed forms of a contact are tabulated;
1 in 16000 draws lies beyond."""
SMALLEST_SHARE = 1e-2
"""Least value of a positive quantity that is tabulated, over its central value; where 0 is not a
physical value, smaller draws are replaced by it."""
BISECTIONS = 12
"""Bisections of the end of the values that predict accepts: to 2**-12 of half a deviation."""
TOWARDS_ZERO = 2.0
"""Largest ratio of neighbouring tabulated values between that and the central value: an
interpolation of logarithms is exact for power laws, and others vary little over a factor of 2."""
SAME_SHARE = 9
"""Decimal of a share of the amplitude below which a change is rounding."""
INTERVAL = 0.025, 0.975
"""Quantiles of an interval with 95 % probability."""
DEVIATIONS_OF_INTERVAL = 1.959964
"""Standard deviations from the centre of a normal distribution to the ends of such an interval."""


@dataclass(frozen=True)
class UncertainInput:
    """An argument of predict, as it was given, and one standard deviation below and above it, in
    SI units."""

    name: str
    text: str
    low: float
    high: float

    @property
    def value(self) -> float:
        return 0.5 * (self.low + self.high)

    @property
    def deviation(self) -> float:
        return 0.5 * (self.high - self.low)


Ends = Mapping[str, tuple[Prediction | None, Prediction | None]]
"""Predictions one standard deviation below and above, by the names of the inputs."""
RequestAt = Callable[[Mapping[str, float]], Request]
"""request_at(changes) -> Request with some arguments changed."""


@dataclass(frozen=True)
class _State:
    """Closed forms of one set of inputs: forces in N, the amplitude as a group, and what else the
    static limit depends on."""

    still: float
    largest: float
    amplitude: float | None
    mu: float
    poisson: float
    force: float | None
    shape: tuple


def uncertainty_of_outcomes(
    found: Prediction, inputs: list[UncertainInput], request_at: RequestAt, ends: Ends
) -> dict[str, Any]:
    """Columns of the uncertainty of the static limit and of the outcome.

    found: the Prediction for the central values.
    """
    request = request_at({})
    if request.sought is not None:
        return _normal_intervals(found, ends.values())
    share = equals_static_limit(request)
    draws = _draws(len(inputs))
    table = _Table(_state(request), inputs, request_at, draws)
    if table.centre.amplitude is None:
        static = None
    else:
        static = _static_of(found, request, table, ends, draws)
    fields: dict[str, Any] = {}
    if static is not None:
        value, error = static
        solved = table.one_shape or not table.centre.amplitude
        fields["interval_method"] = QUANTILES if solved else FIRST_ORDER
        fields |= _distribution("mu_static", value)
        fields |= _distribution("mu_static_apparent", table.mu * value)
    if share is True:
        assert static is not None  # as of all that oscillate
        value, error = static
    elif share is not None:
        value, error = np.full(DRAWS, share), np.zeros(DRAWS)
    if share is not None:
        fields |= _distribution("force_threshold", table.still * value, "_N")
    if request.drive.force is None or table.force is None:
        return fields
    away = table.force >= table.largest
    fields["probability_runs_away"] = float(np.mean(away))
    fields["probability_error"] = _error_of_draws(away)
    if share is None:
        return fields
    fields |= _distribution("safety_factor", _ratio(table.still * value, table.force))
    stays = {
        sign: ~away & (table.force < table.still * (value + sign * error)) for sign in (0, -1, 1)
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
    """Error estimate of a probability: the difference of the shares in both halves of the draws,
    and at least log(DRAWS) / DRAWS, the order of the discrepancy of the sequence."""
    halves = [float(np.mean(outcome[first::2])) for first in (0, 1)]
    return max(abs(halves[0] - halves[1]), math.log(DRAWS) / DRAWS)


def _normal_intervals(
    found: Prediction, ends: Iterable[tuple[Prediction | None, Prediction | None]]
) -> dict[str, Any]:
    """Fields of the uncertainty where a draw would be a search for an amplitude, a speed or a load:
    to first order, from half the difference of the predictions at the ends of each input."""
    fields: dict[str, Any] = {"interval_method": FIRST_ORDER}
    for name, unit in (("mu_static", ""), ("mu_static_apparent", ""), ("force_threshold", "_N")):
        value = getattr(found, name + unit)
        if value is None:
            continue
        halves = [
            math.inf
            if low is None or high is None
            else 0.5 * (getattr(high, name + unit) - getattr(low, name + unit))
            for low, high in ends
        ]
        deviation = math.hypot(*halves)
        fields[f"{name}_spread{unit}"] = deviation
        fields[f"{name}_low{unit}"] = max(0.0, value - DEVIATIONS_OF_INTERVAL * deviation)
        fields[f"{name}_high{unit}"] = value + DEVIATIONS_OF_INTERVAL * deviation
    return fields


def _ratio(threshold: np.ndarray, force: np.ndarray) -> np.ndarray:
    """Threshold over force: infinite without a force, and 0 where the threshold is 0, too."""
    without = np.where(threshold > 0.0, math.inf, 0.0)
    return np.divide(threshold, force, out=without, where=force > 0.0)


def _distribution(name: str, draws: np.ndarray, unit: str = "") -> dict[str, Any]:
    """Standard deviation and interval of a quantity, some draws of which may be infinite."""
    low, high = np.quantile(draws, INTERVAL, method="nearest")
    return {
        f"{name}_spread{unit}": math.inf if np.isinf(draws).any() else float(np.std(draws)),
        f"{name}_low{unit}": float(low),
        f"{name}_high{unit}": float(high),
    }


def _draws(count: int) -> np.ndarray:
    """Independent standard normal numbers, shape (DRAWS, count): a Kronecker sequence whose
    irrational numbers are powers of the root of x^(count + 1) = x + 1."""
    from scipy.special import ndtri

    root = 2.0
    for _ in range(60):  # a contraction by at least 2 in every step
        root = (1.0 + root) ** (1.0 / (count + 1.0))
    steps = root ** -np.arange(1.0, count + 1.0)
    return ndtri(np.mod(0.5 + np.arange(1.0, DRAWS + 1.0)[:, None] * steps, 1.0))


def _state(request: Request) -> _State:
    contact, motion, still = request.contact, request.motion, request.still
    amplitude = request.groups[1]
    largest = still * largest_force(request)
    shape: tuple[object, ...] = (contact.pressure,)
    if amplitude and motion.name in COMBINED:
        shape += tuple(
            round(one / amplitude, SAME_SHARE) for one in parts(motion, contact).values()
        )
    force = request.drive.force
    return _State(still, largest, amplitude, contact.mu, contact.poisson, force, shape)


class _Table:
    """Closed forms at all draws, from those along each input alone: mu, forces in N, the logarithm
    of the amplitude, Poisson's ratio."""

    def __init__(
        self,
        centre: _State,
        inputs: list[UncertainInput],
        request_at: RequestAt,
        draws: np.ndarray,
    ):
        self.centre = centre
        self.one_shape = True
        logarithms = {name: math.log(getattr(centre, name)) for name in ("still", "mu")}
        logarithms["largest"] = _log(centre.largest)
        logarithms["amplitude"] = _log(centre.amplitude or 0.0)
        self.poisson = np.full(DRAWS, centre.poisson)
        self.force = None if centre.force is None else np.full(DRAWS, centre.force)
        broken, at_rest = np.zeros((2, DRAWS), dtype=bool)
        for column, one in zip(draws.T, inputs, strict=True):
            drawn = one.value + column * one.deviation
            signed = drawn * math.copysign(1.0, one.value)
            broken |= (signed <= 0.0) & (one.name in ("mu", "load"))
            at_rest |= (signed <= 0.0) & (one.name == "amplitude")
            places, states = _along(one, request_at)
            self.one_shape &= all(state.shape == centre.shape for state in states)
            where = np.log(np.maximum(signed, SMALLEST_SHARE * abs(one.value)))
            for name in logarithms:
                values = [_log(getattr(state, name) or 0.0) for state in states]
                change = np.array(values) - _log(getattr(centre, name) or 0.0)
                logarithms[name] = logarithms[name] + np.interp(where, places, change)
            change = np.array([state.poisson - centre.poisson for state in states])
            self.poisson += np.interp(where, places, change)
            if one.name == "force":
                self.force = np.maximum(drawn, 0.0)
        self.mu, self.still, self.largest = (
            np.where(broken, 0.0, np.exp(logarithms[name]) * np.ones(DRAWS))
            for name in ("mu", "still", "largest")
        )
        self.amplitude = np.where(at_rest, 0.0, np.exp(logarithms["amplitude"] * np.ones(DRAWS)))


SMALLEST_LOGARITHM = -700.0
"""Logarithm of the smallest number near 1e-304; that of 0 is replaced by it."""


def _log(value: float) -> float:
    return math.log(value) if value > 0.0 else SMALLEST_LOGARITHM


def _along(one: UncertainInput, request_at: RequestAt) -> tuple[np.ndarray, list[_State]]:
    """Logarithms of the size of an input, ascending, and the states there.

    Where predict refuses a value, the last one is at the end of the values that it accepts.
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
    found: Prediction,
    request: Request,
    table: _Table,
    ends: Ends,
    draws: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """mu_static of all draws and its error."""
    static, static_error = found.mu_static, found.mu_static_error
    assert static is not None and static_error is not None  # as of all that oscillate
    if not math.isfinite(static):
        return np.full(DRAWS, np.nan), np.full(DRAWS, np.inf)
    if not table.centre.amplitude:
        return np.full(DRAWS, static), np.full(DRAWS, static_error)
    if table.one_shape:
        centre = (table.centre.amplitude, table.centre.poisson, static, static_error)
        forces = None if table.force is None else (table.still, table.force)
        return static_limits(request, centre, table.amplitude, table.poisson, forces)
    value = np.full(DRAWS, static)
    for column, (low, high) in zip(draws.T, ends.values(), strict=True):
        changes = [
            0.0 if one is None or one.mu_static is None else one.mu_static - static
            for one in (low, high)
        ]
        value += np.where(column < 0.0, -column * changes[0], column * changes[1])
    return np.clip(value, 0.0, 1.0), np.full(DRAWS, static_error)
