"""Verdicts on statements, from the margins and errors of checks.

A statement of the paper has parts, and a part is judged by checks. Each check has a margin with an
error. A check holds if its margin is larger than the error. It fails if the margin is negative and
its absolute value is larger than the error. Otherwise, the check is open. A part holds if some
checks hold and none fails. A statement holds if all its parts hold.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

OUTCOMES = ("open", "holds", "fails")
OPEN, HOLDS, FAILS = range(len(OUTCOMES))
VERDICTS = ("not_decided", "holds", "holds_in_part", "does_not_hold")
NOT_DECIDED, WHOLLY, PARTLY, NOT = range(len(VERDICTS))
WORDS = ("not decided", "holds", "holds in part", "does not hold")
"""Verdicts in words."""


@dataclass(frozen=True)
class Check:
    """A comparison of two numbers that supports or refutes a part.

    Attributes
    ----------
    value, against : float
        Computed value and its reference.
    margin, error : float
        Margin and its error. The margin is positive if the part holds. The error is infinite if a
        run did not converge.
    runs : tuple of str
        Names of the runs. The computed value is from the first run.
    place : tuple
        Pairs of a name and a number, such as ("amplitude", 1.0).
    """

    value: float
    against: float
    margin: float
    error: float
    runs: tuple
    place: tuple

    @property
    def outcome(self) -> int:
        """Index into OUTCOMES. A check is open if its margin is within its error."""
        if not (math.isfinite(self.margin) and abs(self.margin) > self.error):
            return OPEN
        return HOLDS if self.margin > 0 else FAILS


def of_part(checks: list) -> int:
    """Return the verdict on a part, an index into VERDICTS. checks: list of Check."""
    outcomes = {check.outcome for check in checks}
    if HOLDS not in outcomes:
        return NOT if FAILS in outcomes else NOT_DECIDED
    return PARTLY if FAILS in outcomes else WHOLLY


def of_claim(parts: list) -> int:
    """Return the verdict on a statement from the verdicts on its parts.

    A statement holds in part if one of its parts holds in part, or if some parts hold and some do
    not. Otherwise, one undecided part leaves the statement undecided.
    """
    distinct = set(parts)
    if PARTLY in distinct or {WHOLLY, NOT} <= distinct:
        return PARTLY
    if NOT_DECIDED in distinct or not distinct:
        return NOT_DECIDED
    return distinct.pop()


def decisive(checks: list, outcome: int) -> Check | None:
    """Return the check of this outcome with the largest absolute margin, or None."""
    decided = [check for check in checks if check.outcome == outcome]
    return max(decided, key=lambda check: abs(check.margin), default=None)


def tightest(checks: list) -> Check | None:
    """Return the check that holds with the smallest margin, or None if no check holds."""
    decided = [check for check in checks if check.outcome == HOLDS]
    return min(decided, key=lambda check: check.margin, default=None)


def where(checks: list) -> str:
    """Return a text that lists where a part holds, such as "amplitude 1 to 3; not at amplitude 5".

    Checks are grouped by the first number in `place`. If some checks of a group hold and some fail,
    the text lists the failing checks by the second number in `place`.
    """
    if not checks or not checks[0].place:
        return ""
    groups: dict[tuple, list[Check]] = {}
    for check in checks:
        groups.setdefault(check.place[0], []).append(check)
    name = checks[0].place[0][0]
    outcomes = {key[1]: {check.outcome for check in group} for key, group in groups.items()}
    order = sorted(outcomes)
    texts = []
    for label, chosen in (
        ("", lambda of: HOLDS in of and FAILS not in of),
        ("not at ", lambda of: FAILS in of and HOLDS not in of),
        ("open at ", lambda of: of == {OPEN}),
    ):
        at = {x for x in order if chosen(outcomes[x])}
        runs = _runs(order, at.__contains__)
        texts += [f"{label}{name} {run}" for run in runs]
    mixed = {
        key[1]: _within(group)
        for key, group in groups.items()
        if outcomes[key[1]] >= {HOLDS, FAILS}
    }
    for text in dict.fromkeys(mixed.values()):
        at = {x for x in order if mixed.get(x) == text}
        runs = _runs(order, at.__contains__)
        texts += [f"at {name} {run} {text}" for run in runs]
    return "; ".join(texts)


def _runs(order: list[float], chosen: Callable[[float], bool]) -> list[str]:
    """Return a text for each series of consecutive chosen values, such as "0.5" or "1 to 3"."""
    stretch, texts = [], []
    for value in [*order, None]:
        if value is not None and chosen(value):
            stretch.append(value)
        elif stretch:
            texts.append(f"{stretch[0]:g}" + (f" to {stretch[-1]:g}" if stretch[1:] else ""))
            stretch = []
    return texts


def _within(group: list[Check]) -> str:
    """Return a text that lists a group's failing checks by the second number in `place`."""
    failed = [check.place[1] for check in group if check.outcome == FAILS and check.place[1:]]
    if not failed:
        return "for some"
    name, values = failed[0][0], sorted({value for _, value in failed})
    order = sorted({check.place[1][1] for check in group})
    return f"not for {name} " + " and ".join(_runs(order, lambda value: value in values))
