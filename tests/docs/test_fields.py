"""The tables of the documentation list every field of a result and every variable of a dataset."""

from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from stubs.eq6_map import eq6_map

import microslip
from microslip.scene.files import UNITS
from microslip.si.output import Prediction

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "fields.md").read_text(encoding="utf-8")


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


def of_a_fit():
    speed, map_ = np.array([0.1, 0.3, 1.0, 3.0]), eq6_map(1e-3)
    friction = map_.microslip.at(speed, np.full(4, 1.0)).mu_macro.values.diagonal()
    rows = {"speed": 2e-4 * np.pi * speed, "amplitude": np.full(4, 1e-7), "friction": friction}
    return {
        *microslip.fit("transverse", rows, load=1.0, frequency=1e3, map=map_).to_dict(),
        "curve",
    }


def of_a_response():
    plain = microslip.response([0.0, 0.1], tolerance=0.1)
    contact = {"mu": 0.3, "load": "10 N", "radius": "5 mm", "material": "steel"}
    path = {"forward": ["0 um", "0.1 um"]}
    real = microslip.predict_response(path, tolerance=0.1, **contact)
    return {*UNITS, *plain.columns, *real.columns, *plain.attributes, *real.attributes}


def of_a_contact():
    hidden = {"values", "input_values"}
    return {field.name for field in fields(Prediction)} - hidden | {"counterbody"}


def of_points():
    points = (
        microslip.solve("transverse", None, 0.5, force=0.5, mass=0.1, tolerance=1e-2),
        microslip.solve("transverse", 0.5, 0.5, stiffness=1.0, damping=0.1, tolerance=1e-2),
        microslip.solve("continuous-bore", 1.0, model="polar", tolerance=1e-2),
    )
    return set().union(*(one.to_dict() for one in points))


SMALL, EIGHT = {"cells": 4, "steps": 8}, "elliptic:forward_cycles=2,phase=0"
NAMES = {
    "One point": of_points,
    "A real contact": of_a_contact,
    "A force history": lambda: microslip.history("transverse", 0.5, 0.5, **SMALL).values,
    "A period of the periodic state": lambda: microslip.period(
        "transverse", 0.5, 0.5, angles=4, **SMALL
    ).to_dict(),
    "Shakedown": lambda: microslip.shakedown("transverse", 0.5, 0.2, tolerance=0.1).to_dict(),
    "A self-propelled motion": lambda: microslip.propulsion(EIGHT, 0.3, tolerance=5e-2).to_dict(),
    "A fit": of_a_fit,
    "A response along a path (CSV or netCDF)": of_a_response,
}


@pytest.mark.parametrize("title", NAMES)
def test_every_name_of_a_result_is_in_its_table_and_no_other(title):
    assert set(section(title)) == set(NAMES[title]())


def test_the_page_contains_the_tables_that_datasets_are_made_from():
    assert PAGE.count("variables.csv\n:header-rows") == 2 and "catalogue.csv\n" in PAGE
