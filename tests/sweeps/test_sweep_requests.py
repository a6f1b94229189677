"""Requests of sweeps, and their division into batches."""

import json

import pytest
from stubs.sweep_stub import RUNS, configured

from microslip.foundation import source_digest
from microslip.sweeps import request as sweep


def points_of(**transverse):
    grid = {"velocity": [0.1, 1], "amplitude": [0, 1, 2], **transverse}
    return sweep.points_of(configured({"transverse": grid}).sweeps["transverse"])


def requests_of(**transverse):
    return points_of(**transverse).requests


def test_requests_are_canonical_and_run_through_the_velocity_fastest():
    result = [(r["amplitude"], r["velocity"]) for r in requests_of()]
    assert result == [(a, v) for a in ("0", "1", "2") for v in ("0.1", "1")]
    assert requests_of(amplitude=[2.0, 1, 0.0]) == requests_of()
    forces = {"motion": "transverse", "force": [0.5, 1], "amplitude": 1}
    result = sweep.points_of(configured({"pulled": forces}).sweeps["pulled"]).requests
    assert [(r["velocity"], r["force"]) for r in result] == [(None, "0.5"), (None, "1")]


def test_a_new_axis_keeps_the_old_requests():
    with_nu = requests_of(poisson=[0, 0.3])
    assert with_nu[:6] == requests_of()
    assert len(with_nu) == 12


def test_figures_ask_for_single_runs():
    steady = {"velocity": [0.5]}
    cone = {"velocity": 1, "amplitude": 1, "pressure": "power:exponent=1", "poisson": 0.3}
    cone["model"] = "polar"
    sweeps = {"transverse": cone, "continuous_bore": steady}
    configuration = configured(sweeps, figures=RUNS)
    kinds = [request["kind"] for request in sweep.runs_of(configuration, "continuous_bore")]
    assert kinds == ["field", "history", "history", "history"]
    (history,) = sweep.runs_of(configuration, "transverse")
    assert (history["periods"], history["velocity"]) == (4, "0.1")
    assert (history["pressure"], history["poisson"]) == ("power:exponent=1", "0.3")
    assert history["model"] == "polar"


@pytest.mark.parametrize("size", [1, 2, 4, 6, 50])
def test_batches_of_points_hold_every_request_once_and_in_order(size):
    for points in (points_of(), points_of(velocity=list(range(1, 30)), poisson=[0, 0.3])):
        cut = sweep.divide(points, size)
        assert [request for batch in cut for request in batch.requests] == points.requests
        assert len({batch.name for batch in cut}) == len(cut)


def sizes_of(points, size):
    return [len(batch.requests) for batch in sweep.divide(points, size)]


@pytest.mark.parametrize("size", [1, 2, 10, 100, 300])
def test_batches_are_equal_within_an_eighth_or_a_row(size):
    points = points_of(amplitude=list(range(1000)))
    sizes = sizes_of(points, size)
    assert len(sizes) == pytest.approx(2000 / size, rel=0.1)
    assert max(sizes) - min(sizes) <= max(2, 0.25 * size)
    assert sum(sizes) == 2000


def test_long_rows_are_cut_along_the_velocity():
    axis = [float(value) for value in range(1, 200)]
    sizes = sizes_of(points_of(velocity=axis), 50)
    assert len(sizes) == 3 * 4
    assert 44 <= min(sizes) <= max(sizes) <= 56


def names_of(size, **transverse):
    return {batch.name for batch in sweep.divide(points_of(**transverse), size)}


@pytest.mark.parametrize("amplitude", [0.5, 500.5, 2000])
def test_an_amplitude_more_changes_few_of_the_large_batches(amplitude):
    axis = [float(value) for value in range(1, 1000)]
    before, after = (names_of(200, amplitude=values) for values in (axis, [*axis, amplitude]))
    assert len(before) == len(after) == 10
    assert 1 <= len(after - before) <= 5


def test_a_batch_is_named_by_its_requests_and_the_code(monkeypatch):
    (batch,) = sweep.divide(points_of(amplitude=[1]), 50)
    assert sweep.Batch(**json.loads(json.dumps(batch._asdict()))).name == batch.name
    name = batch.name
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of other sources")
    assert batch.name != name


REQUEST = {"kind": "point", "motion": "bore", "velocity": "0.1", "amplitude": "1", "cells": None}


def test_everything_in_a_request_counts_for_the_name_of_its_result(monkeypatch):
    changes = [{"motion": "transverse"}, {"velocity": "0.11"}, {"cells": 8}, {"new": 1}]
    requests = [REQUEST, dict(reversed(REQUEST.items())), *(REQUEST | one for one in changes)]
    keys = [sweep.key_of(request) for request in requests]
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of other sources")
    assert keys[0] == keys[1]
    assert len({*keys, sweep.key_of(REQUEST)}) == len(keys)
