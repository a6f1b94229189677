"""Stored results of single points, shared with sweeps and the command line."""

import json
import math
from unittest.mock import Mock

import pytest

import microslip
from microslip.app import cli
from microslip.config import load
from microslip.foundation.errors import InputError, SolverError
from microslip.foundation.files import CacheError
from microslip.sweeps import batches
from microslip.sweeps.store import Store

PLACE = ("bore", 0.5, 1.0)
SETTINGS = {"poisson": 0.3, "tolerance": 1e-2}


def without_time(result):
    return {k: v for k, v in result.to_dict().items() if k != "solve_time_s"}


@pytest.fixture
def solve(monkeypatch):
    """microslip.solve with a counter of its calls."""
    counted = Mock(wraps=microslip.solve)
    monkeypatch.setattr(microslip, "solve", counted)
    return counted


def test_an_answer_is_computed_once_and_equal(tmp_path, solve):
    first = microslip.solve_stored(*PLACE, results=tmp_path, **SETTINGS)
    again = microslip.solve_stored(*PLACE, results=tmp_path, **SETTINGS)
    assert solve.call_count == 1
    assert first.to_dict().keys() == again.to_dict().keys()
    assert without_time(first) == without_time(again)
    assert without_time(first) == without_time(microslip.solve(*PLACE, **SETTINGS))
    assert again.solve_time_s < 1.0


def test_sweep_command_line_and_python_find_each_others_points(tmp_path, solve, capsys):
    axes = {"velocity": [0.5], "amplitude": [1], "poisson": 0.3, "tolerance": 1e-2}
    grid = load.from_mapping({"sweeps": {"bore": axes}}).sweeps["bore"]
    batches.run_batch(batches.points_of(grid).requests, Store(tmp_path))
    assert solve.call_count == 1
    result = microslip.solve_stored(*PLACE, results=tmp_path, **SETTINGS)
    options = ["--velocity", "0.5", "--amplitude", "1", "--poisson", "0.3", "--tolerance", "1e-2"]
    assert cli.main(["point", "bore", *options, "--results", str(tmp_path), "--json"]) == 0
    assert solve.call_count == 1
    message = json.loads(capsys.readouterr().out)
    assert message["mu_macro"] == result.mu_macro
    assert message["mu_macro_error"] == result.mu_macro_error


def test_other_physics_tolerance_or_resolution_is_another_point(tmp_path, solve):
    ask = {"model": "slider", "tolerance": 1e-2}
    for changed in ({}, {"tolerance": 2e-2}, {"poisson": 0.1}, {"steps": 16}, {"model": "dahl"}):
        microslip.solve_stored("transverse", 0.5, 1.0, results=tmp_path, **ask | changed)
    assert solve.call_count == 5


def test_a_velocity_below_0_is_answered_where_the_motion_drives(tmp_path, solve):
    place = ("normal:forward=1,phase=90", -0.1, 0.5)
    for _ in range(2):
        result = microslip.solve_stored(*place, results=tmp_path, tolerance=1e-1)
    assert without_time(result) == without_time(microslip.solve(*place, tolerance=1e-1))
    assert solve.call_count == 1 + 1
    with pytest.raises(InputError, match="^velocity = -0.1: "):
        microslip.solve_stored("transverse", -0.1, 0.5, results=tmp_path)


def test_a_failure_comes_back_as_one(tmp_path, monkeypatch):
    monkeypatch.setattr(microslip, "solve", Mock(side_effect=SolverError("no such contact")))
    answer = microslip.solve_stored(*PLACE, results=tmp_path, **SETTINGS)
    assert not answer.converged
    assert "no such contact" in answer.reason
    assert math.isnan(answer.mu_macro)


@pytest.mark.parametrize(
    ("changed", "named"),
    [({"poisson": 0.7}, "poisson"), ({"tolerance": 0}, "tolerance"), ({"cells": 5}, "cells")],
)
def test_bad_input_is_refused_before_anything_is_written(changed, named, tmp_path):
    with pytest.raises(ValueError, match=f"^{named} = "):
        microslip.solve_stored(*PLACE, results=tmp_path / "new", **SETTINGS | changed)
    assert not (tmp_path / "new").exists()


def test_a_folder_that_is_none_is_refused(tmp_path, capsys):
    (tmp_path / "file").write_text("")
    with pytest.raises(CacheError, match="file"):
        microslip.solve_stored(*PLACE, results=tmp_path / "file", **SETTINGS)
    options = ["--velocity", "1", "--amplitude", "1", "--results", str(tmp_path / "file")]
    assert cli.main(["point", "transverse", *options]) == 2
    assert "--results" in capsys.readouterr().err


def test_no_tolerance_is_kept_and_found_again(tmp_path, solve):
    settings = {"cells": 8, "steps": 16, "tolerance": None, "results": tmp_path}
    first, again = (microslip.solve_stored("transverse", 0.3, 1.0, **settings) for _ in range(2))
    assert solve.call_count == 1 and without_time(first) == without_time(again)
    assert first.converged and first.tolerance is None
    with pytest.raises(ValueError, match="tolerance = None"):
        microslip.solve_stored("transverse", 0.3, 1.0, tolerance=None, results=tmp_path)
