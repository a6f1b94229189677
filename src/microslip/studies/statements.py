"""The paper's statements, and the criteria for judging each part.  Statement 10 is by M. Popov
(2020).

A part is one aspect of a statement that numbers can confirm or refute.  statements.csv contains the
statements in plain words, and parts.csv contains a row for each part:

- counts: yes if the verdict on the statement depends on the part;
- evidence, lines: table of evidence, and condition that selects lines of this table; if the
  condition is empty, all lines are used;
- formula: reference for the values, a key of FORMULAS;
- margin: how a value is compared with its reference, a key of MARGINS;
- limit: key of LIMITS.  The value of the limit appears in the text of the criterion.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from microslip.datasets.catalogue import FORMS
from microslip.datasets.variables import rows
from microslip.studies import verdicts
from microslip.studies.static_limits import asymptote
from microslip.theory import oscillating_load

if TYPE_CHECKING:
    import pandas as pd

LIMITS = {
    # Error of mu_macro that is just visible on a map with contours at steps of 0.1.
    "GOOD": 0.02,
    # Largest difference in mu_macro that counts as slight.
    "SLIGHT": 0.05,
    # Largest difference in mu_macro between a curve and a dashed line at which they count as equal.
    "AGREES": 0.01,
    # Largest relative error at which a formula counts as good where friction is small.
    "RELATIVE": 0.1,
    # Ratio of traction to friction bound above which a point counts as slipping.
    "ON_BOUND": 0.999,
    # Largest angle in degrees between traction and slip, equal to the tolerance of the paper.
    "ALIGNED": 4.0,
    # Smallest difference between the stick areas of the two halves, divided by the total stick
    # area.
    "ALTERNATES": 0.5,
    # Largest mean force, divided by mu F_z, that counts as zero.
    "VANISHES": 1e-9,
}
"""Numerical meanings of words such as slight, good or near."""


class Part(NamedTuple):
    """One aspect of a statement.  The fields are the columns of parts.csv."""

    claim: int
    part: str
    counts: bool
    evidence: str
    lines: str
    formula: str
    margin: str
    limit: float
    text: str

    def checks(self, tables: dict[str, pd.DataFrame]) -> pd.DataFrame:
        """Return the rows of evidence for this part, with the additional columns `against`,
        `margin` and `outcome`.

        tables: tables of evidence, keyed by name.
        """
        checks = tables[self.evidence]
        checks = checks.query(self.lines) if self.lines else checks
        # The error of a value affects the distances from both formulas, so it counts twice.
        errors = 2.0 if self.margin.startswith("nearer than Eq") else 1.0
        return checks.assign(
            limit=self.limit,
            against=FORMULAS[self.formula],
            margin=MARGINS[self.margin],
            error=errors * checks["error"],
            outcome=lambda own: verdicts.outcomes(own["margin"], own["error"]),
        )


Numbers = Callable[["pd.DataFrame"], Any]
"""Type of functions that compute references or margins from a table of evidence."""


def _of(formula: Callable, *columns: str) -> Numbers:
    return lambda checks: np.asarray(formula(*(checks[name].to_numpy(float) for name in columns)))


FORMULAS = {
    form.equation: _of(form.function, *form.arguments)
    for forms in FORMS.values()
    for form in forms.values()
    if form.equation
} | {
    "asymptote": _of(asymptote, "amplitude"),
    "Eq 37": _of(oscillating_load.sum_of_powers, "amplitude", "velocity"),
    "Eq 38": _of(oscillating_load.single_power, "amplitude", "velocity"),
    "other": _of(np.asarray, "other"),
    "limit": _of(np.asarray, "limit"),
}
"""References for values: closed forms by equation number, and other references by name."""


def _distance(checks: pd.DataFrame, reference: Any = None) -> Any:
    return np.abs(checks["value"] - (checks["against"] if reference is None else reference))


MARGINS: dict[str, Numbers] = {
    "above": lambda checks: checks["value"] - checks["against"],
    "below": lambda checks: checks["against"] - checks["value"],
    "within": lambda checks: checks["limit"] - _distance(checks),
    "within share of value": lambda c: c["limit"] * c["value"] - _distance(c),
    "within share of against": lambda c: c["limit"] * c["against"] - _distance(c),
    "nearer than other": lambda c: np.abs(c["other"] - c["against"]) - _distance(c),
    "nearer than Eq 7": lambda c: _distance(c, FORMULAS["Eq 7"](c)) - _distance(c),
    "nearer than Eq 38": lambda c: _distance(c, FORMULAS["Eq 38"](c)) - _distance(c),
}
"""Functions that compute the margins of checks, keyed by name.  A positive margin means that the
part holds."""


def _part(row: dict[str, str]) -> Part:
    limit = LIMITS.get(row["limit"], np.nan)
    text = row["text"].format(limit=f"{limit:g}", percent=f"{100 * limit:g}")
    values: dict[str, Any] = row | {"claim": int(row["claim"]), "counts": row["counts"] == "yes"}
    return Part(**values | {"limit": limit, "text": text})


FOLDER = Path(__file__).parent
STATEMENTS = {int(row["claim"]): row["text"] for row in rows(FOLDER / "statements.csv")}
"""The statements by number."""
PARTS = tuple(map(_part, rows(FOLDER / "parts.csv")))
"""The parts of all statements."""
