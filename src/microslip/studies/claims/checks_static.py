"""Checks of static friction by the runs: the parts about Eqs 7, 11 and 33.

As in checks.py: one function for each part, (study, runs) -> list of verdicts.Check.
"""

from __future__ import annotations

from collections.abc import Callable

from microslip.config.settings import Claims
from microslip.studies.claims import claims as asked
from microslip.studies.claims import statements as criteria
from microslip.studies.claims import static_limits as static
from microslip.studies.claims.checks import check, within
from microslip.studies.claims.runs import Runs, friction
from microslip.studies.claims.verdicts import Check
from microslip.theory import paper


def _at_limit(
    study: Claims,
    runs: Runs,
    motion: str,
    judge: Callable[[float, float], tuple[float, float]],
    chosen: Callable[[float], bool],
) -> list[Check]:
    """Checks at the static limit: judge(amplitude, limit) -> (against, margin)."""
    found = []
    for amplitude in filter(chosen, asked.limited(study, motion)):
        limit = static.limit(study, runs, motion, amplitude)
        against, margin = judge(amplitude, limit.value)
        place = {"amplitude": amplitude}
        found.append(check(limit.value, against, margin, limit.error, limit.runs, **place))
    return found


def _below_one(amplitude: float) -> bool:
    return amplitude < 1.0  # beyond there is no static friction, and nothing to compare


def _formula_above(
    study: Claims, runs: Runs, motion: str, formula: Callable, chosen: Callable[[float], bool]
) -> list[Check]:
    """Whether a formula lies above the static limit."""

    def judge(amplitude: float, limit: float) -> tuple[float, float]:
        value = formula(amplitude)
        return value, value - limit

    return _at_limit(study, runs, motion, judge, chosen)


def slider_above(study: Claims, runs: Runs) -> list[Check]:
    return _formula_above(study, runs, "transverse", paper.static_slider, _below_one)


def zone_nearer(study: Claims, runs: Runs) -> list[Check]:
    def judge(amplitude: float, limit: float) -> tuple[float, float]:
        zone = float(paper.static_transverse(amplitude))
        return zone, abs(float(paper.static_slider(amplitude)) - limit) - abs(zone - limit)

    return _at_limit(study, runs, "transverse", judge, _below_one)


def zone_above(study: Claims, runs: Runs) -> list[Check]:
    return _formula_above(study, runs, "transverse", paper.static_transverse, _below_one)


def slider_above_march(study: Claims, runs: Runs) -> list[Check]:
    return _above_march(study, runs, "transverse", paper.static_slider, _below_one)


def _above_march(
    study: Claims, runs: Runs, motion: str, formula: Callable, chosen: Callable[[float], bool]
) -> list[Check]:
    """A formula against the smallest velocity that is marched. Friction rises with velocity, so
    that this bounds the limit from above, whatever one thinks of closed forms for it."""
    velocity, found = asked.velocities(study)[0], []
    for amplitude in filter(chosen, asked.limited(study, motion)):
        run = runs(asked.point(study, motion, velocity, amplitude))
        mu, error = friction(run)
        against = formula(amplitude)
        found.append(check(mu, against, against - mu, error, [run], amplitude=amplitude))
    return found


def _above_turning(amplitude: float) -> bool:
    return amplitude > criteria.TURNING_BORE


def _below_turning(amplitude: float) -> bool:
    return amplitude < criteria.TURNING_BORE


def _bore_zone(
    study: Claims,
    runs: Runs,
    judge: Callable[[float, float], float],
    chosen: Callable[[float], bool],
) -> list[Check]:
    """judge(Eq 33, limit) -> margin."""

    def of(amplitude: float, limit: float) -> tuple[float, float]:
        zone = float(paper.static_bore(amplitude))
        return zone, judge(zone, limit)

    return _at_limit(study, runs, "bore", of, chosen)


def bore_zone_near(study: Claims, runs: Runs) -> list[Check]:
    return _bore_zone(study, runs, lambda eq, mu: criteria.GOOD - abs(eq - mu), _above_turning)


def bore_zone_relative(study: Claims, runs: Runs) -> list[Check]:
    return _bore_zone(
        study, runs, lambda eq, mu: criteria.RELATIVE * mu - abs(eq - mu), _above_turning
    )


def bore_zone_above(study: Claims, runs: Runs) -> list[Check]:
    return _formula_above(study, runs, "bore", paper.static_bore, _below_turning)


def bore_zone_printed(study: Claims, runs: Runs) -> list[Check]:
    def judge(amplitude: float, limit: float) -> tuple[float, float]:
        printed = float(paper.static_bore_printed(amplitude))
        return printed, criteria.GOOD - abs(printed - limit)

    return _at_limit(study, runs, "bore", judge, _above_turning)


def bore_zone_above_march(study: Claims, runs: Runs) -> list[Check]:
    return _above_march(study, runs, "bore", paper.static_bore, _below_turning)


def bore_zone_seen(study: Claims, runs: Runs) -> list[Check]:
    found = []
    for amplitude in filter(_above_turning, asked.limited(study, "bore")):
        run = runs(asked.point(study, "bore", asked.PAPER_VELOCITY, amplitude))
        mu, error = friction(run)
        zone = float(paper.static_bore(amplitude))
        found.append(within(criteria.GOOD, mu, zone, error, [run], amplitude=amplitude))
    return found


# Whether anything is left, at any amplitude


def limit_positive(study: Claims, runs: Runs) -> list[Check]:
    asked_for = [asked.point(study, "bore", 0.0, a) for a in study.amplitude["bore"]]
    return _positive(runs, asked_for)


def limit_positive_rings(study: Claims, runs: Runs) -> list[Check]:
    amplitudes = asked.limited(study, "bore")
    return _positive(runs, [asked.resolved_limit(study, "bore", a) for a in amplitudes])


def _positive(runs: Runs, asked_for: list[dict]) -> list[Check]:
    """Whether friction is left, for a list of requests."""
    found = []
    for request in asked_for:
        run = runs(request)
        mu, error = friction(run)
        place = {"amplitude": float(request["amplitude"])}
        found.append(check(mu, 0.0, mu - criteria.VANISHES, error, [run], **place))
    return found


def limit_asymptote(study: Claims, runs: Runs) -> list[Check]:
    found = []
    for amplitude in study.amplitude["bore"]:
        if amplitude < criteria.FAR:
            continue
        run = runs(asked.point(study, "bore", 0.0, amplitude))
        mu, error = friction(run)
        far = float(static.asymptote(amplitude))
        margin = criteria.RELATIVE * far - abs(mu - far)
        found.append(check(mu, far, margin, error, [run], amplitude=amplitude))
    return found
