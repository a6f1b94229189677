"""Checks of each part of the paper's statements by the runs, with margins and errors.

One function for each name in statements.PARTS: (study, runs) -> list of verdicts.Check.
study: settings.Claims; runs(request) -> tables of results, see runs.Runs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from microslip.config.settings import Claims
from microslip.studies.claims import claims as asked
from microslip.studies.claims import statements as criteria
from microslip.studies.claims.runs import Run, Runs, friction
from microslip.studies.claims.verdicts import Check
from microslip.studies.tables import value_of
from microslip.theory import paper as theory


def check(
    value: float, against: float, margin: float, error: float, runs: Sequence[Run], **place: object
) -> Check:
    numbers = (float(value), float(against), float(margin), float(error))
    return Check(*numbers, tuple(run.key for run in runs), tuple(place.items()))


def within(
    limit: float, value: float, against: float, error: float, runs: Sequence[Run], **place: object
) -> Check:
    """Holds where value and against are no more than `limit` apart."""
    return check(value, against, limit - abs(value - against), error, runs, **place)


def _map(
    study: Claims,
    runs: Runs,
    motion: str,
    formula: Callable,
    judge: Callable[[float, float], float],
    chosen: Callable[[float], bool] = lambda amplitude: True,
) -> list[Check]:
    """Checks at all points of a motion: judge(mu, formula(velocity, amplitude)) -> margin."""
    found = []
    for amplitude in filter(chosen, study.amplitude[motion]):
        for velocity in asked.velocities(study):
            run = runs(asked.point(study, motion, velocity, amplitude))
            mu, error = friction(run)
            against = formula(velocity, amplitude)
            place = {"amplitude": amplitude, "velocity": velocity}
            found.append(check(mu, against, judge(mu, against), error, [run], **place))
    return found


# Transverse oscillation


def rigid_below(study: Claims, runs: Runs) -> list[Check]:
    formula = theory.large_amplitude_transverse
    return _map(study, runs, "transverse", formula, lambda mu, eq: mu - eq)


def rigid_below_squares(study: Claims, runs: Runs) -> list[Check]:
    """The paper's run claims no error: it is what the certified point next to it tells."""
    found = []
    for amplitude in asked.sliding(study):
        place = {"amplitude": amplitude, "velocity": asked.PAPER_VELOCITY}
        paper = runs(asked.paper_run("transverse", amplitude))
        point = runs(asked.point(study, "transverse", asked.PAPER_VELOCITY, amplitude))
        certified, its_error = friction(point)
        mu = value_of(paper.result, "mu_macro")
        eq = float(theory.large_amplitude_transverse(asked.PAPER_VELOCITY, amplitude))
        error = its_error + abs(mu - certified)
        found.append(check(mu, eq, mu - eq, error, [paper, point], **place))
    return found


def rigid_near(study: Claims, runs: Runs) -> list[Check]:
    formula = theory.large_amplitude_transverse
    return _map(study, runs, "transverse", formula, lambda mu, eq: criteria.SLIGHT - abs(mu - eq))


# Continuous bore


def _settles(runs: Runs, quantity: str, against: float) -> list[Check]:
    """The end of each transient. Its error: how it differs on half as many rings, and how it still
    changes over the last tenth of the way."""
    found = []
    for start in asked.STARTS:
        two = [runs(asked.transient(start, cells)) for cells in asked.CELLS]
        fine, coarse = (np.asarray(run.result[quantity], float) for run in two)
        tail = fine[-max(fine.size // 10, 2) :]
        error = abs(fine[-1] - coarse[-1]) + np.abs(tail - fine[-1]).max()
        place = {"velocity": asked.TRANSIENT_VELOCITY}
        found.append(within(criteria.AGREES, fine[-1], against, error, two, **place))
    return found


def force_settles(study: Claims, runs: Runs) -> list[Check]:
    return _settles(runs, "force_forward", float(theory.bore_forward(asked.TRANSIENT_VELOCITY)))


def torque_settles(study: Claims, runs: Runs) -> list[Check]:
    return _settles(runs, "torque", float(theory.bore_torque(asked.TRANSIENT_VELOCITY)))


def force_steady(study: Claims, runs: Runs) -> list[Check]:
    found = []
    for velocity, request in zip(asked.STEADY_VELOCITIES, asked.steady(study), strict=True):
        run = runs(request)
        mu, error = friction(run)
        exact = float(theory.bore_forward(velocity))
        found.append(within(criteria.AGREES, mu, exact, error, [run], velocity=velocity))
    return found


def _tractions(run: Run) -> tuple[float, float]:
    """Least share of the bound that a traction has, and largest angle to Eq 15 in degrees."""
    names = ("traction_lateral", "traction_forward", "bound", "lateral_position")
    lateral, forward, bound, across = (np.asarray(run.result[n], float) for n in names)
    along = np.asarray(run.result["forward_position"], float)
    size = np.hypot(lateral, forward)
    wanted = theory.steady_bore_traction(across, along, float(run.request["velocity"]))
    turned = np.arctan2(
        wanted[0] * forward - wanted[1] * lateral, wanted[0] * lateral + wanted[1] * forward
    )
    return float((size / bound).min()), float(np.degrees(np.abs(turned).max()))


def _fields(runs: Runs, index: int, judge: Callable[[float], tuple[float, float]]) -> list[Check]:
    found = []
    for velocity in asked.FIELD_VELOCITIES:
        two = [runs(asked.field(velocity, cells)) for cells in asked.CELLS]
        fine, coarse = (_tractions(run)[index] for run in two)
        against, margin = judge(fine)
        found.append(check(fine, against, margin, abs(fine - coarse), two, velocity=velocity))
    return found


def on_bound(study: Claims, runs: Runs) -> list[Check]:
    return _fields(runs, 0, lambda share: (criteria.ON_BOUND, share - criteria.ON_BOUND))


def aligned(study: Claims, runs: Runs) -> list[Check]:
    return _fields(runs, 1, lambda angle: (criteria.ALIGNED, criteria.ALIGNED - angle))


# Oscillating bore


def _steady_formula(velocity: float, amplitude: float) -> float:
    return float(theory.large_amplitude_bore(velocity))


def _steady_near(study: Claims, runs: Runs, chosen: Callable[[float], bool]) -> list[Check]:
    def judge(mu: float, eq: float) -> float:
        return criteria.GOOD - abs(mu - eq)

    return _map(study, runs, "bore", _steady_formula, judge, chosen)


def steady_near(study: Claims, runs: Runs) -> list[Check]:
    return _steady_near(study, runs, lambda amplitude: amplitude >= criteria.LARGE_BORE)


def steady_near_below(study: Claims, runs: Runs) -> list[Check]:
    return _steady_near(study, runs, lambda amplitude: amplitude < criteria.LARGE_BORE)


def steady_nears(study: Claims, runs: Runs) -> list[Check]:
    found = []
    for before, amplitude in pairwise(study.amplitude["bore"]):
        for velocity in asked.velocities(study):
            two = [runs(asked.point(study, "bore", velocity, a)) for a in (amplitude, before)]
            (mu, error), (other, its_error) = map(friction, two)
            eq = float(theory.large_amplitude_bore(velocity))
            margin = abs(other - eq) - abs(mu - eq)
            place = {"amplitude": amplitude, "velocity": velocity}
            found.append(check(mu, eq, margin, error + its_error, two, **place))
    return found


# From inside, and along the velocity


def _sticking(run: Run) -> tuple[np.ndarray, np.ndarray, float]:
    """Area shares that stick, (steps,): right, left; and that of the smallest cell."""
    sides = [np.asarray(run.result[f"stick_{side}"][1:], float) for side in ("right", "left")]
    return *sides, min(run.result["area"]) / np.pi


def _periods(
    study: Claims,
    runs: Runs,
    judge: Callable[[np.ndarray, np.ndarray, float], tuple[float, float, float]],
) -> list[Check]:
    """judge(right, left, cell) -> (value, against, margin); error: what half the rings change."""
    found = []
    for velocity, amplitude in asked.periods(study):
        requests = [asked.period(study, velocity, amplitude, coarse) for coarse in (False, True)]
        two = [runs(request) for request in requests]
        if not all(value_of(run.result, "converged", bool) for run in two):
            nothing = (np.nan, np.nan, np.nan, np.inf)
            found.append(check(*nothing, two, amplitude=amplitude, velocity=velocity))
            continue
        (value, against, margin), (_, _, coarse) = (judge(*_sticking(run)) for run in two)
        place = {"amplitude": amplitude, "velocity": velocity}
        found.append(check(value, against, margin, abs(margin - coarse), two, **place))
    return found


def some_sticks(study: Claims, runs: Runs) -> list[Check]:
    def judge(right: np.ndarray, left: np.ndarray, cell: float) -> tuple[float, float, float]:
        least = (right + left).min()
        return least, cell, least - cell

    return _periods(study, runs, judge)


def alternates(study: Claims, runs: Runs) -> list[Check]:
    def judge(right: np.ndarray, left: np.ndarray, _: float) -> tuple[float, float, float]:
        half = right.size // 2
        least = int(np.argmin((right + left)[:half]))
        leads = []
        for k in (least, least + half):
            total = right[k] + left[k]
            leads.append((left[k] - right[k]) / total if total > 0 else 0.0)
        # the smaller of the two leads, of one side and then of the other
        lead = max(min(leads[0], -leads[1]), min(-leads[0], leads[1]))
        return lead, criteria.ALTERNATES, lead - criteria.ALTERNATES

    return _periods(study, runs, judge)


def _rises(groups: Iterable[list[tuple[dict[str, float], Run]]]) -> list[Check]:
    """Checks of neighbours in rows of (place, run), from slow to fast."""
    found = []
    for row in groups:
        for (_, slow), (place, fast) in pairwise(row):
            (before, its_error), (mu, error) = friction(slow), friction(fast)
            found.append(check(mu, before, mu - before, error + its_error, [fast, slow], **place))
    return found


def _rows(study: Claims, runs: Runs, motion: str) -> Iterator[list[tuple[dict[str, float], Run]]]:
    for row in asked.rows(study):
        if row[0]["motion"] == motion:
            yield [
                ({name: float(r[name]) for name in ("amplitude", "velocity")}, runs(r)) for r in row
            ]


def rises_transverse(study: Claims, runs: Runs) -> list[Check]:
    return _rises(_rows(study, runs, "transverse"))


def rises_bore(study: Claims, runs: Runs) -> list[Check]:
    return _rises(_rows(study, runs, "bore"))


def rises_continuous_bore(study: Claims, runs: Runs) -> list[Check]:
    row = [({"velocity": float(r["velocity"])}, runs(r)) for r in asked.steady(study)]
    return _rises([row])
