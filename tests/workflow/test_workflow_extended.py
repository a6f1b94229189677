"""Sweeps of other motions, run by Snakemake in a copy of the project."""

import pytest
import xarray as xr
from stubs.workflow_project import Project, jobs_in

from microslip.app.plan import Plan
from microslip.config import load

pytestmark = pytest.mark.slow

# Closed forms and the rigid model: points that cost nothing.
AXES = {"velocity": [0.1, 1], "amplitude": [0, 0.5, 1], "tolerance": 0.01}
MOTIONS = {**AXES, "group": "motions", "model": "rigid"}
STATIC = {**AXES, "group": "static", "motion": "longitudinal", "velocity": [0, 0.1]}
TINY = {
    "sweeps": {"transverse": {"velocity": [1], "amplitude": [0]}},
    "extended": {
        "circle": {**MOTIONS, "motion": "elliptic:phase=90", "title": "a circle"},
        "line_first": {**MOTIONS, "motion": "elliptic:forward=0.5,phase=0"},
        "cone": {**STATIC, "pressure": "power:exponent=1"},
    },
    "points_per_job": 6,
}


RUN = {**TINY, "extended": {name: TINY["extended"][name] for name in ("circle", "cone")}}
"""A sweep in each group."""


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project after a run. To be left as it is, but for its configuration."""
    project = Project(tmp_path_factory.mktemp("extended"))
    project.configure(RUN)
    project.said = project.run("extended")
    assert jobs_in(project.said) == {
        "warm_up": 1,
        "warm_up_angles": 1,
        "solve_batch": 2,
        "collect": 2,
        "draw_figure": 2,
        "extended": 1,
    }
    return project


@pytest.mark.long
def test_one_command_makes_the_datasets_and_a_figure_of_each_group(finished):
    results = finished.folder / "results"
    assert {path.stem for path in results.glob("*.nc")} == {"circle", "cone"}
    for name in ("extended_motions", "extended_static"):
        for form in ("png", "pdf"):
            assert (results / f"figures/{name}.{form}").stat().st_size > 0
    with xr.open_dataset(results / "circle.nc") as data:
        assert (data.motion, data.title, data.group) == ("elliptic", "a circle", "motions")
        assert data.mu_macro.dims == ("amplitude", "velocity")
    with xr.open_dataset(results / "cone.nc") as data:
        assert data.pressure == "power:exponent=1"
        assert data.converged.all()
    assert "cone: 6 points, all converged" in finished.said
    assert len(finished.points()) == 12


@pytest.mark.long
def test_a_second_run_has_nothing_to_do_and_a_plain_one_makes_none_of_it(finished):
    assert "Nothing to be done" in finished.run("extended")
    planned = finished.planned()
    assert (planned["collect"], planned["all"]) == (1, 1)


def planned(**changed):
    """What a configuration with some sweeps changed leads to, without Snakemake."""
    sweeps = {name: {**TINY["extended"][name], **given} for name, given in changed.items()}
    return Plan(load.from_mapping({**TINY, "extended": {**TINY["extended"], **sweeps}}))


def test_another_way_to_write_a_motion_computes_nothing():
    before, after = planned(), planned(circle={"motion": "elliptic"})
    assert after.batch_files(*after.groups) == before.batch_files(*before.groups)
    # a dataset says how its motion was written
    assert after.fingerprint_of("circle.nc") != before.fingerprint_of("circle.nc")


def test_a_motion_with_a_new_amplitude_computes_its_points_only():
    before, after = planned(), planned(line_first={"amplitude": [0, 0.5, 1, 2]})
    new = {*after.batch_files(*after.groups)} - {*before.batch_files(*before.groups)}
    assert [name.split("/")[1] for name in new] == ["line_first"]
    made = ("circle.nc", "line_first.nc", "cone.nc", "figures/extended_motions.png")
    made += ("figures/extended_static.png",)
    changed = [f for f in made if after.fingerprint_of(f) != before.fingerprint_of(f)]
    assert changed == ["line_first.nc", "figures/extended_motions.png"]
