"""The tables of the documentation list every field of a result and every variable of a dataset."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from stubs.eq6_map import eq6_map
from stubs.sweep_stub import Solver

import microslip
from microslip.config import load
from microslip.datasets import sweep_dataset
from microslip.datasets.catalogue import FORMS
from microslip.datasets.variables import TABLE, rows_of
from microslip.scene.files import UNITS
from microslip.si.output import Prediction
from microslip.sweeps import batch, request

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "fields.md").read_text(encoding="utf-8")
GRIDS = {
    "transverse": {
        "motion": "transverse",
        "velocity": [0.1, 1],
        "amplitude": [0.5, 2],
        "poisson": [0, 0.3],
    },
    "bore": {"motion": "bore", "velocity": [0.1, 1], "amplitude": [0.5, 2]},
    "continuous_bore": {"motion": "continuous-bore", "velocity": [0.1, 1]},
}
MOTIONS = [grid["motion"] for grid in GRIDS.values()]
RUNS = {
    "force": {"kind": "history", "sweep": "transverse"},
    "tractions": {"kind": "field", "sweep": "continuous_bore"},
    "approach": {"kind": "transients", "sweep": "continuous_bore"},
}


def section(title):
    """Meanings by name in the table under a heading."""
    text = PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]
    rows = [line.strip("|").split("|") for line in text.splitlines() if line.startswith("| `")]
    meanings = {}
    for first, *meaning in rows:
        for name in first.split(","):
            meanings[name.strip().strip("`")] = " ".join(meaning).strip()
    assert all(meanings.values())
    return meanings


RECORDS = {
    "A force history": lambda: microslip.history("transverse", 0.5, 0.5, cells=4, steps=8).values,
    "A period of the periodic state": lambda: microslip.period(
        "transverse", 0.5, 0.5, cells=4, angles=4, steps=8
    ).to_dict(),
    "Shakedown": lambda: microslip.shakedown("transverse", 0.5, 0.2, tolerance=0.1).to_dict(),
    "A self-propelled motion": lambda: microslip.propulsion(
        "elliptic:forward_cycles=2,phase=0", 0.3, tolerance=5e-2
    ).to_dict(),
}


def test_every_other_field_of_a_prediction_is_in_its_table_and_no_other():
    names = {field.name for field in fields(Prediction)} | {"counterbody"}
    assert set(section("A real contact")) == names - {"values", "input_values"}


@pytest.mark.parametrize("title", RECORDS)
def test_every_field_of_a_record_is_in_its_table_and_no_other(title):
    assert set(section(title)) == set(RECORDS[title]())


def test_every_name_of_a_fit_is_in_its_table_and_no_other():
    speed, map_ = np.array([0.1, 0.3, 1.0, 3.0]), eq6_map(1e-3)
    friction = map_.microslip.at(speed, np.full(4, 1.0)).mu_macro.values.diagonal()
    rows = {"speed": 2e-4 * np.pi * speed, "amplitude": np.full(4, 1e-7), "friction": friction}
    result = microslip.fit("transverse", rows, load=1.0, frequency=1e3, map=map_)
    assert set(section("A fit")) == {*result.to_dict(), "curve"}


def test_every_column_and_attribute_of_a_response_is_in_its_table_and_no_other():
    plain = microslip.response([0.0, 0.1], tolerance=0.1)
    path = {"forward": ["0 um", "0.1 um"]}
    contact = {"mu": 0.3, "load": "10 N", "radius": "5 mm", "material": "steel"}
    real = microslip.predict_response(path, tolerance=0.1, **contact)
    names = {*UNITS, *plain.columns, *real.columns, *plain.attributes, *real.attributes}
    assert set(section("A response along a path (CSV or netCDF)")) == names


def test_every_name_of_a_point_is_in_its_table_and_no_other():
    drives = ({"force": 0.5, "mass": 0.1}, {"stiffness": 1.0, "damping": 0.1})
    points = [
        microslip.solve("transverse", None if "force" in one else 0.5, 0.5, tolerance=1e-2, **one)
        for one in drives
    ]
    points.append(microslip.solve("continuous-bore", 1.0, model="polar", tolerance=1e-2))
    assert set(section("One point")) == set().union(*(one.to_dict() for one in points))


def all_names(data):
    """Names of the variables and coordinates in all groups of a DataTree."""
    return {str(name) for node in data.subtree for name in node.to_dataset().variables}


def written(name):
    configuration = load.from_mapping({"sweeps": GRIDS, "figures": RUNS})
    requests = [*request.points_of(configuration.sweeps[name]).requests]
    requests += request.runs_of(configuration, name)
    records = [batch.computed(one)[0] for one in requests]
    root, groups = sweep_dataset.build(configuration, name, records)
    return {str(key) for part in (root, *groups.values()) for key in part.variables}


@pytest.mark.slow
def test_every_variable_of_a_sweep_is_in_the_tables_and_no_other(monkeypatch):
    """The page shows the tables. Variables of certified maps and studies are made from tables."""
    Solver(monkeypatch)
    names = set().union(*map(written, GRIDS))
    fine = {name for name in names if name.removesuffix("_curve") in names and "_curve" in name}
    groups = {row["group"] for row in TABLE.values()} - {"force", "certified"}
    forms = {name for motion in MOTIONS for name in FORMS[motion]}
    known = {*rows_of(*groups), *forms, "velocity", "amplitude"}
    assert names - fine == known - {"velocity_curve", "amplitude_curve"}
    assert PAGE.count("variables.csv\n:header-rows") == 2 and "catalogue.csv\n" in PAGE
