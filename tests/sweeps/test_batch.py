"""Batch files, the records that they share, journals, and errors of the solver."""

import errno
import shutil
from unittest.mock import Mock

import numpy as np
import pytest
from stubs.sweep_stub import EFFORT, Solver, configured, requests_of

import microslip
from microslip.contact.contact import StepFailure
from microslip.foundation.errors import CacheError, InputError, SolverError
from microslip.periodic.run import Spent
from microslip.sweeps import batch


def points(**transverse):
    grid = {"velocity": [0.1, 1], "amplitude": [0, 1, 2], **transverse}
    return requests_of(configured({"transverse": grid}), "transverse")


@pytest.fixture
def solver(monkeypatch):
    return Solver(monkeypatch)


def failing_at(monkeypatch, error):
    """Let the stub of the solver raise an error at the amplitude 2."""
    solve = microslip.solve

    def fail(**arguments):
        if arguments["amplitude"] == 2.0:
            raise error
        return solve(**arguments)

    monkeypatch.setattr("microslip.solve", fail)


def journals(folder):
    return list(folder.glob("*.journal"))


DAMAGE = {
    "a bit": lambda text: text.replace(b'"0.5"', b'"0.6"', 1),
    "half of it": lambda text: text[: len(text) // 2],
    "the checksum": lambda text: text[: text.rfind(b"\n", 0, -1) + 1],
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_a_damaged_batch_is_noticed_and_solved_again_to_the_same_bytes(kind, solver, tmp_path):
    path = tmp_path / "batch.jsonl"
    batch.solve(points(velocity=[0.5]), path)
    assert batch.is_final(path)
    whole = path.read_bytes()
    path.write_bytes(DAMAGE[kind](whole))
    assert path.read_bytes() != whole
    assert not batch.is_final(path)
    with pytest.raises(CacheError, match="is damaged; run again"):
        list(batch.records_in([path]))
    assert batch.solve(points(velocity=[0.5]), path)["computed"] == 3
    assert path.read_bytes() == whole


def test_a_batch_copied_over_another_one_is_noticed_and_solved_again(solver, tmp_path):
    for name, velocity in (("slow", 0.5), ("fast", 5)):
        batch.solve(points(velocity=[velocity]), tmp_path / f"{name}.jsonl")
    path = tmp_path / "slow.jsonl"
    whole = path.read_bytes()
    shutil.copy(tmp_path / "fast.jsonl", path)
    assert batch.is_final(tmp_path / "fast.jsonl") and not batch.is_final(path)
    assert batch.solve(points(velocity=[0.5]), path)["computed"] == 3
    assert path.read_bytes() == whole


def test_a_job_takes_the_points_of_other_batches_with_the_same_rows(solver, tmp_path):
    first = batch.solve(points(), tmp_path / "a.jsonl")
    assert (first["points"], first["computed"], solver.calls) == (6, 6, 6)
    assert batch.solve(points(), tmp_path / "b.jsonl")["computed"] == 0
    assert batch.read(tmp_path / "a.jsonl") == batch.read(tmp_path / "b.jsonl")
    assert batch.solve(points(amplitude=[0, 0.5, 1, 2]), tmp_path / "c.jsonl")["computed"] == 2
    assert batch.solve(points(velocity=[0.1, 0.2, 1]), tmp_path / "d.jsonl")["computed"] == 3
    assert batch.solve(points(tolerance=1e-2), tmp_path / "e.jsonl")["computed"] == 6
    assert not journals(tmp_path)


def test_a_job_continues_from_the_journal_of_a_killed_one(solver, tmp_path):
    whole, path = tmp_path / "whole" / "batch.jsonl", tmp_path / "killed" / "batch.jsonl"
    batch.solve(points(), whole)
    with batch.Job(path) as killed:
        killed.solve(points()[:4])
    (journal,) = journals(path.parent)
    lines = journal.read_bytes()
    assert lines.count(b"\n") == 4
    journal.write_bytes(lines[:-40])  # the last line was not written completely
    assert batch.solve(points(), path)["computed"] == 3
    assert path.read_bytes() == whole.read_bytes()
    assert not journals(path.parent)


def test_a_journal_is_used_by_another_batch_and_stays_until_its_points_are_in_one(solver, tmp_path):
    with batch.Job(tmp_path / "other.jsonl") as killed:
        killed.solve(points(amplitude=[1, 3]))
    assert batch.solve(points(), tmp_path / "batch.jsonl")["computed"] == 4
    assert len(journals(tmp_path)) == 1
    assert batch.solve(points(amplitude=[1, 3]), tmp_path / "other.jsonl")["computed"] == 0
    assert not journals(tmp_path)


GAPS = [SolverError("stalled"), StepFailure("diverged"), Spent("the work is spent")]
GAPS += [InputError("velocity", -1, "allowed is a number of at least 0")]


@pytest.mark.parametrize("error", GAPS, ids=lambda error: type(error).__name__)
def test_a_point_at_which_the_solver_fails_is_data_too(monkeypatch, solver, tmp_path, error):
    path = tmp_path / "batch.jsonl"
    with monkeypatch.context() as patch:
        failing_at(patch, error)
        batch.solve(points(), path)
    records = batch.read(path)
    assert [record["result"]["converged"] for record in records] == 4 * [True] + 2 * [False]
    assert records[-1]["result"]["reason"] == f"{type(error).__name__}: {error}"
    assert not batch.is_final(path)
    assert not batch.is_final(tmp_path / "none.jsonl")
    assert batch.solve(points(), tmp_path / "again.jsonl")["computed"] == 2  # the failed points


NOT_OF_THE_POINT = [TypeError(), np.linalg.LinAlgError(), MemoryError(), KeyboardInterrupt()]
NOT_OF_THE_POINT += [CacheError("no room"), OSError(errno.ENOSPC, "")]


@pytest.mark.parametrize("error", NOT_OF_THE_POINT, ids=lambda error: type(error).__name__)
def test_an_error_of_the_code_or_the_machine_fails_the_batch(monkeypatch, solver, tmp_path, error):
    failing_at(monkeypatch, error)
    with pytest.raises(type(error)):
        batch.solve(points(), tmp_path / "batch.jsonl")
    (journal,) = journals(tmp_path)
    assert journal.read_bytes().count(b"\n") == 4  # earlier points are stored


def test_a_batch_in_which_every_point_fails_is_no_data(monkeypatch, solver, tmp_path):
    failing_at(monkeypatch, SolverError("stalled"))
    with pytest.raises(SolverError, match=r"every point of this batch failed \(2\).*: stalled"):
        batch.solve(points(amplitude=[2]), tmp_path / "batch.jsonl")


@pytest.mark.parametrize(("budget", "computed"), [("time", 6), ("work", 0)])
def test_what_ran_out_of_time_is_computed_again(monkeypatch, solver, tmp_path, budget, computed):
    monkeypatch.setitem(EFFORT, "exhausted", budget)
    batch.solve(points(), tmp_path / "a.jsonl")
    assert batch.solve(points(), tmp_path / "b.jsonl")["computed"] == computed


def test_a_folder_that_cannot_be_written_to_is_one_line_before_any_computation(
    solver, tmp_path, monkeypatch
):
    (tmp_path / "file").touch()
    monkeypatch.setattr("os.fsync", Mock(side_effect=OSError(errno.ENOSPC, "full")))
    for folder, reason in (("file/inside", "Not a directory"), ("new", "full")):
        with pytest.raises(CacheError, match=f"cannot write to .*{folder}: {reason}; make room"):
            batch.solve(points(), tmp_path / folder / "batch.jsonl")
    assert not solver.calls
