"""Verdicts: what follows from margins and errors, by rules that know nothing of friction.

A statement of the paper is cut into parts, a part is judged by checks. A check is a number that is
positive where the part holds, with an error: it decides only if it is larger than that. A part
holds if nothing decides against it, and a statement if all its parts do.
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
"""The verdicts as they are written."""


@dataclass(frozen=True)
class Check:
    """One number that speaks for or against a part.

    Attributes
    ----------
    value, against : float
        What was computed, and what it is compared with.
    margin, error : float
        Positive where the part holds; error of the margin, infinite where a run gave no number to
        trust.
    runs : tuple of str
        Names of the results behind it, the one that it is about first.
    place : tuple
        (name, number) pairs that say where.
    """

    value: float
    against: float
    margin: float
    error: float
    runs: tuple
    place: tuple

    @property
    def outcome(self) -> int:
        """One of OUTCOMES, as an index: open unless the margin is larger than its error."""
        if not (math.isfinite(self.margin) and abs(self.margin) > self.error):
            return OPEN
        return HOLDS if self.margin > 0 else FAILS


def of_part(checks: list) -> int:
    """The verdict on a part, an index of VERDICTS; checks: list of Check."""
    found = {check.outcome for check in checks}
    if HOLDS not in found:
        return NOT if FAILS in found else NOT_DECIDED
    return PARTLY if FAILS in found else WHOLLY


def of_claim(parts: list) -> int:
    """The verdict on a statement, from those on its parts.

    One that is open leaves the statement open too, unless the others hold and fail among
    themselves: whatever it came to then, the statement would hold in part.
    """
    found = set(parts)
    if PARTLY in found or {WHOLLY, NOT} <= found:
        return PARTLY
    if NOT_DECIDED in found or not found:
        return NOT_DECIDED
    return found.pop()


def decisive(checks: list, outcome: int) -> Check | None:
    """The check that shows an outcome best: the one with the largest margin; None without any."""
    found = [check for check in checks if check.outcome == outcome]
    return max(found, key=lambda check: abs(check.margin), default=None)


def tightest(checks: list) -> Check | None:
    """The check with the least margin among those that hold; None if none does."""
    found = [check for check in checks if check.outcome == HOLDS]
    return min(found, key=lambda check: check.margin, default=None)


def where(checks: list) -> str:
    """In words where a part holds and where not, as in "amplitude 1 to 3; not at amplitude 5".

    The first name in the places of the checks groups them, the second gives the range of failures
    within a group.
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
        ("", lambda found: HOLDS in found and FAILS not in found),
        ("not at ", lambda found: FAILS in found and HOLDS not in found),
        ("open at ", lambda found: found == {OPEN}),
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
    """Stretches of neighbours that are chosen, as text: "0.5", "1 to 3"."""
    stretch, found = [], []
    for value in [*order, None]:
        if value is not None and chosen(value):
            stretch.append(value)
        elif stretch:
            found.append(f"{stretch[0]:g}" + (f" to {stretch[-1]:g}" if stretch[1:] else ""))
            stretch = []
    return found


def _within(group: list[Check]) -> str:
    """Text with the places where checks of a group fail, by the second name of their places."""
    failed = [check.place[1] for check in group if check.outcome == FAILS and check.place[1:]]
    if not failed:
        return "for some"
    name, values = failed[0][0], sorted({value for _, value in failed})
    order = sorted({check.place[1][1] for check in group})
    return f"not for {name} " + " and ".join(_runs(order, lambda value: value in values))
