"""The claims, run by Snakemake in a copy of the project."""

import pytest
from stubs.workflow_project import Project

from microslip.app.plan import Plan
from microslip.config import load
from microslip.datasets import netcdf
from microslip.foundation import files

pytestmark = pytest.mark.long

TINY = {
    "sweeps": {"transverse": {"velocity": [1], "amplitude": [0]}},
    "claims": {
        "tolerance": 0.01,
        "velocity": [0.1],
        "amplitude_transverse": [1],
        "amplitude_bore": [1],
        "cells": 8,
    },
}


TARGET = "results/figures/claims_static.png"
"""A figure, and what it takes: the other one is drawn by the same rule."""
SMALLER = {
    "studies/claims/claims.py": {"PAPER_SQUARES, PAPER_STEPS = 32, 100": "= 16, 20"},
    "solver/methods/paper.py": {"STEPS_PER_PERIOD = 32, 100": "= 16, 20", "STEPS = 8000": "= 400"},
}
"""Numbers in modules, and others for them: the paper's own runs take a second in place of ten.
Whatever is asked for, its method runs with those of its module."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project after a run, and what that said. To be left as it is."""
    project = Project(tmp_path_factory.mktemp("claims"))
    project.configure(TINY)
    for name, lines in SMALLER.items():
        path = project.folder / "src" / "microslip" / name
        text = path.read_text()
        for line, numbers in lines.items():
            assert text.count(line) == 1
            text = text.replace(line, line.partition("=")[0] + numbers)
        path.write_text(text)
    project.said = project.run(TARGET)
    return project


def test_one_command_makes_the_dataset_the_page_and_a_figure(finished):
    results = finished.folder / "results"
    with netcdf.whole(results / "claims.nc") as data:
        assert data["claim"].values.tolist() == list(range(1, 10))
        assert {3, 4} <= set(data["claim"].values[data["verdict"].values == 1])
        stored = {path.stem for path in results.rglob("*/*/??/*.json")}
        assert set(data["run"].values) <= stored
        page = (results / "summaries/claims.html").read_text(encoding="utf-8")
        for key in data["run"].values:
            assert str(key) in page
    assert files.seal_of(results / "summaries/claims.html").exists()
    for form in ("png", "pdf"):
        assert (results / f"figures/claims_static.{form}").stat().st_size > 0
    assert "claim 9: " in finished.said


def test_a_second_run_has_nothing_to_do_and_a_plain_one_does_not_need_it(finished):
    assert "Nothing to be done" in finished.run(TARGET)
    assert finished.planned("claims") == {"draw_figure": 1, "claims": 1}  # the other one
    assert "collect_study" not in finished.planned()


def test_another_amplitude_computes_its_own_runs_only(finished, tmp_path):
    more = {**TINY, "claims": {**TINY["claims"], "amplitude_bore": [1, 10]}}
    before, after = (Plan(load.from_mapping(given)) for given in (TINY, more))
    groups = before.groups_of("claims")
    new = {*after.batch_files(*groups)} - {*before.batch_files(*groups)}
    assert len([name for name in new if name.startswith("batches/claims_first/")]) == 1
    project = finished.copied(tmp_path / "copy")
    project.configure(more)
    planned = project.planned(TARGET)
    batches = [count for rule, count in planned.items() if rule.startswith("solve_")]
    assert sum(batches) == len(new)
