"""Checks that judge the parts of the paper's statements.

Each part has a function that takes the study and the runs and returns checks. Most parts compare
values of runs with a formula. For these parts, `_judge` builds the function from a source of
values, a formula and a margin. The error of a margin is the value's error estimate.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from microslip.config.settings import Claims
from microslip.studies.claims import claims
from microslip.studies.claims import static_limits as static
from microslip.studies.claims.runs import Run, Runs, friction
from microslip.studies.claims.statements import (
    AGREES,
    ALIGNED,
    ALTERNATES,
    BESIDE,
    CRITERIA,
    FAR,
    GOOD,
    LARGE_BORE,
    ON_BOUND,
    RELATIVE,
    SLIGHT,
    TURNING_BORE,
    VANISHES,
)
from microslip.studies.claims.verdicts import Check
from microslip.studies.tables import value_of
from microslip.theory import constant_stiffness, paper

Checks = Callable[[Claims, Runs], Iterable[Check]]
Margin = Callable[[float, float], float]
"""Function that returns a margin from a computed value and its reference. The margin is positive if
the part holds."""
Values = Callable[[Claims, Runs], Iterable[tuple[dict[str, float], float, float, Sequence[Run]]]]
"""Source of values: a function that yields tuples (place, value, error estimate, runs)."""
Amplitudes = Callable[[float], bool]
"""Function that returns True for the amplitudes that a part applies to."""


def check(
    value: float, against: float, margin: float, error: float, runs: Sequence[Run], **place: float
) -> Check:
    """Return a Check with plain numbers and the keys of its runs."""
    numbers = (float(value), float(against), float(margin), float(error))
    return Check(*numbers, tuple(run.key for run in runs), tuple(place.items()))


def above(value: float, against: float) -> float:
    """Return the margin by which the computed value is above its reference."""
    return value - against


def below(value: float, against: float) -> float:
    """Return the margin by which the computed value is below its reference."""
    return against - value


def within(limit: float) -> Margin:
    """Return the margin function for a distance that must be at most `limit`."""
    return lambda value, against: limit - abs(value - against)


def _judge(values: Values, formula: Callable[..., Any], margin: Margin) -> Checks:
    """Return a function that checks each value against a formula at the value's place."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for place, value, error, behind in values(study, runs):
            against = formula(*place.values())
            yield check(value, against, margin(value, against), error, behind, **place)

    return checks


def _nearer(values: Values, formula: Callable[..., Any], other: Callable[..., Any]) -> Checks:
    """Return a function that checks whether a formula is nearer to each value than another formula.

    An error of the value can change each of the two distances, so it counts twice.
    """

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for place, value, error, behind in values(study, runs):
            against, second = (float(eq(*place.values())) for eq in (formula, other))
            margin = abs(second - value) - abs(against - value)
            yield check(value, against, margin, 2.0 * error, behind, **place)

    return checks


# Sources of values


def _friction(requests: Callable[[Claims], Iterable[dict]], *names: str) -> Values:
    """Return a source that yields the friction of each request.

    names: entries of a request that form the place.
    """

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for request in requests(study):
            run = runs(request)
            yield {name: float(request[name]) for name in names}, *friction(run), [run]

    return values


def _map(motion: str, chosen: Amplitudes = lambda amplitude: True) -> Values:
    """Return a source that yields a motion's friction at all its amplitudes and velocities."""
    return _friction(
        lambda study: (
            claims.point(study, motion, velocity, amplitude)
            for amplitude in filter(chosen, study.amplitude[motion])
            for velocity in claims.velocities(study)
        ),
        "amplitude",
        "velocity",
    )


def _slow(motion: str, chosen: Amplitudes, velocity: float | None = None) -> Values:
    """Return a source that yields friction at one velocity, at amplitudes with static friction.

    velocity: by default the smallest velocity of the study.
    """
    return _friction(
        lambda study: (
            claims.point(study, motion, velocity or claims.velocities(study)[0], amplitude)
            for amplitude in filter(chosen, claims.limited(study, motion))
        ),
        "amplitude",
    )


def _limit(motion: str, chosen: Amplitudes) -> Values:
    """Return a source that yields a motion's static limit at each amplitude."""

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for amplitude in filter(chosen, claims.limited(study, motion)):
            yield {"amplitude": amplitude}, *static.limit(study, runs, motion, amplitude)

    return values


def _closed_limit(low: float = 0.0) -> Values:
    """Return a source that yields the bore's closed-form static limit at amplitudes >= `low`."""
    return _friction(
        lambda study: (
            claims.point(study, "bore", 0.0, a) for a in study.amplitude["bore"] if a >= low
        ),
        "amplitude",
    )


def _limit_on_rings() -> Values:
    """Return a source that yields the bore's static limit on rings at each amplitude."""
    return _friction(
        lambda study: (
            claims.resolved_limit(study, "bore", a) for a in claims.limited(study, "bore")
        ),
        "amplitude",
    )


def _end(quantity: str) -> Values:
    """Return a source that yields the value of a quantity at the end of each transient.

    The error is the sum of two terms: the difference from a run with half as many rings, and the
    change over the last tenth of the forward travel.
    """

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for start in claims.STARTS:
            two = [runs(claims.transient(start, cells)) for cells in claims.CELLS]
            fine, coarse = (np.asarray(run.result[quantity], float) for run in two)
            tail = fine[-max(fine.size // 10, 2) :]
            error = abs(fine[-1] - coarse[-1]) + np.abs(tail - fine[-1]).max()
            yield {"velocity": claims.TRANSIENT_VELOCITY}, fine[-1], error, two

    return values


def _field(index: int) -> Values:
    """Return a source that yields one of the two numbers that `_tractions` returns.

    The error is the difference from a run with half as many rings.
    """

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for velocity in claims.FIELD_VELOCITIES:
            two = [runs(claims.field(velocity, cells)) for cells in claims.CELLS]
            fine, coarse = (_tractions(run)[index] for run in two)
            yield {"velocity": velocity}, fine, abs(fine - coarse), two

    return values


def _tractions(run: Run) -> tuple[float, float]:
    """Return the smallest ratio of traction to friction bound, and the largest angle in degrees.

    The angle is between the tractions and Eq 15.
    """
    names = ("traction_lateral", "traction_forward", "bound", "lateral_position")
    lateral, forward, bound, across = (np.asarray(run.result[n], float) for n in names)
    along = np.asarray(run.result["forward_position"], float)
    size = np.hypot(lateral, forward)
    wanted = paper.steady_bore_traction(across, along, float(run.request["velocity"]))
    turned = np.arctan2(
        wanted[0] * forward - wanted[1] * lateral, wanted[0] * lateral + wanted[1] * forward
    )
    return float((size / bound).min()), float(np.degrees(np.abs(turned).max()))


def _flat_end(study: Claims, runs: Runs) -> Iterator[tuple]:
    """Yield friction under an oscillating indentation, for a contact with constant stiffness.

    For an indenter with exponent n, the friction differs from that of a flat end by a power series
    in 1/n. The extrapolated value has a third-order error. Its error estimate is the difference
    from the first-order extrapolation.
    """
    for amplitude, velocity in claims.stiff_points():
        behind = [
            runs(claims.stiff(study, amplitude, velocity, n)) for n in claims.STIFF_EXPONENTS[::-1]
        ]
        (fine, error), (middle, second), (coarse, third) = map(friction, behind)
        first_order = 2.0 * fine - middle
        value = (8.0 * fine - 6.0 * middle + coarse) / 3.0
        error = abs(value - first_order) + (8.0 * error + 6.0 * second + third) / 3.0
        yield {"amplitude": amplitude, "velocity": velocity}, value, error, behind


# Formulas


def _rigid(amplitude: float, velocity: float) -> Any:
    return paper.large_amplitude_transverse(velocity, amplitude)


def _steady(amplitude: float, velocity: float) -> float:
    return float(paper.large_amplitude_bore(velocity))


# Checks of other forms


def _rigid_below_squares(study: Claims, runs: Runs) -> Iterator[Check]:
    """Compare Eq 6 with the paper's own runs.

    The error of such a run is its difference from a run at the study's tolerance.
    """
    for amplitude in claims.sliding(study):
        place = {"amplitude": amplitude, "velocity": claims.PAPER_VELOCITY}
        own = runs(claims.paper_run("transverse", amplitude))
        point = runs(claims.point(study, "transverse", claims.PAPER_VELOCITY, amplitude))
        accurate, its_error = friction(point)
        mu = value_of(own.result, "mu_macro")
        eq = float(_rigid(amplitude, claims.PAPER_VELOCITY))
        yield check(mu, eq, mu - eq, its_error + abs(mu - accurate), [own, point], **place)


def _steady_nears(study: Claims, runs: Runs) -> Iterator[Check]:
    for before, amplitude in pairwise(study.amplitude["bore"]):
        for velocity in claims.velocities(study):
            two = [runs(claims.point(study, "bore", velocity, a)) for a in (amplitude, before)]
            (mu, error), (other, its_error) = map(friction, two)
            eq = _steady(amplitude, velocity)
            margin = abs(other - eq) - abs(mu - eq)
            place = {"amplitude": amplitude, "velocity": velocity}
            yield check(mu, eq, margin, error + its_error, two, **place)


def _rises(rows: Callable[[Claims], Iterable[list[dict]]], *names: str) -> Checks:
    """Return checks that compare each request in a row with the next faster one."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for row in rows(study):
            for slow, fast in pairwise(row):
                two = [runs(fast), runs(slow)]
                (mu, error), (before, its_error) = map(friction, two)
                place = {name: float(fast[name]) for name in names}
                yield check(mu, before, mu - before, error + its_error, two, **place)

    return checks


def _rises_on_map(motion: str) -> Checks:
    return _rises(
        lambda study: [row for row in claims.rows(study) if row[0]["motion"] == motion],
        "amplitude",
        "velocity",
    )


# Periods of the oscillating bore


def _periods(
    judge: Callable[[np.ndarray, np.ndarray, float], tuple[float, float, float]],
) -> Checks:
    """Return checks of periods. A margin's error is its change with half as many rings.

    judge: function of (right, left, cell) that returns a value, its reference and the margin.
    right, left: stick area in each half, divided by the contact area, shape (steps,). cell: area of
    the smallest cell, divided by the contact area.
    """

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for velocity, amplitude in claims.periods(study):
            place = {"amplitude": amplitude, "velocity": velocity}
            requests = [claims.period(study, velocity, amplitude, c) for c in (False, True)]
            two = [runs(request) for request in requests]
            if all(value_of(run.result, "converged", bool) for run in two):
                (value, against, margin), (*_, coarse) = (judge(*_sticking(run)) for run in two)
                yield check(value, against, margin, abs(margin - coarse), two, **place)
            else:
                yield check(np.nan, np.nan, np.nan, np.inf, two, **place)

    return checks


def _sticking(run: Run) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the arguments of `judge` in `_periods`."""
    right, left = (np.asarray(run.result[f"stick_{side}"][1:], float) for side in ("right", "left"))
    return right, left, min(run.result["area"]) / np.pi


def _some_sticks(right: np.ndarray, left: np.ndarray, cell: float) -> tuple[float, float, float]:
    least = (right + left).min()
    return least, cell, least - cell


def _alternates(right: np.ndarray, left: np.ndarray, _: float) -> tuple[float, float, float]:
    half = right.size // 2
    least = int(np.argmin((right + left)[:half]))
    leads = []
    for k in (least, least + half):
        total = right[k] + left[k]
        leads.append((left[k] - right[k]) / total if total > 0 else 0.0)
    # Each side must lead once. The smaller of the two leads counts.
    lead = max(min(leads[0], -leads[1]), min(-leads[0], leads[1]))
    return lead, ALTERNATES, lead - ALTERNATES


# Parts


def _below_one(amplitude: float) -> bool:
    return amplitude < 1.0  # static friction vanishes at larger amplitudes


def _above_turning(amplitude: float) -> bool:
    return amplitude > TURNING_BORE


def _below_turning(amplitude: float) -> bool:
    return amplitude < TURNING_BORE


def _not_zero(limits: Values) -> Checks:
    return _judge(limits, lambda amplitude: 0.0, lambda mu, _: mu - VANISHES)


ZONE, PRINTED = paper.static_bore, paper.static_bore_printed
CHECKS: dict[str, Checks] = {
    "rigid_below": _judge(_map("transverse"), _rigid, above),
    "rigid_near": _judge(_map("transverse"), _rigid, within(SLIGHT)),
    "rigid_below_squares": _rigid_below_squares,
    "slider_above": _judge(_limit("transverse", _below_one), paper.static_slider, below),
    "zone_nearer": _nearer(
        _limit("transverse", _below_one), paper.static_transverse, paper.static_slider
    ),
    "slider_above_march": _judge(_slow("transverse", _below_one), paper.static_slider, below),
    "zone_above": _judge(_limit("transverse", _below_one), paper.static_transverse, below),
    "force_settles": _judge(_end("force_forward"), paper.bore_forward, within(AGREES)),
    "torque_settles": _judge(_end("torque"), paper.bore_torque, within(AGREES)),
    "force_steady": _judge(
        _friction(claims.steady, "velocity"), paper.bore_forward, within(AGREES)
    ),
    "on_bound": _judge(_field(0), lambda velocity: ON_BOUND, above),
    "aligned": _judge(_field(1), lambda velocity: ALIGNED, below),
    "steady_near": _judge(_map("bore", lambda a: a >= LARGE_BORE), _steady, within(GOOD)),
    "steady_nears": _steady_nears,
    "steady_near_below": _judge(_map("bore", lambda a: a < LARGE_BORE), _steady, within(GOOD)),
    "bore_zone_near": _judge(_limit("bore", _above_turning), ZONE, within(GOOD)),
    "bore_zone_relative": _judge(
        _limit("bore", _above_turning), ZONE, lambda mu, eq: RELATIVE * mu - abs(eq - mu)
    ),
    "bore_zone_above": _judge(_limit("bore", _below_turning), ZONE, below),
    "bore_zone_seen": _judge(
        _slow("bore", _above_turning, claims.PAPER_VELOCITY), ZONE, within(GOOD)
    ),
    "bore_zone_above_march": _judge(_slow("bore", _below_turning), ZONE, below),
    "bore_zone_printed": _judge(_limit("bore", _above_turning), PRINTED, within(GOOD)),
    "some_sticks": _periods(_some_sticks),
    "alternates": _periods(_alternates),
    "limit_positive": _not_zero(_closed_limit()),
    "limit_positive_rings": _not_zero(_limit_on_rings()),
    "limit_asymptote": _judge(
        _closed_limit(FAR), static.asymptote, lambda mu, far: RELATIVE * far - abs(mu - far)
    ),
    "rises_transverse": _rises_on_map("transverse"),
    "rises_bore": _rises_on_map("bore"),
    "rises_continuous_bore": _rises(lambda study: [claims.steady(study)], "velocity"),
    "sine_near": _judge(_flat_end, constant_stiffness.sum_of_powers, within(GOOD)),
    "sine_nearer": _nearer(
        _flat_end, constant_stiffness.sum_of_powers, constant_stiffness.single_power
    ),
    "sine_below": _judge(_flat_end, constant_stiffness.sum_of_powers, above),
}
"""For each part, by name: the function that returns its checks."""


@dataclass(frozen=True)
class Part:
    """One aspect of a statement that numbers can confirm or refute.

    Attributes
    ----------
    claim : int
        Number of the statement.
    name : str
        Name of the part.
    text : str
        The criterion.
    checks : callable
        Function (study, runs) that returns the checks.
    counts : bool
        True if the verdict on the statement depends on the part.
    """

    claim: int
    name: str
    text: str
    checks: Checks
    counts: bool


PARTS = tuple(
    Part(claim, name, text, CHECKS[name], name not in BESIDE)
    for claim, criteria in CRITERIA.items()
    for name, text in criteria.items()
)
