"""Sweeps: requests, batches of them, and answers from the store or the solver."""

import errno
import io
import json
import math
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from stubs.sweep_stub import EFFORT, Solver

import microslip
from microslip.config import load
from microslip.foundation import source_digest
from microslip.foundation.errors import InputError, SolverError
from microslip.models.contact import StepFailure
from microslip.solver.budget import Spent
from microslip.sweeps import batch_files, evaluate, sealed_files
from microslip.sweeps import batches as sweep
from microslip.sweeps.cache import Store
from microslip.sweeps.sealed_files import CacheError


def configured(**transverse):
    grid = {"velocity": [0.1, 1], "amplitude": [0, 1, 2], **transverse}
    bore = {"velocity": [0.5]}
    return load.from_mapping({"sweeps": {"transverse": grid, "continuous_bore": bore}})


def requests_of(**transverse):
    return list(sweep.PointRequests(configured(**transverse).sweeps["transverse"]))


@pytest.fixture
def store(tmp_path):
    return Store(tmp_path)


def test_requests_are_canonical_and_run_through_the_velocity_fastest():
    found = [(r["amplitude"], r["velocity"]) for r in requests_of()]
    assert found == [(a, v) for a in ("0", "1", "2") for v in ("0.1", "1")]
    assert requests_of(amplitude=[2.0, 1, 0.0]) == requests_of()


def test_a_motion_without_amplitude_has_none():
    (request,) = sweep.PointRequests(configured().sweeps["continuous_bore"])
    assert request["amplitude"] is None


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


@pytest.mark.parametrize("size", [1, 4, 6, 50])
def test_batches_hold_every_request_once(size):
    requests = requests_of()
    batches = sweep.batches(requests, size)
    assert [r for batch in batches.values() for r in batch] == requests
    assert len(batches) == math.ceil(6 / size)


def test_a_batch_is_named_by_what_it_answers(monkeypatch):
    requests = requests_of()
    names = sweep.batches(requests, 6).keys()
    assert sweep.batches(requests, 6).keys() == names
    longer = requests_of(amplitude=[0, 1, 2, 3])
    assert sweep.batches(requests, 2).keys() < sweep.batches(longer, 2).keys()
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of other sources")
    assert sweep.batches(requests, 6).keys() != names


def test_what_a_batch_holds_is_what_the_solver_said(monkeypatch, store, tmp_path):
    Solver(monkeypatch)
    requests = requests_of()
    cut = list(sweep.batches(requests, 4).values())
    paths = [tmp_path / f"{i}.json" for i in range(len(cut))]
    for path, part in zip(paths, cut, strict=True):
        batch_files.write_batch(path, sweep.run_batch(part, store)[0])
    alone = [sweep.answer(request, store)[0] for request in requests]
    assert list(sweep.records_for(requests, paths)) == alone
    answer = sweep.lookup(sweep.records_in(paths))
    assert [answer(request) for request in reversed(requests)] == alone[::-1]
    # the order of batches, and of requests in them, does not matter, nor what else they hold
    assert list(sweep.records_for(requests[4:0:-1], paths[::-1])) == alone[4:0:-1]
    with pytest.raises(sealed_files.CacheError, match="no batch answers .* amplitude 2"):
        list(sweep.records_for(requests, paths[:1]))
    paths[1].write_bytes(paths[1].read_bytes()[:-9])
    with pytest.raises(sealed_files.CacheError, match="is damaged; run again"):
        list(sweep.records_for(requests, paths))


def failing_at(monkeypatch, error, amplitude=2.0):
    """Have the stub of the solver raise an error at one amplitude."""
    Solver(monkeypatch)
    solve = microslip.solve

    def fail(motion, velocity, place, **settings):
        if place == amplitude:
            raise error
        return solve(motion, velocity, place, **settings)

    monkeypatch.setattr("microslip.solve", fail)


def test_a_batch_with_a_point_that_failed_is_whole_and_made_again(monkeypatch, store, tmp_path):
    failing_at(monkeypatch, SolverError("stalled"))
    records, done = sweep.run_batch(requests_of(), store)
    path = tmp_path / "batch.json"
    batch_files.write_batch(path, records, done["final"])
    assert batch_files.read_batch(path) == records
    assert batch_files.why_not_whole(path) == "it has points that failed"


def test_the_file_of_a_batch_is_not_opened_for_each_of_its_records(monkeypatch, store, tmp_path):
    Solver(monkeypatch)
    requests = requests_of()
    paths = [tmp_path / "0.json", tmp_path / "1.json"]
    for path, part in zip(paths, (requests[:3], requests[3:]), strict=True):
        batch_files.write_batch(path, sweep.run_batch(part, store)[0])
    opened, open_file = [], io.open

    def counted(file, *arguments, **settings):
        opened.append(Path(file))
        return open_file(file, *arguments, **settings)

    monkeypatch.setattr("builtins.open", counted)
    monkeypatch.setattr(io, "open", counted)  # what pathlib calls
    assert len(list(sweep.records_for(requests, paths))) == 6
    assert max(Counter(opened).values()) <= 2  # once for the places, once for the content


BATCH_DAMAGE = {
    "a bit": lambda text: text.replace(b'"0.5"', b'"0.6"', 1),
    "the end": lambda text: text[:-1],
    "half of it": lambda text: text[: len(text) // 2],
    "all": lambda text: b"",
    "a record": lambda text: text.partition(b"\n")[2],
    "the checksum": lambda text: text[: text.rfind(b"\n", 0, -1) + 1],
    "another file": lambda text: b"velocity,mu_macro\n",
}


@pytest.mark.parametrize("kind", BATCH_DAMAGE)
def test_a_damaged_batch_is_noticed(kind, monkeypatch, store, tmp_path):
    Solver(monkeypatch)
    path = tmp_path / "batch.json"
    batch_files.write_batch(path, sweep.run_batch(requests_of(velocity=[0.5]), store)[0])
    assert batch_files.why_not_whole(path) == ""
    whole = path.read_bytes()
    path.write_bytes(BATCH_DAMAGE[kind](whole))
    assert path.read_bytes() != whole
    assert batch_files.why_not_whole(path) == "it is damaged"
    assert batch_files.read_batch(path) is None
    with pytest.raises(sealed_files.CacheError, match="is damaged; run again"):
        list(sweep.records_in([path]))


def test_only_what_the_store_lacks_is_computed(monkeypatch, store):
    solver = Solver(monkeypatch)
    records, done = sweep.run_batch(requests_of(), store)
    assert (done["points"], done["computed"], solver.calls) == (6, 6, 6)
    again, done = sweep.run_batch(requests_of(), store)
    assert (again, done["computed"], solver.calls) == (records, 0, 6)
    _, done = sweep.run_batch(requests_of(amplitude=[0, 0.5, 1, 2]), store)
    assert (done["computed"], solver.calls) == (2, 8)


def test_a_damaged_result_is_computed_again_to_the_same_bytes(monkeypatch, store):
    solver = Solver(monkeypatch)
    request = requests_of()[3]
    record, _ = sweep.answer(request, store)
    path = store.path(sweep.group(request), record["key"])
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert sweep.answer(request, store)[0] == record
    assert solver.calls == 2
    assert path.read_bytes() == whole  # though the solver took another time


def test_a_record_is_the_same_computed_or_read(monkeypatch, store):
    Solver(monkeypatch, fails=2.0)
    for request in requests_of() + sweep.history_requests(configured(), "continuous_bore"):
        computed, took = sweep.answer(request, store)
        read, none = sweep.answer(request, store)
        assert took > 0 == none
        assert json.dumps(computed, sort_keys=True) == json.dumps(read, sort_keys=True)
        assert "solve_time_s" not in computed["result"]


def test_points_that_do_not_converge_are_data(monkeypatch, store):
    Solver(monkeypatch, fails=2.0)
    records, _ = sweep.run_batch(requests_of(), store)
    assert [record["result"]["converged"] for record in records].count(False) == 2
    record, _ = sweep.answer(requests_of()[-1], store)
    assert record["result"]["mu_macro"] is None
    assert record["result"]["reason"] == "no periodic state"


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
    assert len(list(store.folder.rglob("*.json"))) == 4  # the others are computed again


ERRORS_OF_THE_CODE = [
    TypeError("unsupported operand"),
    ZeroDivisionError("division"),
    ValueError("f(a) and f(b) must have different signs"),
    np.linalg.LinAlgError("Singular matrix"),
    AssertionError("not so"),
    KeyError("q"),
    RecursionError("too deep"),
    MemoryError("no room"),
]


@pytest.mark.parametrize("error", ERRORS_OF_THE_CODE, ids=lambda error: type(error).__name__)
def test_an_error_of_the_code_fails_the_batch(monkeypatch, store, error):
    failing_at(monkeypatch, error)
    with pytest.raises(type(error)):
        sweep.run_batch(requests_of(), store)
    assert len(list(store.folder.rglob("*.json"))) == 4  # the points before it are kept


def test_a_batch_in_which_every_point_fails_is_no_data(monkeypatch, store):
    Solver(monkeypatch)

    def fail(*_, **__):
        raise SolverError("stalled")

    monkeypatch.setattr("microslip.solve", fail)
    with pytest.raises(SolverError, match=r"every point of this batch failed \(6\).*: stalled"):
        sweep.run_batch(requests_of(), store)


@pytest.mark.parametrize("kind", sorted(sweep.FOLDERS))
def test_a_failure_of_the_solver_is_a_gap_for_every_kind_of_request(monkeypatch, kind):
    def fail(request):
        raise SolverError("a root finder\nfound none")

    monkeypatch.setitem(evaluate._KINDS, kind, fail)
    result = evaluate.computed({"kind": kind})
    assert result["converged"] is False
    assert result["reason"] == "SolverError: a root finder found none"
    assert not evaluate.is_final(result)


def test_a_point_that_failed_is_computed_again_and_kept_then(monkeypatch, store):
    def fail(*_, **__):
        raise SolverError("stalled")

    monkeypatch.setattr("microslip.solve", fail, raising=False)
    request = requests_of()[0]
    assert sweep.answer(request, store)[0]["result"]["reason"] == "SolverError: stalled"
    solver = Solver(monkeypatch)
    assert sweep.answer(request, store)[0]["result"]["converged"]
    assert sweep.answer(request, store)[0]["result"]["converged"]
    assert solver.calls == 1


@pytest.mark.parametrize(
    "error", [KeyboardInterrupt(), SystemExit(1), CacheError("no room"), OSError(errno.ENOSPC, "")]
)
def test_what_is_not_the_points_is_no_gap(monkeypatch, store, error):
    def fail(*_, **__):
        raise error

    monkeypatch.setattr("microslip.solve", fail, raising=False)
    with pytest.raises(type(error)):
        sweep.run_batch(requests_of(), store)


def test_what_ran_out_of_time_is_not_kept(monkeypatch, store):
    solver = Solver(monkeypatch)
    monkeypatch.setitem(EFFORT, "exhausted", "time")
    request = requests_of()[0]
    for _ in range(2):
        sweep.answer(request, store)
    assert solver.calls == 2
    monkeypatch.setitem(EFFORT, "exhausted", "work")  # which is the same everywhere
    for _ in range(2):
        sweep.answer(request, store)
    assert solver.calls == 3
