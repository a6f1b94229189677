"""Performance profiles: contests and ratios."""

from __future__ import annotations

import numpy as np
import pytest

from microslip.solver import method_names
from microslip.studies.accuracy import profiles


def test_every_method_has_a_contest_by_the_part_that_it_exchanges():
    result = {
        name: profiles.contest_of(name)
        for name in method_names.names()
        if not method_names.missing(name)
    }
    assert result["shipped"] == result["paper"] == "models"
    assert result["euler"] == result["midpoint"] == "integrators"
    assert result["projected-gradient"] == result["full-newton"] == "solvers of a step"
    assert result["march"] == "searches"


def table(*rows):
    """Rows of the table of trials, from (point, model, method, level, error, seconds)."""
    names = ("trial_point", "trial_model", "trial_method", "trial_level", "error", "seconds")
    return [dict(zip(names, row, strict=True)) | {"converged": True} for row in rows]


def ratio(rows, tolerances=(1e-3,), points=("p", "q")):
    made = profiles.variables(rows, list(points), tolerances)
    contests, names = (made[n][1] for n in ("competitor_contest", "competitor"))
    values = np.asarray(made["profile_ratio"][1], float)
    return dict(zip(zip(contests, names, strict=True), values, strict=True))


def test_a_ratio_is_the_least_time_within_the_tolerance_over_the_best():
    result = ratio(
        table(
            ("p", "polar", "shipped", 0, 5e-3, 1.0),
            ("p", "polar", "shipped", 1, 5e-4, 4.0),
            ("p", "polar", "shipped", 2, 5e-5, 9.0),
            ("p", "radial", "shipped", 0, 1e-4, 2.0),
            ("q", "polar", "shipped", 0, 1e-4, 3.0),
            ("q", "radial", "shipped", 0, 1e-2, 1.0),
        ),
        tolerances=(1e-2, 1e-3),
    )
    # by hand: polar needs 1 s at 1e-2 with the coarse run, and 4 s at 1e-3
    assert result["models", "polar"].tolist() == [[1.0, 3.0], [2.0, 1.0]]
    assert result["models", "radial"].tolist() == [[2.0, 1.0], [1.0, np.inf]]


def test_a_coarse_run_that_is_right_by_chance_does_not_count():
    result = ratio(
        table(
            ("p", "polar", "shipped", 0, 1e-6, 1.0),
            ("p", "polar", "shipped", 1, 5e-2, 2.0),
            ("p", "polar", "shipped", 2, 1e-4, 8.0),
            ("q", "polar", "shipped", 0, np.nan, 1.0),
        )
    )
    assert result["models", "polar"].tolist() == [[1.0, np.inf]]
    rows = table(("p", "polar", "shipped", 0, 1e-6, 1.0), ("p", "dahl", "shipped", 0, 1e-4, 5.0))
    assert ratio(rows, points=("p",))["models", "dahl"].tolist() == [[5.0]]
    rows[0]["converged"] = False
    result = ratio(rows, points=("p",))
    assert result["models", "polar"].tolist() == [[np.inf]]
    assert result["models", "dahl"].tolist() == [[1.0]]


def test_methods_are_compared_with_what_ships_where_both_were_run():
    result = ratio(
        table(
            ("p", "polar", "shipped", 0, 1e-4, 2.0),
            ("p", "mdr", "shipped", 0, 1e-4, 0.1),
            ("p", "polar", "euler", 0, 1e-4, 6.0),
            ("p", "polar", "march", 0, 1e-4, 1.0),
            ("p", "cartesian", "paper", 0, 1e-4, 50.0),
            ("p", "auto", "shipped", 0, 1e-4, 0.4),
        ),
        points=("p",),
    )
    assert result["integrators", "euler"].item() == pytest.approx(3.0)
    assert result["integrators", "shipped"].item() == 1.0  # not compared with mdr
    assert result["searches", "shipped"].item() == pytest.approx(2.0)
    assert result["models", "paper"].item() == pytest.approx(500.0)
    assert result["models", "auto"].item() == pytest.approx(4.0)
