"""Output of a dry run: number of points."""

from microslip.app.dry_run import summary
from microslip.config import load
from microslip.sweeps import batches
from microslip.sweeps.batches import Batch
from microslip.sweeps.store import Store

AXES = {"velocity": [0.1, 1], "amplitude": [1, 2, 3]}


def test_points_that_are_stored_are_not_counted(tmp_path):
    batch = batches.points_of(load.from_mapping({"sweeps": {"bore": AXES}}).sweeps["bore"])
    assert summary([batch], tmp_path) == ["To solve: 6 points."]
    for request in batch.requests[:5]:
        key = batches.key_of(request)
        Store(tmp_path).write(batches.group(request), key, {"request": request, "result": {}})
    assert summary([batch], tmp_path) == ["To solve: 1 point."]
    assert summary([], tmp_path) == ["To solve: no points."]


def test_other_runs_and_maps_are_named(tmp_path):
    trials = Batch([{"kind": "trial", "motion": "bore", "velocity": "1"}] * 3)
    line = "To solve: the points of certified maps. Their number depends on the results."
    assert summary([trials, None], tmp_path) == ["To solve: 3 other runs.", line]
    assert summary([None], tmp_path) == [line]
