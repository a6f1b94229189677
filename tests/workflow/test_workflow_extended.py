"""Sweeps of other motions, run by Snakemake in a copy of the project."""

import pytest
import xarray as xr
import yaml
from stubs.workflow_project import RUN, Project

pytestmark = pytest.mark.slow

# Closed forms and the rigid model: points that cost nothing.
AXES = {"velocity": [0.1, 1], "amplitude": [0, 0.5, 1], "tolerance": 0.01}
MOTIONS = {**AXES, "group": "motions", "model": "rigid"}
STATIC = {**AXES, "group": "static", "scene": "longitudinal", "velocity": [0, 0.1]}
TINY = {
    "sweeps": {"transverse": {"velocity": [1], "amplitude": [0]}},
    "extended": {
        "circle": {**MOTIONS, "scene": "elliptic:phase=90", "title": "a circle"},
        "line_first": {**MOTIONS, "scene": "elliptic:forward=0.5,phase=0"},
        "cone": {**STATIC, "pressure": "power:exponent=1"},
    },
    "points_per_job": 4,
}


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project after a run. To be left as it is, but for its configuration."""
    project = Project(tmp_path_factory.mktemp("extended"))
    project.configure(TINY)
    planned = project.planned("extended")
    assert planned == {
        "warm_up": 1,
        "solve_batch": 6,
        "collect": 3,
        "draw_figure": 2,
        "extended": 1,
    }
    project.said = project.run("extended")
    return project


def test_one_command_makes_the_datasets_and_a_figure_of_each_group(finished):
    results = finished.folder / "results"
    assert {path.stem for path in results.glob("*.nc")} == {"circle", "line_first", "cone"}
    for name in ("extended_motions", "extended_static"):
        for form in ("png", "pdf"):
            assert (results / f"figures/{name}.{form}").stat().st_size > 0
    with xr.open_dataset(results / "circle.nc") as data:
        assert (data.scene, data.title, data.group) == ("elliptic", "a circle", "motions")
        assert data.mu_macro.dims == ("amplitude", "velocity")
    with xr.open_dataset(results / "cone.nc") as data:
        assert data.pressure == "power:exponent=1"
        assert data.converged.all()
    assert "cone: 6 points, none not converged" in finished.said
    assert len(finished.points()) == 18


def test_a_second_run_has_nothing_to_do_and_a_plain_one_makes_none_of_it(finished):
    assert "Nothing to be done" in finished.run("extended")
    planned = finished.planned()
    assert (planned["collect"], planned["all"]) == (1, 1)


def test_another_way_to_write_a_motion_computes_nothing(finished):
    circle = {**TINY["extended"]["circle"], "scene": "elliptic"}
    finished.configure({**TINY, "extended": {**TINY["extended"], "circle": circle}})
    planned = finished.planned("extended")
    finished.configure(TINY)
    assert planned == {"collect": 1, "draw_figure": 1, "extended": 1}


def test_a_motion_with_a_new_amplitude_computes_its_points_only(finished):
    line = {**TINY["extended"]["line_first"], "amplitude": [0, 0.5, 1, 2]}
    finished.configure({**TINY, "extended": {**TINY["extended"], "line_first": line}})
    planned = finished.planned("extended")
    finished.configure(TINY)
    assert planned == {"solve_batch": 1, "collect": 1, "draw_figure": 1, "extended": 1}


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"scene": "eliptic"}, "extended.circle.scene: 'eliptic': did you mean elliptic? "),
        ({"pressure": "powr"}, "extended.circle.pressure: 'powr': did you mean power? "),
        ({"velocity": [-1, 1]}, "extended.circle.velocity[0]: -1 is not allowed"),
    ],
)
def test_a_mistake_stops_before_the_first_job(finished, change, line):
    circle = {**TINY["extended"]["circle"], **change}
    (finished.folder / "wrong.yaml").write_text(
        yaml.safe_dump({**TINY, "extended": {"circle": circle}})
    )
    done = finished.snakemake("--dry-run", RUN[0], "--configfile", "wrong.yaml")
    assert done.returncode != 0
    message = done.stderr.strip().split("\n")[-1]
    assert message.startswith(f"Error in wrong.yaml: {line}")
    assert "Traceback" not in done.stderr
