"""The workflow, run by Snakemake in a copy of the project: jobs that run, and jobs that do not."""

import shutil

import pytest
import xarray as xr
from stubs.workflow_project import ALL_JOBS, AXES, COMPILED, ROOT, RUN, TINY, jobs_in

pytestmark = pytest.mark.slow


def test_one_run_makes_the_datasets_and_the_figures(finished):
    assert jobs_in(finished.said) == ALL_JOBS
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
    assert "bore: 4 points, all converged" in finished.said


def test_a_new_amplitude_computes_its_points_only(project):
    before = project.points()
    axes = {**AXES, "amplitude": [0, 0.5, 1]}
    project.configure({**TINY, "sweeps": {**TINY["sweeps"], "transverse": axes}})
    assert project.planned() == {"solve": 2, "collect": 1, "draw": 2, "all": 1}
    project.run("results/transverse.nc")
    after = project.points()
    assert len(after) == len(before) + 2
    assert {name: after[name] for name in before} == before
    with xr.open_dataset(project.folder / "results" / "transverse.nc") as data:
        assert list(data.amplitude.values) == [0, 0.5, 1]


def test_an_edit_makes_again_what_it_concerns_and_comments_and_dates_do_not_count(project):
    """The edits accumulate, and each one concerns more jobs than the one before. Without them there
    is nothing to do."""
    for path in (project.folder / "src").rglob("*.py"):
        path.touch()
    (project.folder / "tiny.yaml").touch()
    project.append("src/microslip/contact/influence.py", "\n# More to read.\n")
    project.append("src/microslip/report/figures/field.py", "\nSPARE = 1\n")
    assert project.planned() == {"draw": 1, "all": 1}
    project.append("src/microslip/datasets/sweep_dataset.py", "\nSPARE = 1\n")
    assert project.planned() == {"collect": 3, "draw": 6, "all": 1}
    project.append("src/microslip/contact/influence.py", "\nSPARE = 1\n")
    assert project.planned() == ALL_JOBS
    shutil.rmtree(project.folder / "src")
    shutil.copytree(ROOT / "src", project.folder / "src", ignore=COMPILED)
    assert project.planned() == {}


@pytest.mark.long
def test_a_dry_run_says_how_much_there_is_to_solve(project):
    tolerance = {**AXES, "tolerance": 2e-2}
    project.configure({**TINY, "sweeps": {"transverse": tolerance, "bore": AXES}})
    process = project.snakemake("--cores", 2, *RUN[1:], "--dry-run")
    assert process.returncode == 0
    (line,) = [line for line in process.stderr.splitlines() if line.startswith("To solve:")]
    assert line == "To solve: 4 points."


@pytest.mark.long
@pytest.mark.parametrize("target", ["fig2", "fig2_transverse_map"])
def test_a_figure_is_a_target_by_its_number_and_by_its_name(project, target):
    for path in (project.folder / "results").glob("figures/fig*.png"):
        path.unlink()
    assert project.planned(target) == {"draw": 1, target: 1}
    project.configure({**TINY, "sweeps": {"bore": AXES}})
    process = project.snakemake(target, *RUN, "--dry-run")
    line = process.stderr.strip().splitlines()[-1]
    assert process.returncode == 1
    assert line == (
        "Error in tiny.yaml: fig2_transverse_map needs the sweep transverse, "
        "which the configuration does not have"
    )
