"""Plans in a storage: kept, found again by another machine, and never forgotten."""

import shutil
from pathlib import Path

import pytest

from microslip.app.bucket import Bucket
from microslip.app.plan import Plan
from microslip.config import load


class Stored:
    """Stands in for an object of a storage of Snakemake, with a folder for the bucket."""

    def __init__(self, there, here):
        self.there, self.here = Path(there), Path(here)

    def exists(self):
        return self.there.exists()

    def local_path(self):
        return self.here

    def retrieve_object(self):
        shutil.copy(self.there, self.here)  # the folder has to be there

    def store_object(self):
        self.there.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(self.here, self.there)


def planned(machine, **axes):
    """A plan of four points or more, two a job, on a machine of its own."""
    bucket = Bucket(lambda file: Stored(machine.parent / "bucket" / file, machine / file))
    grid = {"velocity": [0.5, 2], "amplitude": [0, 1], **axes}
    given = {"sweeps": {"bore": grid}, "points_per_job": 2}
    plan = Plan(load.from_mapping(given), bucket)
    plan.batches_in("bore")
    plan.keep_planned()
    return plan


@pytest.mark.parametrize("axes", [{"velocity": [0.1, 0.5, 2]}, {"amplitude": [0, 0.5, 1]}])
def test_another_machine_keeps_what_was_planned_though_it_sees_no_batch(axes, tmp_path):
    before, after = planned(tmp_path / "one"), planned(tmp_path / "two", **axes)
    old, now = before.batches_in("bore"), after.batches_in("bore")
    assert {name: now[name] for name in old} == old
    (new,) = set(now) - set(old)
    assert len(now[new]) == 2
    job = planned(tmp_path / "three", **axes)
    assert job.requests_of("bore", new) == now[new]
