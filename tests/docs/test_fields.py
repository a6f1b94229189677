"""Every field of a result and every variable of a dataset is in a table of the documentation."""

from dataclasses import fields
from pathlib import Path

import pytest
import xarray as xr
from stubs import certified_stub, claims_stub, propulsion_stub, studies_stub
from stubs.sweep_stub import Solver

import microslip
from microslip.config import load
from microslip.datasets import certified_map, sweep_dataset
from microslip.datasets.query.drift import Drift
from microslip.si.prediction import COLUMNS
from microslip.studies import registry
from microslip.sweeps import batches
from microslip.sweeps.store import Store

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "fields.md").read_text(encoding="utf-8")
GRIDS = {
    "transverse": {"velocity": [0.1, 1], "amplitude": [0.5, 2], "poisson": [0, 0.3]},
    "bore": {"velocity": [0.1, 1], "amplitude": [0.5, 2]},
    "continuous_bore": {"velocity": [0.1, 1]},
}


def section(title):
    """Names and meanings in the table under a heading."""
    text = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    rows = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| `")]
    found = {}
    for first, *meaning in rows:
        for name in first.split(","):
            found[name.strip().strip("`")] = " ".join(meaning).strip()
    assert all(found.values())
    return found


RECORDS = {
    "A fit": microslip.Fit,
    "A force history": microslip.History,
    "A period of the periodic state": microslip.Period,
    "Shakedown": microslip.Shakedown,
    "The line of a self-propelled motion": microslip.PropulsionLine,
    "A self-propelled motion, in units": microslip.RealPropulsionLine,
}


def test_every_column_of_a_prediction_is_in_its_table_and_no_other():
    assert set(section("A real contact")) == set(COLUMNS)


@pytest.mark.parametrize("title", RECORDS)
def test_every_field_of_a_record_is_in_its_table_and_no_other(title):
    assert set(section(title)) == {field.name for field in fields(RECORDS[title])}


def test_every_name_of_a_point_is_in_its_table_and_no_other():
    contacts = "phase=0;phase=180"
    asked = ({"force": 0.5, "mass": 0.1, "contacts": contacts}, {"stiffness": 1.0, "damping": 0.1})
    points = [
        microslip.solve("transverse", None if "force" in one else 0.5, 0.5, tolerance=1e-2, **one)
        for one in asked
    ]
    points.append(microslip.solve("continuous-bore", 1.0, model="polar", tolerance=1e-2))
    assert set(section("One point")) == set().union(*(one.to_dict() for one in points))


def all_names(data):
    """Variables and coordinates of all groups of a DataTree, bounds and fine axes too."""
    return {str(name) for node in data.subtree for name in node.to_dataset().variables}


def written(name, folder):
    given = load.from_mapping({"sweeps": GRIDS})
    store, grid = Store(folder), given.sweeps[name]
    answered = [
        [batches.answer(request, store)[0] for request in requests]
        for requests in (batches.PointRequests(grid), batches.history_requests(given, name))
    ]
    path = folder / f"{name}.nc"
    sweep_dataset.write_sweep(path, grid, *answered, given.of_sweep(name))
    with xr.open_datatree(path) as data:
        return all_names(data)


@pytest.mark.slow
def test_every_variable_of_a_sweep_is_in_the_table_and_no_other(tmp_path, monkeypatch):
    Solver(monkeypatch)
    found = set().union(*(written(name, tmp_path) for name in GRIDS))
    fine = {name for name in found if name.removesuffix("_curve") in found and "_curve" in name}
    assert set(section("A sweep")) == found - fine


def test_every_variable_of_a_certified_map_is_in_its_table_and_no_other():
    axes = GRIDS["bore"] | {"poisson": [0, 0.3], "adaptive": {"error": 0.1}}
    (map_,) = load.from_mapping({"sweeps": {"bore": axes}}).certified.values()
    flat = {"mu_macro": 0.5, "mu_macro_error": 0.0, "converged": True}

    def answer(request):
        return {"key": batches.key_of(request), "result": flat, "versions": {}}

    data = certified_map.build(map_, certified_stub.played(map_, answer))
    assert set(section("A certified map")) == set(map(str, data.variables))


def test_every_variable_of_a_map_of_drift_and_of_its_answers_is_in_its_table_and_no_other():
    data = certified_stub.drifting()
    answer = Drift(data).at(0.5, 1.0)
    known = set(data.variables) | set(answer.variables)
    assert set(section("A certified map of drift")) == set(map(str, known))


STUDIES = {
    "accuracy": ("The study of accuracy", studies_stub.accuracy_result),
    "stability": ("The study of stability", studies_stub.stability_result),
}


@pytest.mark.parametrize("study", STUDIES)
def test_every_variable_of_a_study_is_in_its_table_and_no_other(study):
    title, result = STUDIES[study]
    answer, _ = studies_stub.answered(result)
    data = registry.build(study, studies_stub.configured(), answer)
    assert set(section(title)) == set(map(str, data.variables))


def test_every_variable_of_the_claims_is_in_their_table_and_no_other():
    answer, _ = claims_stub.answered()
    data = registry.build("claims", claims_stub.configured(), answer)
    assert set(section("The check of the paper")) == set(map(str, data.variables))


def test_every_variable_of_propulsion_is_in_its_table_and_no_other():
    answer, _ = studies_stub.answered(propulsion_stub.propulsion_result)
    data = registry.build("propulsion", propulsion_stub.configured(), answer)
    assert set(section("The study of propulsion")) == set(map(str, data.variables))


def test_work_effort_and_periods_mean_one_thing_each():
    for title in ("One point", "A sweep", "The study of accuracy", "The study of stability"):
        meanings = section(title)
        if "work" in meanings:
            assert "step solves times unknowns" in meanings["work"].lower()
        if "effort" in meanings:
            assert "iterations of the step solver times unknowns" in meanings["effort"].lower()
        if "periods" in meanings:
            assert "full periods" in meanings["periods"].lower()
    assert "effort" in section("The study of accuracy")
    assert "work" in section("The study of stability")
