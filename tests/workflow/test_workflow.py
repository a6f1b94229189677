"""The workflow, run by Snakemake in a copy of the project: what is computed, and what is not."""

import os
import re
from pathlib import Path

import pytest
import xarray as xr
from stubs.workflow_project import ALL_JOBS, AXES, RUN, TINY, Project

pytestmark = pytest.mark.slow


def test_one_run_makes_the_datasets_and_the_figures(finished):
    results = finished.folder / "results"
    assert {p.name for p in results.glob("*.nc")} == {
        "transverse.nc",
        "bore.nc",
        "continuous_bore.nc",
    }
    assert len(list(results.glob("figures/fig*.png"))) == 6
    assert len(list(results.glob("figures/fig*.pdf"))) == 6
    with xr.open_dataset(results / "transverse.nc") as data:
        assert data.converged.all()
        assert (data.mu_macro.sel(amplitude=0) == 1).all()
    with xr.open_dataset(results / "transverse.nc", group="history") as data:
        assert data.history_force_forward.size == 17
    assert len(finished.points()) == 10
    assert "bore: 4 points, none not converged" in finished.said


def test_a_second_run_has_nothing_to_do_and_says_so(finished):
    assert "Nothing to be done" in finished.run()


def test_a_new_amplitude_computes_its_points_only(project):
    before = project.points()
    axes = {**AXES, "amplitude": [0, 0.5, 1]}
    project.configure({**TINY, "sweeps": {**TINY["sweeps"], "transverse": axes}})
    planned = project.planned()
    assert planned == {"solve_batch": 2, "collect": 1, "draw_figure": 2, "all": 1}
    project.run("results/transverse.nc")
    after = project.points()
    assert len(after) == len(before) + 2
    assert {name: after[name] for name in before} == before
    logs = project.folder.glob("results/logs/solve_batch/transverse/*.log")
    computed = [int(n) for log in logs for n in re.findall(r"(\d+) computed", log.read_text())]
    assert sum(computed) == 4 + 2
    with xr.open_dataset(project.folder / "results" / "transverse.nc") as data:
        assert list(data.amplitude.values) == [0, 0.5, 1]


def test_editing_a_plotting_module_draws_its_figures_again(project):
    project.append("src/microslip/report/figures/field.py", "\nSPARE = 1\n")
    assert project.planned() == {"draw_figure": 1, "all": 1}
    project.append("src/microslip/report/figures/style.py", "\nSPARE = 1\n")
    assert project.planned() == {"draw_figure": 6, "all": 1}


def test_editing_the_datasets_collects_again(project):
    project.append("src/microslip/datasets/sweep_dataset.py", "\nSPARE = 1\n")
    assert project.planned() == {"collect": 3, "draw_figure": 6, "all": 1}


def test_editing_the_solver_computes_everything_again_but_a_comment_does_not(project):
    project.append("src/microslip/models/rings/influence.py", "\n# More to read.\n")
    assert project.planned() == {}
    project.append("src/microslip/models/rings/influence.py", "\nSPARE = 1\n")
    assert project.planned() == ALL_JOBS


def test_touching_files_changes_nothing(project):
    for path in (project.folder / "src").rglob("*.py"):
        path.touch()
    (project.folder / "tiny.yaml").touch()
    assert project.planned() == {}


def test_a_damaged_point_is_computed_again_where_it_is_needed(project):
    before = project.points()
    dataset = project.folder / "results" / "transverse.nc"
    expected = dataset.read_bytes()
    for path in project.folder.glob("results/points/transverse/*/*.json"):
        path.write_bytes(path.read_bytes()[:-9])
    dataset.unlink()
    assert "damaged result" not in project.run("results/transverse.nc")  # its batches are whole
    assert dataset.read_bytes() == expected
    for path in project.folder.glob("results/batches/transverse/*.json"):
        path.unlink()
    dataset.unlink()
    said = project.run("results/transverse.nc")
    assert len({line for line in said.splitlines() if "damaged result" in line}) == 4
    assert project.points() == before
    assert dataset.read_bytes() == expected


def test_what_a_killed_run_left_half_written_is_cleared_later(project):
    half = project.folder / "results" / ".bore.nc.99999999.part"
    half.write_text("half")
    os.utime(half, (0, 0))
    (project.folder / "results" / "bore.nc").unlink()
    assert "results/.bore.nc.99999999.part was left by a run that was killed" in project.run()
    assert not half.exists()


def test_a_job_that_fails_does_not_hide_what_the_others_say(project):
    (project.folder / "results" / "bore.nc").unlink()
    project.append("src/microslip/report/figures/maps.py", "\nraise ValueError('no maps today')\n")
    done = project.snakemake(*RUN)
    assert done.returncode != 0
    assert "no maps today" in done.stderr
    assert "bore: 4 points, none not converged" in done.stderr
    assert "transverse: 4 points" not in done.stderr
    assert "IndexError" not in done.stderr


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no folder that root cannot write to")
def test_results_that_cannot_be_written_stop_the_run_before_the_first_job(project):
    project.configure({**TINY, "results": "/proc/results"})
    done = project.snakemake(*RUN)
    assert done.returncode != 0
    message = done.stderr.strip().split("\n")[-1]
    assert re.search(r"results: cannot write to /proc/results: .*make room or set perm", message)
    assert "Traceback" not in done.stderr


STALLING = """

from dataclasses import replace
_solve = solve

def solve(scene, velocity, amplitude=None, **settings):
    result = _solve(scene, velocity, amplitude, **settings)
    return replace(result, mu_macro=math.nan, converged=False, reason="stalled")
"""


def test_a_sweep_too_small_for_a_map_has_no_map(project):
    axes = {**AXES, "amplitude": [1]}
    project.configure({**TINY, "sweeps": {"transverse": axes}})
    assert project.planned()["draw_figure"] == 1


def test_points_that_do_not_converge_are_listed_and_drawn_with_a_job_a_point(project):
    project.append("src/microslip/adaptive/point.py", STALLING)
    axes = {**AXES, "amplitude": [1, 2]}
    project.configure({**TINY, "sweeps": {"transverse": axes}, "points_per_job": 1})
    assert project.planned()["solve_batch"] == 5
    said = project.run()
    assert "transverse: 4 points, 4 not converged" in said
    assert "not converged: amplitude 1, velocity 0.5: stalled" in said


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"velocities": [1]}, "sweeps.transverse.velocities: unknown key; did you mean velocity?"),
        ({"amplitude": [0, -1]}, "sweeps.transverse.amplitude[1]: -1 is not allowed"),
        ({"velocity": ["1e-8"]}, "sweeps.transverse.velocity[0]"),
    ],
)
def test_a_bad_configuration_stops_before_the_first_job(change, part, tmp_path):
    project = Project(tmp_path / "new")
    project.configure({**TINY, "sweeps": {"transverse": {**AXES, **change}}})
    done = project.snakemake(*RUN)
    assert done.returncode != 0
    message = done.stderr.strip().split("\n")[-1]
    assert message.startswith("Error in tiny.yaml: ")
    assert part in message
    assert "Traceback" not in done.stderr
    assert not (project.folder / "results").exists()


def test_a_number_on_the_command_line_is_checked_too(finished):
    done = finished.snakemake(*RUN, "--config", "points_per_job=none")
    assert done.returncode != 0
    assert 'points_per_job: "none" is text' in done.stderr


def test_the_workflow_passes_snakemakes_own_checks(finished):
    done = finished.snakemake("--lint")
    assert done.returncode == 0, done.stderr
    assert "good condition" in done.stdout + done.stderr
