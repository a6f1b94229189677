"""Parts of the paper's statements, and the checks that judge them.

A part has a function (study, runs) -> checks. Most parts compare the friction of requests with a
formula; `_compared` and `_at_limit` make their functions. The error of a margin is that of the
runs behind it.
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


# Friction against a formula


def _compared(
    requests: Callable[[Claims], Iterable[dict]],
    formula: Callable[..., Any],
    margin: Margin,
    names: tuple[str, ...] = ("amplitude",),
) -> Checks:
    """Checks of requested friction against formula(*numbers of the request with these names)."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for request in requests(study):
            run = runs(request)
            mu, error = friction(run)
            place = {name: float(request[name]) for name in names}
            against = formula(*place.values())
            yield check(mu, against, margin(mu, against), error, [run], **place)

    return checks


def _map(
    motion: str,
    formula: Callable[..., Any],
    margin: Margin,
    chosen: Callable[[float], bool] = lambda amplitude: True,
) -> Checks:
    """Checks of all points of a motion against formula(amplitude, velocity)."""
    return _compared(
        lambda study: (
            asked.point(study, motion, velocity, amplitude)
            for amplitude in filter(chosen, study.amplitude[motion])
            for velocity in asked.velocities(study)
        ),
        formula,
        margin,
        ("amplitude", "velocity"),
    )


def _slow(
    motion: str, chosen: Callable[[float], bool], velocity: float | None = None
) -> Callable[[Claims], Iterable[dict]]:
    """Points at a velocity, None: the smallest, for amplitudes with static friction."""
    return lambda study: (
        asked.point(
            study, motion, asked.velocities(study)[0] if velocity is None else velocity, amplitude
        )
        for amplitude in filter(chosen, asked.limited(study, motion))
    )


def _at_limit(
    motion: str,
    formula: Callable[[float], Any],
    margin: Callable[[float, float, float], float],
    chosen: Callable[[float], bool],
) -> Checks:
    """Checks at the static limit: margin(formula, limit, amplitude)."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for a in filter(chosen, asked.limited(study, motion)):
            limit = static.limit(study, runs, motion, a)
            against = float(formula(a))
            found = margin(against, limit.value, a)
            yield check(limit.value, against, found, limit.error, limit.runs, amplitude=a)

    return checks


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


def _nearer_than_slider(zone: float, limit: float, amplitude: float) -> float:
    return abs(float(paper.static_slider(amplitude)) - limit) - abs(zone - limit)


def _far_limits(study: Claims) -> Iterator[dict]:
    for amplitude in study.amplitude["bore"]:
        if amplitude >= FAR:
            yield asked.point(study, "bore", 0.0, amplitude)


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


# Continuous bore


def _settles(quantity: str, formula: Callable[[float], Any]) -> Checks:
    """Checks of the end of each transient. Its error: the change from half as many rings, and the
    change over the last tenth of the way."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        against = float(formula(asked.TRANSIENT_VELOCITY))
        for start in asked.STARTS:
            two = [runs(asked.transient(start, cells)) for cells in asked.CELLS]
            fine, coarse = (np.asarray(run.result[quantity], float) for run in two)
            tail = fine[-max(fine.size // 10, 2) :]
            error = abs(fine[-1] - coarse[-1]) + np.abs(tail - fine[-1]).max()
            margin = within(AGREES)(fine[-1], against)
            yield check(fine[-1], against, margin, error, two, velocity=asked.TRANSIENT_VELOCITY)

    return checks


def _fields(index: int, against: float, margin: Margin) -> Checks:
    """Checks of a number of `_tractions`; its error is the change from half as many rings."""

    def checks(study: Claims, runs: Runs) -> Iterator[Check]:
        for velocity in asked.FIELD_VELOCITIES:
            two = [runs(asked.field(velocity, cells)) for cells in asked.CELLS]
            fine, coarse = (_tractions(run)[index] for run in two)
            error = abs(fine - coarse)
            yield check(fine, against, margin(fine, against), error, two, velocity=velocity)

    return checks


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


def _rows(motion: str) -> Checks:
    return _rises(
        lambda study: [row for row in asked.rows(study) if row[0]["motion"] == motion],
        ("amplitude", "velocity"),
    )


PARTS = (
    Part(
        1, "rigid_below", "Eq 6 lies below the computed friction", _map("transverse", _rigid, above)
    ),
    Part(
        1,
        "rigid_near",
        f"... and within {SLIGHT:g} of it",
        _map("transverse", _rigid, within(SLIGHT)),
    ),
    Part(
        1,
        "rigid_below_squares",
        "Eq 6 lies below the friction of the paper's own run, at its smallest velocity and the "
        "largest amplitude",
        _rigid_below_squares,
        counts=False,
    ),
    Part(
        2,
        "slider_above",
        "Eq 7 lies above the static limit",
        _at_limit("transverse", paper.static_slider, lambda eq, mu, _: eq - mu, _below_one),
    ),
    Part(
        2,
        "zone_nearer",
        "Eq 11 is nearer to the static limit than Eq 7",
        _at_limit("transverse", paper.static_transverse, _nearer_than_slider, _below_one),
    ),
    Part(
        2,
        "slider_above_march",
        "Eq 7 lies above even the friction at the smallest velocity, a bound of the limit",
        _compared(_slow("transverse", _below_one), paper.static_slider, below),
        counts=False,
    ),
    Part(
        2,
        "zone_above",
        "Eq 11 lies above the static limit too",
        _at_limit("transverse", paper.static_transverse, lambda eq, mu, _: eq - mu, _below_one),
        counts=False,
    ),
    Part(
        3,
        "force_settles",
        f"the force ends within {AGREES:g} of Eq 21, from each start",
        _settles("force_forward", paper.bore_forward),
    ),
    Part(
        3,
        "torque_settles",
        f"the torque ends within {AGREES:g} of Eq 22, from each start",
        _settles("torque", paper.bore_torque),
    ),
    Part(
        3,
        "force_steady",
        f"certified steady force within {AGREES:g} of Eq 21",
        _compared(asked.steady, paper.bore_forward, within(AGREES), ("velocity",)),
        counts=False,
    ),
    Part(
        4,
        "on_bound",
        f"every traction is at least {ON_BOUND:g} of its bound",
        _fields(0, ON_BOUND, above),
    ),
    Part(
        4,
        "aligned",
        f"every traction is within {ALIGNED:g} degrees of the rigid slip (Eq 15)",
        _fields(1, ALIGNED, below),
    ),
    Part(
        5,
        "steady_near",
        f"Eq 29 is within {GOOD:g}, at amplitudes from {LARGE_BORE:g} on",
        _map("bore", _steady, within(GOOD), lambda amplitude: amplitude >= LARGE_BORE),
    ),
    Part(
        5,
        "steady_nears",
        "Eq 29 gets nearer from one amplitude to the next",
        _steady_nears,
        counts=False,
    ),
    Part(
        5,
        "steady_near_below",
        f"Eq 29 is within {GOOD:g} at amplitudes below {LARGE_BORE:g} too",
        _map("bore", _steady, within(GOOD), lambda amplitude: amplitude < LARGE_BORE),
        counts=False,
    ),
    Part(
        6,
        "bore_zone_near",
        f"Eq 33 is within {GOOD:g} of the static limit, at amplitudes above {TURNING_BORE:g}",
        _at_limit(
            *("bore", paper.static_bore, lambda eq, mu, _: GOOD - abs(eq - mu), _above_turning)
        ),
    ),
    Part(
        6,
        "bore_zone_relative",
        f"... and within {100 * RELATIVE:g} % of the limit's own value",
        _at_limit(
            "bore",
            paper.static_bore,
            lambda eq, mu, _: RELATIVE * mu - abs(eq - mu),
            _above_turning,
        ),
    ),
    Part(
        6,
        "bore_zone_above",
        f"Eq 33 lies above the static limit, at amplitudes below {TURNING_BORE:g}",
        _at_limit("bore", paper.static_bore, lambda eq, mu, _: eq - mu, _below_turning),
    ),
    Part(
        6,
        "bore_zone_seen",
        f"Eq 33 is within {GOOD:g} of the friction at the paper's smallest velocity, above "
        f"{TURNING_BORE:g}",
        _compared(
            _slow("bore", _above_turning, asked.PAPER_VELOCITY), paper.static_bore, within(GOOD)
        ),
        counts=False,
    ),
    Part(
        6,
        "bore_zone_above_march",
        "there Eq 33 lies above even the friction at the smallest velocity, a bound of the limit",
        _compared(_slow("bore", _below_turning), paper.static_bore, below),
        counts=False,
    ),
    Part(
        6,
        "bore_zone_printed",
        f"Eq 33 as printed, without the square, is within {GOOD:g}, above {TURNING_BORE:g}",
        _at_limit(
            "bore", paper.static_bore_printed, lambda eq, mu, _: GOOD - abs(eq - mu), _above_turning
        ),
        counts=False,
    ),
    Part(
        7,
        "some_sticks",
        "at every phase part of the contact sticks, more than one cell",
        _periods(_some_sticks),
    ),
    Part(
        7,
        "alternates",
        f"when least sticks one side leads by {ALTERNATES:g} of it, the other half a period later",
        _periods(_alternates),
    ),
    Part(
        8,
        "limit_positive",
        f"the static limit is above {VANISHES:g} (closed form)",
        _compared(
            lambda study: (asked.point(study, "bore", 0.0, a) for a in study.amplitude["bore"]),
            lambda amplitude: 0.0,
            lambda mu, _: mu - VANISHES,
        ),
    ),
    Part(
        8,
        "limit_positive_rings",
        f"the static limit is above {VANISHES:g} on rings too, with no closed form",
        _compared(
            lambda study: (
                asked.resolved_limit(study, "bore", a) for a in asked.limited(study, "bore")
            ),
            lambda amplitude: 0.0,
            lambda mu, _: mu - VANISHES,
        ),
        counts=False,
    ),
    Part(
        8,
        "limit_asymptote",
        f"from amplitude {FAR:g} on it is within {100 * RELATIVE:g} % of an asymptote that never "
        "vanishes",
        _compared(_far_limits, static.asymptote, lambda mu, far: RELATIVE * far - abs(mu - far)),
    ),
    Part(
        9,
        "rises_transverse",
        "transverse: from one velocity to the next friction rises",
        _rows("transverse"),
    ),
    Part(
        9,
        "rises_bore",
        "oscillating bore: from one velocity to the next friction rises",
        _rows("bore"),
    ),
    Part(
        9,
        "rises_continuous_bore",
        "continuous bore: likewise",
        _rises(lambda study: [asked.steady(study)], ("velocity",)),
    ),
)
