"""Certified maps, other motions and the studies, run by Snakemake in a copy of the project."""

import re

import pytest
import xarray as xr
from stubs import studies_stub
from stubs.figures_stub import words
from stubs.workflow_project import Project

import microslip
from microslip.datasets import netcdf
from microslip.report.figures import drawing

pytestmark = pytest.mark.long


def made(folder, configuration, *targets):
    """A project with a configuration, after a run of some targets; `said` is the output."""
    project = Project(folder)
    project.configure(configuration)
    project.said = project.run(*targets)
    return project


# Certified maps of the rigid model, whose points are cheap.

AXES = {"velocity": [0.1, 10], "amplitude": [0.5, 3], "model": "rigid", "tolerance": 0.01}
MAP = {"motion": "transverse", **AXES, "error": 0.03}


def test_one_command_makes_a_map_whose_error_holds_everywhere(tmp_path):
    figures = {"look": {"kind": "map", "sweep": "transverse"}}
    certified = made(tmp_path, {"sweeps": {"transverse": MAP}, "figures": figures})
    results = certified.folder / "results"
    data = microslip.open_map("transverse", results).load()
    assert float(data.cell_error.max()) <= data.error == 0.03
    assert data.points == len(certified.records()) > 25
    assert (results / "figures/look.png").read_bytes().startswith(b"\x89PNG")
    page = (results / "summaries/transverse.html").read_text()
    assert f"{data.points} points, all converged" in page
    answer = data.microslip.at(velocity=0.7, amplitude=1.9)
    rigid = microslip.solve("transverse", 0.7, 1.9, model="rigid", tolerance=0.01)
    assert abs(float(answer.mu_macro) - rigid.mu_macro) <= float(answer.mu_macro_error)
    assert re.search(r"point/s", certified.said)  # progress
    assert "Nothing to be done" in certified.run()


# Other motions


def test_other_motions_have_datasets_and_figures_of_several(tmp_path):
    axes = {"velocity": [0.1, 1], "amplitude": [0, 0.5, 1], "tolerance": 0.01}
    circle = {**axes, "model": "rigid", "motion": "elliptic", "title": "round"}
    cone = {**axes, "motion": "longitudinal", "pressure": "power:exponent=1"}
    sweeps = {"circle": circle, "cone": cone | {"velocity": [0, 0.1]}}
    sweeps["pulled"] = {"motion": "bore", "amplitude": 1, "force": [0.2, 0.5], "tolerance": 0.1}
    figures = {
        "motions": {"kind": "map", "sweep": ["circle"]},
        "static": {"kind": "curves", "sweep": ["cone"]},
    }
    project = made(tmp_path, {"sweeps": sweeps, "figures": figures})
    results = project.folder / "results"
    assert {path.stem for path in results.glob("*.nc")} == {"circle", "cone", "pulled"}
    for name in ("motions", "static"):
        for form in ("png", "pdf"):
            assert (results / f"figures/{name}.{form}").stat().st_size > 0
    with xr.open_dataset(results / "circle.nc") as data:
        assert (data.motion, data.title) == ("elliptic", "round")
        assert data.mu_macro.dims == ("amplitude", "velocity")
    with xr.open_dataset(results / "cone.nc") as data:
        assert data.pressure == "power:exponent=1"
        assert data.converged.all()
    with xr.open_dataset(results / "pulled.nc") as data:
        assert data.velocity.dims == ("force",)
        assert float(data.amplitude) == 1
    assert len(project.records()) == 14
    assert "Nothing to be done" in project.run()


# Studies

CLAIMS = {"tolerance": 0.01, "velocity": [0.1], "cells": 8}
CLAIMS |= {"amplitude_transverse": [1], "amplitude_bore": [1]}
SMALLER = {
    "studies/evidence.py": {"PAPER_SQUARES, PAPER_STEPS = 32, 100": "= 16, 20"},
    "periodic/methods/paper.py": {
        "STEPS_PER_PERIOD = 32, 100": "= 16, 20",
        "STEPS = 8000": "= 400",
    },
}
"""Replacements of constants in modules, which shorten the runs of the paper from 10 s to 1 s."""


def test_the_claims_are_a_dataset_a_page_and_figures(tmp_path):
    project = Project(tmp_path)
    figures = {name: {"kind": name} for name in ("claims_static", "claims_patches")}
    project.configure({"claims": CLAIMS, "figures": figures})
    for name, lines in SMALLER.items():
        path = project.folder / "src" / "microslip" / name
        text = path.read_text()
        for line, numbers in lines.items():
            assert text.count(line) == 1
            text = text.replace(line, line.partition("=")[0] + numbers)
        path.write_text(text)
    message = project.run("claims_static")
    results = project.folder / "results"
    with netcdf.whole(results / "claims.nc") as data:
        assert data["claim"].values.tolist() == list(range(1, 11))
        assert {3, 4} <= set(data["claim"].values[data["verdict"].values == 1])
        assert set(data["run"].values) <= project.records().keys()
        page = (results / "summaries/claims.html").read_text(encoding="utf-8")
        assert all(str(key) in page for key in data["run"].values)
    assert "claim 9: " in message
    figure = {"draw_figure": 1, "claims_patches": 1}
    assert project.planned("claims_patches") == figure


METHODS = {
    "figures": {name: {"kind": name} for name in ("accuracy_profile", "stability_atlas")},
    "accuracy": {
        "methods": ["shipped", "my-method"],
        "points": {"fast": {"motion": "longitudinal", "velocity": 0.5, "amplitude": 1}},
        "levels": 2,
        "repeats": 1,
        "map": studies_stub.ACCURACY["map"] | {"velocity": [1, 3], "tolerance": [0.01]},
    },
    "stability": {
        "methods": ["shipped", "my-method"],
        "axes": {"critical": studies_stub.FIXED | {"amplitude": [0.9, 1, 1.1]}},
        "tolerance": 0.01,
    },
}
METHOD = '''
"""Backward Euler under another name."""

from microslip.periodic.method import Method
from microslip.contact.path import EULER

METHOD = Method("my own way", integrator=EULER)
'''


def texts(name, path):
    """All texts of a figure drawn from the dataset at `path`."""
    with netcdf.whole(path) as data:
        return words(drawing.draw(name, {"study": data}))


def test_a_method_in_one_new_file_is_in_the_datasets_and_in_the_figures(tmp_path):
    studies = Project(tmp_path)
    studies.configure(METHODS)
    (tmp_path / "src/microslip/periodic/methods/my_method.py").write_text(METHOD)
    said = studies.run()
    results = studies.folder / "results"
    with netcdf.whole(results / "accuracy.nc") as data:
        own = data.isel(trial=data.trial_method.values == "my-method")
        assert own.trial_model.values.tolist() == ["radial", "radial"]
        assert own.converged.values.all()
        assert (own.seconds.values > 0).all()
        assert set(data.trial_model.values) >= {"rigid", "radial", "cartesian", "auto"}
    with netcdf.whole(results / "stability.nc") as data:
        assert data.method.values.tolist() == ["shipped", "my-method"]
        assert data.method_summary.values[1] == "my own way"
        assert (data.outcome.values > 0).all()
    assert "my-method" in texts("accuracy_profile", results / "accuracy.nc")
    assert "my-method" in texts("stability_atlas", results / "stability.nc")
    assert "fast: " in said and "my-method: " in said
    assert "Nothing to be done" in studies.run()
