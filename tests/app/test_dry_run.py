"""Output of a dry run: number of points, and the estimated time."""

import pytest

from microslip.app import dry_run
from microslip.config import load
from microslip.sweeps import batches
from microslip.sweeps.batches import Batch
from microslip.sweeps.store import Store

AXES = {"velocity": [0.1, 1], "amplitude": [1, 2, 3]}


def summary(jobs, folder, cores, compiles=False):
    return dry_run.summary(jobs, folder, cores, compiles=compiles)


def jobs(group="bore", **changed):
    grid = load.from_mapping({"sweeps": {group: AXES | changed}}).sweeps[group]
    return [(group, batches.points_of(grid))]


def seconds_in(lines):
    """The estimated time in the first line, in seconds."""
    count, unit = lines[0].partition("about ")[2].split()[:2]
    return float(count) * {"seconds": 1, "minutes": 60, "hours": 3600}[unit]


def log(folder, name, text):
    path = folder / "logs" / "solve" / "bore" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def test_points_that_are_stored_are_not_counted(tmp_path):
    ((_, batch),) = jobs()
    lines = summary(jobs(), tmp_path, 2)
    assert lines[0].startswith("To solve: 6 points, about ")
    for request in batch.requests[:5]:
        key = batches.key_of(request)
        Store(tmp_path).write(batches.group(request), key, {"request": request, "result": {}})
    lines = summary(jobs(), tmp_path, 2)
    assert lines[0].startswith("To solve: 1 point, about ")
    assert summary([], tmp_path, 2) == ["To solve: no points."]


def test_the_time_comes_from_earlier_batches_if_there_are_any(tmp_path):
    assert seconds_in(summary(jobs(), tmp_path, 1)) == 10.0
    log(tmp_path, "a.log", "10 points, 10 computed in 3000.00 s of CPU time\n")
    log(tmp_path, "b.log", "not converged: bore\n40 points, 20 computed in 6000.00 s of CPU time\n")
    log(tmp_path, "c.log", "40 points, 0 computed in 0.00 s of CPU time\n")
    lines = summary(jobs(), tmp_path, 1)
    assert seconds_in(lines) == pytest.approx(6 * 300.0, rel=0.05)  # 9000 s for 30 points


def test_jobs_share_the_cores_and_none_is_shorter_than_its_batch(tmp_path):
    log(tmp_path, "a.log", "1 points, 1 computed in 100.00 s of CPU time\n")
    ((group, batch),) = jobs()
    parts = [(group, Batch([request])) for request in batch.requests]
    assert seconds_in(summary(parts, tmp_path, 1)) == pytest.approx(600, rel=0.1)
    assert seconds_in(summary(parts, tmp_path, 3)) == pytest.approx(200, rel=0.25)
    assert seconds_in(summary(jobs(), tmp_path, 3)) == pytest.approx(600, rel=0.1)


def test_the_time_is_a_lower_bound_where_requests_have_no_typical_time(tmp_path):
    trials = Batch([{"kind": "trial", "motion": "bore", "velocity": "1"}] * 3)
    certified = ("certified_bore", None)
    lines = summary([("accuracy", trials), certified], tmp_path, 2, compiles=True)
    assert lines[0].startswith("To solve: 3 other runs, at least ")
    assert "certified maps" in lines[1]
    assert lines[2].startswith("Compiling the solver comes first: about ")
    (line,) = summary([certified], tmp_path, 2)
    assert line.startswith("To solve: the points of certified maps")
