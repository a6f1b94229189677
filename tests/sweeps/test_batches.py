"""Requests of sweeps, batches, and results from the store or the solver."""

import errno
import json
from unittest.mock import Mock

import numpy as np
import pytest
from stubs.sweep_stub import EFFORT, Solver

import microslip
from microslip.config import load
from microslip.contact.contact import StepFailure
from microslip.foundation import source_digest
from microslip.foundation.errors import CacheError, InputError, SolverError
from microslip.solver.budget import Spent
from microslip.sweeps import batches as sweep
from microslip.sweeps import evaluate
from microslip.sweeps.store import Store, is_final, write


def configured(**transverse):
    grid = {"velocity": [0.1, 1], "amplitude": [0, 1, 2], **transverse}
    bore = {"velocity": [0.5]}
    return load.from_mapping({"sweeps": {"transverse": grid, "continuous_bore": bore}})


def requests_of(**transverse):
    return points_of(**transverse).requests


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path)


def test_requests_are_canonical_and_run_through_the_velocity_fastest():
    result = [(r["amplitude"], r["velocity"]) for r in requests_of()]
    assert result == [(a, v) for a in ("0", "1", "2") for v in ("0.1", "1")]
    assert requests_of(amplitude=[2.0, 1, 0.0]) == requests_of()


def test_a_new_axis_keeps_the_old_requests():
    with_nu = requests_of(poisson=[0, 0.3])
    assert with_nu[:6] == requests_of()
    assert len(with_nu) == 12


def test_single_runs_for_the_figures():
    kinds = [r["kind"] for r in sweep.history_requests(configured(), "continuous_bore")]
    assert kinds == ["field", "history", "history", "history"]
    (history,) = sweep.history_requests(configured(), "transverse")
    assert (history["periods"], history["velocity"]) == (4, "0.1")
    assert sweep.history_requests(configured(), "bore") == []


def points_of(**transverse):
    return sweep.points_of(configured(**transverse).sweeps["transverse"])


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


def test_the_batches_of_the_default_sweeps_keep_two_cores_busy():
    configuration = load.load("config/config.yaml")
    points = sweep.points_of(configuration.sweeps["bore"])
    sizes = sizes_of(points, configuration.points_per_job["bore"])
    assert len(sizes) % 2 == 0
    assert max(sizes) - min(sizes) <= len(points.values)


def names_of(size, **transverse):
    return {batch.name for batch in sweep.divide(points_of(**transverse), size)}


def test_long_rows_are_cut_along_the_velocity():
    axis = [float(value) for value in range(1, 200)]
    sizes = sizes_of(points_of(velocity=axis), 50)
    assert len(sizes) == 3 * 4
    assert 44 <= min(sizes) <= max(sizes) <= 56


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


@pytest.mark.parametrize(
    ("name", "value"),
    [("motion", "transverse"), ("velocity", "0.11"), ("amplitude", "0"), ("cells", 8), ("new", 1)],
)
def test_everything_in_a_request_counts_for_the_name_of_its_result(name, value, monkeypatch):
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of these sources")
    key = sweep.key_of(REQUEST)
    assert sweep.key_of({**REQUEST, name: value}) != key
    assert sweep.key_of(dict(reversed(REQUEST.items()))) == key
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of other sources")
    assert sweep.key_of(REQUEST) != key


def test_swapped_values_and_the_format_of_records_count(monkeypatch):
    key = sweep.key_of(REQUEST)
    assert sweep.key_of({**REQUEST, "velocity": "1", "amplitude": "0.1"}) != key
    monkeypatch.setattr(sweep, "RECORD_FORMAT", 99)
    assert sweep.key_of(REQUEST) != key


def failing_at(monkeypatch, error):
    """Let the stub of the solver raise an error at the amplitude 2."""
    Solver(monkeypatch)
    solve = microslip.solve

    def fail(**arguments):
        if arguments["amplitude"] == 2.0:
            raise error
        return solve(**arguments)

    monkeypatch.setattr("microslip.solve", fail)


BATCH_DAMAGE = {
    "a bit": lambda text: text.replace(b'"0.5"', b'"0.6"', 1),
    "half of it": lambda text: text[: len(text) // 2],
    "a record": lambda text: text.partition(b"\n")[2],
    "the checksum": lambda text: text[: text.rfind(b"\n", 0, -1) + 1],
    "another file": lambda text: b"velocity,mu_macro\n",
}


@pytest.mark.parametrize("kind", BATCH_DAMAGE)
def test_a_damaged_batch_is_noticed(kind, monkeypatch, store, tmp_path):
    Solver(monkeypatch)
    path = tmp_path / "batch.jsonl"
    records = sweep.run_batch(requests_of(velocity=[0.5]), store)[0]
    write(path, records)
    assert is_final(path)
    assert list(sweep.records_in([path, path])) == records * 2
    whole = path.read_bytes()
    path.write_bytes(BATCH_DAMAGE[kind](whole))
    assert path.read_bytes() != whole
    assert not is_final(path)
    with pytest.raises(CacheError, match="is damaged; run again"):
        list(sweep.records_in([path]))


def test_a_batch_with_a_point_that_failed_is_readable_and_not_final(monkeypatch, store, tmp_path):
    failing_at(monkeypatch, SolverError("stalled"))
    records, counts = sweep.run_batch(requests_of(), store)
    path = tmp_path / "batch.jsonl"
    write(path, records, counts["final"])
    assert list(sweep.records_in([path])) == records
    assert not is_final(path)
    assert not is_final(tmp_path / "none.jsonl")


def test_only_what_the_store_lacks_is_computed(monkeypatch, store):
    solver = Solver(monkeypatch)
    records, counts = sweep.run_batch(requests_of(), store)
    assert (counts["points"], counts["computed"], solver.calls) == (6, 6, 6)
    again, counts = sweep.run_batch(requests_of(), store)
    assert (again, counts["computed"], solver.calls) == (records, 0, 6)
    _, counts = sweep.run_batch(requests_of(amplitude=[0, 0.5, 1, 2]), store)
    assert (counts["computed"], solver.calls) == (2, 8)


def test_a_damaged_result_is_computed_again_to_the_same_bytes(monkeypatch, store):
    solver = Solver(monkeypatch)
    request = requests_of()[3]
    record, _ = sweep.answer(request, store)
    path = store.path(sweep.group(request), record["key"])
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert sweep.answer(request, store)[0] == record
    assert solver.calls == 2
    assert path.read_bytes() == whole  # the time of the solver is not stored


def test_a_record_is_the_same_computed_or_read(monkeypatch, store):
    Solver(monkeypatch, fails=2.0)
    for request in requests_of() + sweep.history_requests(configured(), "continuous_bore"):
        computed, took = sweep.answer(request, store)
        read, none = sweep.answer(request, store)
        assert took > 0 == none
        assert json.dumps(computed, sort_keys=True) == json.dumps(read, sort_keys=True)
        assert "solve_time_s" not in computed["result"]


GAPS = [
    SolverError("stalled"),
    StepFailure("diverged"),
    Spent("the work is spent"),
    InputError("velocity", -1, "allowed is a number of at least 0"),
]


@pytest.mark.parametrize("error", GAPS, ids=lambda error: type(error).__name__)
def test_a_point_at_which_the_solver_fails_is_data_too(monkeypatch, store, error):
    failing_at(monkeypatch, error)
    records, _ = sweep.run_batch(requests_of(), store)
    assert [record["result"]["converged"] for record in records] == 4 * [True] + 2 * [False]
    assert records[-1]["result"]["reason"] == f"{type(error).__name__}: {error}"
    assert len(list(store.folder.rglob("*.json"))) == 4  # failed points are not stored


NOT_OF_THE_POINT = [
    TypeError("unsupported operand"),
    ValueError("f(a) and f(b) must have different signs"),
    np.linalg.LinAlgError("Singular matrix"),
    RecursionError("too deep"),
    MemoryError("no room"),
    KeyboardInterrupt(),
    SystemExit(1),
    CacheError("no room"),
    OSError(errno.ENOSPC, ""),
]


@pytest.mark.parametrize("error", NOT_OF_THE_POINT, ids=lambda error: type(error).__name__)
def test_an_error_of_the_code_or_the_machine_fails_the_batch(monkeypatch, store, error):
    failing_at(monkeypatch, error)
    with pytest.raises(type(error)):
        sweep.run_batch(requests_of(), store)
    assert len(list(store.folder.rglob("*.json"))) == 4  # earlier points are stored


def test_a_batch_in_which_every_point_fails_is_no_data(monkeypatch, store):
    failing_at(monkeypatch, SolverError("stalled"))
    with pytest.raises(SolverError, match=r"every point of this batch failed \(2\).*: stalled"):
        sweep.run_batch(requests_of(amplitude=[2]), store)


@pytest.mark.parametrize("kind", sorted(sweep.FOLDERS))
def test_a_failure_of_the_solver_is_a_gap_for_every_kind_of_request(monkeypatch, kind):
    fail = Mock(side_effect=SolverError("a root finder\nfound none"))
    monkeypatch.setitem(evaluate._KINDS, kind, fail)
    result = evaluate.computed({"kind": kind})
    assert result["converged"] is False
    assert result["reason"] == "SolverError: a root finder found none"
    assert not evaluate.is_final(result)


def test_what_ran_out_of_time_is_not_kept(monkeypatch, store):
    solver = Solver(monkeypatch)
    monkeypatch.setitem(EFFORT, "exhausted", "time")
    request = requests_of()[0]
    for _ in range(2):
        sweep.answer(request, store)
    assert solver.calls == 2
    monkeypatch.setitem(EFFORT, "exhausted", "work")  # the work does not depend on the computer
    for _ in range(2):
        sweep.answer(request, store)
    assert solver.calls == 3
