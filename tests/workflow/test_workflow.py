"""The workflow, run by Snakemake in a copy of the project: jobs that run, and jobs that do not."""

import shutil

import pytest
import xarray as xr
from stubs.workflow_project import ALL_JOBS, COMPILED, ROOT, jobs_in

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
    assert len(finished.records()) == 10 + 5
    assert "bore: 4 points, all converged" in finished.said


def test_an_edit_makes_again_what_it_concerns_and_messages_and_dates_do_not_count(project):
    """The edits accumulate, and each one concerns more jobs than the one before. Without them there
    is nothing to do."""
    for path in (project.folder / "src").rglob("*.py"):
        path.touch()
    (project.folder / "tiny.yaml").touch()
    project.append("src/microslip/contact/influence.py", "\n# More to read.\n")
    checks = project.folder / "src/microslip/answer/limits.py"
    assert checks.read_text().count('"allowed is ') > 2
    checks.write_text(checks.read_text().replace('"allowed is ', '"what is allowed is '))
    project.append("src/microslip/report/figures/maps.py", "\nSPARE = 1\n")
    figure = "fig2_transverse_map"
    assert project.planned(figure) == {"draw_figure": 1, figure: 1}
    assert project.planned("bore") == {}
    project.append("src/microslip/datasets/sweep_dataset.py", "\nSPARE = 1\n")
    assert project.planned() == {"make_products": 1, "all": 1}
    project.append("src/microslip/contact/influence.py", "\nSPARE = 1\n")
    assert project.planned() == ALL_JOBS
    shutil.rmtree(project.folder / "src")
    shutil.copytree(ROOT / "src", project.folder / "src", ignore=COMPILED)
    assert project.planned() == {}
