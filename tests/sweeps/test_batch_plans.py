"""What was planned stays as it is: batches of a configuration that grows, shrinks and forgets."""

import pytest

from microslip.app.plan import Plan
from microslip.config import load
from microslip.foundation import source_digest
from microslip.sweeps import batch_plans, batches
from microslip.sweeps.sealed_files import CacheError

VELOCITY, AMPLITUDE = [0.1, 0.2, 0.4, 0.8], [0.5, 1, 1.5, 2, 2.5]


def planned(folder, size=4, made=True, **axes):
    """A plan of a map of twenty points, made or not, in what is left of those before it."""
    grid = {"velocity": VELOCITY, "amplitude": AMPLITUDE, **axes}
    given = {"sweeps": {"transverse": grid}, "points_per_job": size}
    plan = Plan(load.from_mapping(given), batch_plans.Folder(folder))
    plan.batches_in("transverse")
    plan.keep_planned()
    for file in plan.batch_files("transverse") if made else ():
        (folder / file).touch()
    return plan


def points(plan, names=None):
    """(amplitude, velocity) of all points in some batches of a plan."""
    cuts = plan.batches_in("transverse")
    return [
        (float(r["amplitude"]), float(r["velocity"]))
        for name in (cuts if names is None else names)
        for r in cuts[name]
    ]


def new(before, after):
    return set(after.batches_in("transverse")) - set(before.batches_in("transverse"))


GROWN = {
    "a velocity below": {"velocity": [0.05, *VELOCITY]},
    "a velocity between": {"velocity": sorted([0.3, *VELOCITY])},
    "an amplitude": {"amplitude": [0, *AMPLITUDE]},
    "both": {"velocity": [*VELOCITY, 1.6], "amplitude": [*AMPLITUDE, 3]},
}


@pytest.mark.parametrize("grown", GROWN)
def test_what_is_added_is_in_new_batches_and_these_hold_nothing_else(grown, tmp_path):
    before = planned(tmp_path)
    after = planned(tmp_path, **GROWN[grown])
    assert set(before.batches_in("transverse")) < set(after.batches_in("transverse"))
    added = points(after, new(before, after))
    assert sorted(points(before) + added) == sorted(points(after))
    assert len(set(points(after))) == len(points(after)) == len(after.requests_in("transverse"))
    assert len(new(before, after)) == -(-len(added) // 4)


@pytest.mark.slow
def test_twenty_thousand_points_and_a_velocity_start_one_job(tmp_path):
    many = {"velocity": [k / 1000 for k in range(1, 201)], "size": 100}
    many["amplitude"] = [k / 50 for k in range(1, 101)]
    before = planned(tmp_path, **many)
    after = planned(tmp_path, **many | {"velocity": [*many["velocity"], 0.0155]})
    assert len(before.batches_in("transverse")) == 200
    (added,) = new(before, after)
    assert {velocity for _, velocity in points(after, [added])} == {0.0155}


def test_a_configuration_that_shrinks_needs_some_of_the_batches_and_none_that_is_new(tmp_path):
    before = planned(tmp_path)
    after = planned(tmp_path, amplitude=AMPLITUDE[:3])
    assert not new(before, after)
    assert len(after.batches_in("transverse")) == 3
    # and back
    assert set(planned(tmp_path).batches_in("transverse")) == set(before.batches_in("transverse"))


def test_what_is_planned_and_not_made_is_planned_again_by_whoever_begins_a_run(tmp_path):
    unmade = planned(tmp_path, made=False)
    other = planned(tmp_path, size=10, made=False)
    assert [len(cut) for cut in other.batches_in("transverse").values()] == [10, 10]
    # the same batches, if nothing has changed: those that are there stay
    first, *rest = unmade.batches_in("transverse")
    (tmp_path / f"batches/transverse/{rest[0]}.json").touch()
    again = planned(tmp_path, made=False)
    assert len(again.batches_in("transverse")) == 5
    (tmp_path / f"batches/transverse/{first}.json").touch()
    assert set(planned(tmp_path).batches_in("transverse")) == {first, *rest}


def test_a_job_finds_its_requests_and_plans_nothing(tmp_path, monkeypatch):
    """Nor does it forget what is not made yet, as it is about to make it."""
    before = planned(tmp_path)
    after = planned(tmp_path, velocity=[0.05, *VELOCITY], made=False)
    job = Plan(after.configuration, batch_plans.Folder(tmp_path, forgets=False))
    assert set(job.batches_in("transverse")) == set(after.batches_in("transverse"))
    expected = after.batches_in("transverse")
    job = Plan(after.configuration, batch_plans.Folder(tmp_path, forgets=False))
    monkeypatch.setattr(batches, "key_of", None)  # what planning would ask for
    for name in new(before, after):
        assert job.requests_of("transverse", name) == expected[name]


def test_a_job_that_finds_no_plan_makes_one(tmp_path):
    plan = planned(tmp_path)
    job = Plan(plan.configuration, batch_plans.Folder(tmp_path / "empty", forgets=False))
    name, requests = next(iter(plan.batches_in("transverse").items()))
    assert job.requests_of("transverse", name) == requests
    assert job.requests_of("transverse", "0" * 16) is None


def test_a_plan_is_of_the_sources_that_it_was_made_with(tmp_path, monkeypatch):
    before = planned(tmp_path)
    monkeypatch.setattr(source_digest, "of_request", lambda request: "of other sources" * 2)
    after = planned(tmp_path, velocity=[0.05, *VELOCITY])
    assert not set(before.batches_in("transverse")) & set(after.batches_in("transverse"))
    assert len(list(tmp_path.glob("batches/transverse/*.plan"))) == 2


@pytest.mark.parametrize("text", [b"", b"half", b'{"batch":"0"}\n', b'[]\n"0"\n'])
def test_a_plan_that_is_damaged_is_made_again(text, tmp_path):
    before = planned(tmp_path)
    (file,) = tmp_path.glob("batches/transverse/*.plan")
    whole = file.read_bytes()
    file.write_bytes(whole[:30] + text + whole[40:])
    assert not batch_plans.batches_in(file.read_bytes())
    assert planned(tmp_path).batches_in("transverse") == before.batches_in("transverse")
    assert file.read_bytes() == whole


def test_a_plan_that_cannot_be_read_is_told(tmp_path):
    (tmp_path / "plan").mkdir()
    with pytest.raises(CacheError, match="cannot read .*plan"):
        batch_plans.Folder(tmp_path).read("plan")


@pytest.mark.parametrize("count", [1, 2])
def test_requests_are_packed_and_unpacked(count):
    requests = [{"kind": "point", "velocity": str(k), "cells": None} for k in range(count)]
    text = batch_plans.text_of({"0a": requests, "0b": requests[:1]})
    assert batch_plans.batches_in(text) == {"0a": requests, "0b": requests[:1]}
    assert batch_plans.requests_of(text, "0b") == requests[:1]
    assert batch_plans.requests_of(text, "0c") is None
    assert batch_plans.requests_of(b"", "0a") is None


def test_what_a_dataset_is_made_of_does_not_depend_on_how_it_was_cut(tmp_path):
    planned(tmp_path)
    grown = planned(tmp_path, velocity=[0.05, *VELOCITY])
    anew = planned(tmp_path / "anew", velocity=[0.05, *VELOCITY])
    assert grown.batch_files("transverse") != anew.batch_files("transverse")
    assert grown.fingerprint_of("transverse.nc") == anew.fingerprint_of("transverse.nc")
    assert grown.fingerprint_of("transverse.nc") != planned(tmp_path).fingerprint_of(
        "transverse.nc"
    )
