"""Decide whether each statement is true.  Every check of a statement has a margin and an error, and
these determine the verdict.

A statement of the paper has parts, and each part is judged by checks.  A check has a margin with an
error.  A check holds if the margin is larger than the error.  A check fails if the margin is
negative and its absolute value is larger than the error.  Otherwise, the check is open.  A part
holds if at least one check holds and no check fails.  A statement holds if all its parts hold.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

if TYPE_CHECKING:
    import pandas as pd

OUTCOMES = ("open", "holds", "fails")
OPEN, HOLDS, FAILS = range(len(OUTCOMES))
VERDICTS = ("not_decided", "holds", "holds_in_part", "does_not_hold")
NOT_DECIDED, WHOLLY, PARTLY, NOT = range(len(VERDICTS))
WORDS = tuple(name.replace("_", " ") for name in VERDICTS)
"""Names of the verdicts, with spaces in place of underscores."""


def outcomes(margin: ArrayLike, error: ArrayLike) -> np.ndarray:
    """Return the outcome of each check as an index into OUTCOMES.

    margin, error: arrays of the same shape.  A positive margin means that the part holds.
    """
    margin = np.asarray(margin, float)
    decided = np.isfinite(margin) & (np.abs(margin) > np.asarray(error, float))
    return np.where(decided, np.where(margin > 0, HOLDS, FAILS), OPEN)


def of_part(outcome: Iterable[int]) -> int:
    """Return the verdict on a part as an index into VERDICTS, computed from the outcomes of its
    checks."""
    distinct = set(outcome)
    return _verdict(HOLDS in distinct, FAILS in distinct)


def of_claim(parts: Iterable[int]) -> int:
    """Return the verdict on a statement from the verdicts on its parts.

    A statement holds in part if one of its parts holds in part, or if some parts hold and others do
    not.  Otherwise, the statement is undecided if any part is undecided.
    """
    distinct = set(parts)
    verdict = _verdict(bool({WHOLLY, PARTLY} & distinct), bool({NOT, PARTLY} & distinct))
    return NOT_DECIDED if NOT_DECIDED in distinct and verdict != PARTLY else verdict


def _verdict(holds: bool, fails: bool) -> int:
    return (NOT_DECIDED, WHOLLY, NOT, PARTLY)[holds + 2 * fails]


def of_checks(checks: pd.DataFrame) -> dict[str, Any]:
    """Return those variables of a part which are computed from the checks of the part.

    checks: table with the columns outcome, margin, run, amplitude and velocity.
    """
    counts = {
        f"part_{word}": (checks["outcome"] == code).sum() for code, word in enumerate(OUTCOMES)
    }
    return counts | {
        "part_where": where(checks),
        "part_shown_by": shown_by(checks),
        "part_verdict": of_part(checks["outcome"]),
    }


def shown_by(checks: pd.DataFrame) -> str:
    """Return the name of the run that best shows the verdict on a part, or "" if all checks are
    open.

    If checks fail, the run of the failing check with the most negative margin is returned.
    Otherwise, the run of the check with the smallest positive margin is returned.

    checks: table with the columns outcome, margin and run.
    """
    decided = checks[checks["outcome"] != OPEN]
    ordered = decided.sort_values(["outcome", "margin"], ascending=[False, True], kind="stable")
    return ordered["run"].iloc[0] if len(ordered) else ""


def where(checks: pd.DataFrame) -> str:
    """Return a string that states at which amplitudes or velocities a part of a statement holds.

    An example is "amplitude 1 to 3; not at amplitude 5".

    Checks are grouped by amplitude, or by velocity for a steady motion.  If some checks of a group
    hold and some fail, the text lists the velocities of the failing checks.

    checks: table with the columns outcome, amplitude and velocity.
    """
    axis = "velocity" if checks["amplitude"].isna().any() else "amplitude"
    words = {}
    for value, group in checks.groupby(axis):
        codes = set(group["outcome"])
        if {HOLDS, FAILS} <= codes:
            fails = group["outcome"] == FAILS
            texts = [
                text for bad, text in _stretches(zip(group["velocity"], fails, strict=True)) if bad
            ]
            words[value] = f"at {axis} {{}} not for velocity {' and '.join(texts)}"
        else:
            word = "" if HOLDS in codes else "not at " if FAILS in codes else "open at "
            words[value] = f"{word}{axis} {{}}"
    return "; ".join(word.format(stretch) for word, stretch in _stretches(words.items()))


def _stretches(labels: Iterable[tuple[float, object]]) -> Iterable[tuple]:
    """For each group of consecutive values with the same label, yield the label and the range, such
    as "1 to 3".

    labels: pairs of a value and its label.
    """
    for label, group in groupby(labels, key=lambda pair: pair[1]):
        values = [value for value, _ in group]
        yield label, f"{values[0]:g}" + (f" to {values[-1]:g}" if len(values) > 1 else "")
