"""Parts of the paper's statements, and the checks that judge them.

A part has a function (study, runs) -> checks. Most parts compare values of runs with a formula:
`_judge` makes their functions from a source of values, the formula and the margin. The error of a
margin is that of the values behind it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from microslip.config.settings import Claims
from microslip.studies.claims import claims as asked
from microslip.studies.claims import static_limits as static
from microslip.studies.claims.runs import Run, Runs, friction
from microslip.studies.claims.statements import (
    AGREES,
    ALIGNED,
    ALTERNATES,
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
from microslip.theory import paper

Checks = Callable[[Claims, Runs], Iterable[Check]]
Margin = Callable[[float, float], float]
"""Margin of a computed value against its reference, positive where the part holds."""


@dataclass(frozen=True)
class Part:
    """One thing that a statement says, in a form that a number can speak for or against.

    Attributes
    ----------
    claim : int
        Number of the statement.
    name : str
        Name of the part.
    text : str
        The criterion.
    checks : callable
        (study, runs) -> checks.
    counts : bool
        Whether the verdict on the statement depends on it.
    """

    claim: int
    name: str
    text: str
    checks: Checks
    counts: bool = True


def check(
    value: float, against: float, margin: float, error: float, runs: Sequence[Run], **place: float
) -> Check:
    """A Check with plain numbers, and the names of its runs."""
    numbers = (float(value), float(against), float(margin), float(error))
    return Check(*numbers, tuple(run.key for run in runs), tuple(place.items()))


def above(value: float, against: float) -> float:
    """Margin by which the computed value lies above its reference."""
    return value - against


def below(value: float, against: float) -> float:
    """Margin by which the computed value lies below its reference."""
    return against - value


def within(limit: float) -> Margin:
    """Margin of a distance of at most `limit`."""
    return lambda value, against: limit - abs(value - against)


# Values against a formula

Values = Callable[[Claims, Runs], Iterable[tuple[dict[str, float], float, float, Sequence[Run]]]]
"""Place, value, its error and the runs behind it, one after another."""


def _judge(values: Values, formula: Callable[..., Any], margin: Margin) -> Checks:
    """Checks of values against formula(*numbers of the place)."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for place, value, error, behind in values(study, runs):
            against = formula(*place.values())
            yield check(value, against, margin(value, against), error, behind, **place)

    return checks


def _friction(requests: Callable[[Claims], Iterable[dict]], *names: str) -> Values:
    """Friction of requested points; names: of the numbers of their place."""

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for request in requests(study):
            run = runs(request)
            yield {name: float(request[name]) for name in names}, *friction(run), [run]

    return values


def _map(motion: str, chosen: Callable[[float], bool] = lambda amplitude: True) -> Values:
    """Friction at all points of a motion, by amplitude and velocity."""
    return _friction(
        lambda study: (
            asked.point(study, motion, velocity, amplitude)
            for amplitude in filter(chosen, study.amplitude[motion])
            for velocity in asked.velocities(study)
        ),
        "amplitude",
        "velocity",
    )


def _slow(motion: str, chosen: Callable[[float], bool], velocity: float | None = None) -> Values:
    """Friction at a velocity, None: the smallest, for amplitudes with static friction."""
    return _friction(
        lambda study: (
            asked.point(
                study, motion, asked.velocities(study)[0] if velocity is None else velocity, a
            )
            for a in filter(chosen, asked.limited(study, motion))
        ),
        "amplitude",
    )


def _limit(motion: str, chosen: Callable[[float], bool]) -> Values:
    """The static limit by amplitude."""

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for amplitude in filter(chosen, asked.limited(study, motion)):
            limit = static.limit(study, runs, motion, amplitude)
            yield {"amplitude": amplitude}, limit.value, limit.error, limit.runs

    return values


def _end(quantity: str) -> Values:
    """The end of each transient. Its error: the change from half as many rings, and the change over
    the last tenth of the way."""

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for start in asked.STARTS:
            two = [runs(asked.transient(start, cells)) for cells in asked.CELLS]
            fine, coarse = (np.asarray(run.result[quantity], float) for run in two)
            tail = fine[-max(fine.size // 10, 2) :]
            error = abs(fine[-1] - coarse[-1]) + np.abs(tail - fine[-1]).max()
            yield {"velocity": asked.TRANSIENT_VELOCITY}, fine[-1], error, two

    return values


def _field(index: int) -> Values:
    """A number of `_tractions`; its error is the change from half as many rings."""

    def values(study: Claims, runs: Runs) -> Iterator[tuple]:
        for velocity in asked.FIELD_VELOCITIES:
            two = [runs(asked.field(velocity, cells)) for cells in asked.CELLS]
            fine, coarse = (_tractions(run)[index] for run in two)
            yield {"velocity": velocity}, fine, abs(fine - coarse), two

    return values


def _tractions(run: Run) -> tuple[float, float]:
    """Least traction over its bound, and largest angle to Eq 15 in degrees."""
    names = ("traction_lateral", "traction_forward", "bound", "lateral_position")
    lateral, forward, bound, across = (np.asarray(run.result[n], float) for n in names)
    along = np.asarray(run.result["forward_position"], float)
    size = np.hypot(lateral, forward)
    wanted = paper.steady_bore_traction(across, along, float(run.request["velocity"]))
    turned = np.arctan2(
        wanted[0] * forward - wanted[1] * lateral, wanted[0] * lateral + wanted[1] * forward
    )
    return float((size / bound).min()), float(np.degrees(np.abs(turned).max()))


def _below_one(amplitude: float) -> bool:
    return amplitude < 1.0  # there is no static friction beyond


def _above_turning(amplitude: float) -> bool:
    return amplitude > TURNING_BORE


def _below_turning(amplitude: float) -> bool:
    return amplitude < TURNING_BORE


def _rigid(amplitude: float, velocity: float) -> Any:
    return paper.large_amplitude_transverse(velocity, amplitude)


def _steady(amplitude: float, velocity: float) -> float:
    return float(paper.large_amplitude_bore(velocity))


def _zone_nearer(study: Claims, runs: Runs) -> Iterator[Check]:
    for place, mu, error, behind in _limit("transverse", _below_one)(study, runs):
        slider, zone = (
            float(eq(place["amplitude"])) for eq in (paper.static_slider, paper.static_transverse)
        )
        yield check(mu, zone, abs(slider - mu) - abs(zone - mu), error, behind, **place)


def _rigid_below_squares(study: Claims, runs: Runs) -> Iterator[Check]:
    """The paper's run has no error estimate; its distance from the certified point stands in."""
    for amplitude in asked.sliding(study):
        place = {"amplitude": amplitude, "velocity": asked.PAPER_VELOCITY}
        own = runs(asked.paper_run("transverse", amplitude))
        point = runs(asked.point(study, "transverse", asked.PAPER_VELOCITY, amplitude))
        certified, its_error = friction(point)
        mu = value_of(own.result, "mu_macro")
        eq = float(_rigid(amplitude, asked.PAPER_VELOCITY))
        yield check(mu, eq, mu - eq, its_error + abs(mu - certified), [own, point], **place)


def _steady_nears(study: Claims, runs: Runs) -> Iterator[Check]:
    for before, amplitude in pairwise(study.amplitude["bore"]):
        for velocity in asked.velocities(study):
            two = [runs(asked.point(study, "bore", velocity, a)) for a in (amplitude, before)]
            (mu, error), (other, its_error) = map(friction, two)
            eq = _steady(amplitude, velocity)
            margin = abs(other - eq) - abs(mu - eq)
            place = {"amplitude": amplitude, "velocity": velocity}
            yield check(mu, eq, margin, error + its_error, two, **place)


# Periods of the oscillating bore


def _periods(
    judge: Callable[[np.ndarray, np.ndarray, float], tuple[float, float, float]],
) -> Checks:
    """Checks of periods; judge(right, left, cell): value, reference and margin of the area shares
    that stick on either side, and of the smallest cell. Error: the change from half the rings."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for velocity, amplitude in asked.periods(study):
            place = {"amplitude": amplitude, "velocity": velocity}
            requests = [asked.period(study, velocity, amplitude, c) for c in (False, True)]
            two = [runs(request) for request in requests]
            if all(value_of(run.result, "converged", bool) for run in two):
                (value, against, margin), (*_, coarse) = (judge(*_sticking(run)) for run in two)
                yield check(value, against, margin, abs(margin - coarse), two, **place)
            else:
                yield check(np.nan, np.nan, np.nan, np.inf, two, **place)

    return checks


def _sticking(run: Run) -> tuple[np.ndarray, np.ndarray, float]:
    """Area shares that stick, (steps,): right, left; and the share of the smallest cell."""
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
    # the smaller of the two leads, of one side and then of the other
    lead = max(min(leads[0], -leads[1]), min(-leads[0], leads[1]))
    return lead, ALTERNATES, lead - ALTERNATES


# Along the velocity


def _rises(rows: Callable[[Claims], Iterable[list[dict]]], names: tuple[str, ...]) -> Checks:
    """Checks of neighbours in rows of requests, from slow to fast."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for row in rows(study):
            for slow, fast in pairwise(row):
                two = [runs(fast), runs(slow)]
                (mu, error), (before, its_error) = map(friction, two)
                place = {name: float(fast[name]) for name in names}
                yield check(mu, before, mu - before, error + its_error, two, **place)

    return checks


def _limits(far: float = 0.0) -> Values:
    """The static limit of the bore in closed form, from an amplitude on."""
    return _friction(
        lambda study: (
            asked.point(study, "bore", 0.0, a) for a in study.amplitude["bore"] if a >= far
        ),
        "amplitude",
    )


def _limits_on_rings() -> Values:
    return _friction(
        lambda study: (
            asked.resolved_limit(study, "bore", a) for a in asked.limited(study, "bore")
        ),
        "amplitude",
    )


def _something_left(limits: Values) -> Checks:
    return _judge(limits, lambda amplitude: 0.0, lambda mu, _: mu - VANISHES)


def _along(motion: str) -> Checks:
    return _rises(
        lambda study: [row for row in asked.rows(study) if row[0]["motion"] == motion],
        ("amplitude", "velocity"),
    )


ZONE = paper.static_bore
PARTS = (
    Part(
        *(1, "rigid_below", "Eq 6 lies below the computed friction"),
        _judge(_map("transverse"), _rigid, above),
    ),
    Part(
        *(1, "rigid_near", f"... and within {SLIGHT:g} of it"),
        _judge(_map("transverse"), _rigid, within(SLIGHT)),
    ),
    Part(
        *(1, "rigid_below_squares"),
        "Eq 6 lies below the friction of the paper's own run, at its smallest velocity and the "
        "largest amplitude",
        _rigid_below_squares,
        counts=False,
    ),
    Part(
        *(2, "slider_above", "Eq 7 lies above the static limit"),
        _judge(_limit("transverse", _below_one), paper.static_slider, below),
    ),
    Part(2, "zone_nearer", "Eq 11 is nearer to the static limit than Eq 7", _zone_nearer),
    Part(
        *(2, "slider_above_march"),
        "Eq 7 lies above even the friction at the smallest velocity, a bound of the limit",
        _judge(_slow("transverse", _below_one), paper.static_slider, below),
        counts=False,
    ),
    Part(
        *(2, "zone_above", "Eq 11 lies above the static limit too"),
        _judge(_limit("transverse", _below_one), paper.static_transverse, below),
        counts=False,
    ),
    Part(
        *(3, "force_settles", f"the force ends within {AGREES:g} of Eq 21, from each start"),
        _judge(_end("force_forward"), paper.bore_forward, within(AGREES)),
    ),
    Part(
        *(3, "torque_settles", f"the torque ends within {AGREES:g} of Eq 22, from each start"),
        _judge(_end("torque"), paper.bore_torque, within(AGREES)),
    ),
    Part(
        *(3, "force_steady", f"certified steady force within {AGREES:g} of Eq 21"),
        _judge(_friction(asked.steady, "velocity"), paper.bore_forward, within(AGREES)),
        counts=False,
    ),
    Part(
        *(4, "on_bound", f"every traction is at least {ON_BOUND:g} of its bound"),
        _judge(_field(0), lambda velocity: ON_BOUND, above),
    ),
    Part(
        *(4, "aligned"),
        f"every traction is within {ALIGNED:g} degrees of the rigid slip (Eq 15)",
        _judge(_field(1), lambda velocity: ALIGNED, below),
    ),
    Part(
        *(5, "steady_near", f"Eq 29 is within {GOOD:g}, at amplitudes from {LARGE_BORE:g} on"),
        _judge(_map("bore", lambda amplitude: amplitude >= LARGE_BORE), _steady, within(GOOD)),
    ),
    Part(
        *(5, "steady_nears", "Eq 29 gets nearer from one amplitude to the next"),
        _steady_nears,
        counts=False,
    ),
    Part(
        *(5, "steady_near_below"),
        f"Eq 29 is within {GOOD:g} at amplitudes below {LARGE_BORE:g} too",
        _judge(_map("bore", lambda amplitude: amplitude < LARGE_BORE), _steady, within(GOOD)),
        counts=False,
    ),
    Part(
        *(6, "bore_zone_near"),
        f"Eq 33 is within {GOOD:g} of the static limit, at amplitudes above {TURNING_BORE:g}",
        _judge(_limit("bore", _above_turning), ZONE, within(GOOD)),
    ),
    Part(
        *(6, "bore_zone_relative", f"... and within {100 * RELATIVE:g} % of the limit's own value"),
        _judge(_limit("bore", _above_turning), ZONE, lambda mu, eq: RELATIVE * mu - abs(eq - mu)),
    ),
    Part(
        *(6, "bore_zone_above"),
        f"Eq 33 lies above the static limit, at amplitudes below {TURNING_BORE:g}",
        _judge(_limit("bore", _below_turning), ZONE, below),
    ),
    Part(
        *(6, "bore_zone_seen"),
        f"Eq 33 is within {GOOD:g} of the friction at the paper's smallest velocity, above "
        f"{TURNING_BORE:g}",
        _judge(_slow("bore", _above_turning, asked.PAPER_VELOCITY), ZONE, within(GOOD)),
        counts=False,
    ),
    Part(
        *(6, "bore_zone_above_march"),
        "there Eq 33 lies above even the friction at the smallest velocity, a bound of the limit",
        _judge(_slow("bore", _below_turning), ZONE, below),
        counts=False,
    ),
    Part(
        *(6, "bore_zone_printed"),
        f"Eq 33 as printed, without the square, is within {GOOD:g}, above {TURNING_BORE:g}",
        _judge(_limit("bore", _above_turning), paper.static_bore_printed, within(GOOD)),
        counts=False,
    ),
    Part(
        *(7, "some_sticks", "at every phase part of the contact sticks, more than one cell"),
        _periods(_some_sticks),
    ),
    Part(
        *(7, "alternates"),
        f"when least sticks one side leads by {ALTERNATES:g} of it, the other half a period later",
        _periods(_alternates),
    ),
    Part(
        *(8, "limit_positive", f"the static limit is above {VANISHES:g} (closed form)"),
        _something_left(_limits()),
    ),
    Part(
        *(8, "limit_positive_rings"),
        f"the static limit is above {VANISHES:g} on rings too, with no closed form",
        _something_left(_limits_on_rings()),
        counts=False,
    ),
    Part(
        *(8, "limit_asymptote"),
        f"from amplitude {FAR:g} on it is within {100 * RELATIVE:g} % of an asymptote that never "
        "vanishes",
        _judge(_limits(FAR), static.asymptote, lambda mu, far: RELATIVE * far - abs(mu - far)),
    ),
    Part(
        *(9, "rises_transverse", "transverse: from one velocity to the next friction rises"),
        _along("transverse"),
    ),
    Part(
        *(9, "rises_bore", "oscillating bore: from one velocity to the next friction rises"),
        _along("bore"),
    ),
    Part(
        *(9, "rises_continuous_bore", "continuous bore: likewise"),
        _rises(lambda study: [asked.steady(study)], ("velocity",)),
    ),
)
