"""Datasets and figures match the configuration and the code after any sequence of runs."""

import os
import random
import shutil
import signal
import time

import pytest
import xarray as xr
from stubs.workflow_project import RUN, Project, is_alive, jobs_in, wait_until

pytestmark = pytest.mark.long

SLIDE = {
    **{"motion": "transverse", "velocity": [0.5, 1, 2], "amplitude": [0.5, 1, 2]},
    **{"model": "rigid", "tolerance": 1e-2},
}
DATASET, FIGURE = "results/slide.nc", "results/figures/look.png"
COUNTING = """

import time
from pathlib import Path
_solve, _folder = solve, Path(__file__).parents[3]

def solve(**arguments):
    with open(_folder / "solved", "a") as file:
        file.write(f"{arguments}\\n" if "cells" in arguments else "")  # not to compile
    time.sleep(0.3 * (_folder / "slow").exists())
    while (_folder / "hold").exists():
        time.sleep(0.05)
    return _solve(**arguments)
"""


def configured(**changed):
    figures = {"look": {"kind": "map", "sweep": "slide"}}
    return {"sweeps": {"slide": SLIDE | changed}, "figures": figures, "points_per_job": 3}


class Counted(Project):
    """A project whose solver counts its calls."""

    def solved(self):
        """Calls of the solver so far, one per line."""
        path = self.folder / "solved"
        return path.read_text().splitlines() if path.exists() else []

    def values(self, name):
        with xr.open_dataset(self.folder / DATASET) as data:
            return data[name].values.tolist()


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A project after its first run. Tests must not change it."""
    project = Counted(tmp_path_factory.mktemp("scenarios") / "it")
    project.append("src/microslip/answer/point.py", COUNTING)
    project.configure(configured())
    jobs = {"solve_batch": 3, "make_dataset": 1, "draw_figure": 1, "link_file": 2}
    assert jobs_in(project.run(DATASET, FIGURE)) == jobs
    assert len(project.solved()) == 9
    return project


@pytest.fixture
def project(finished, tmp_path):
    """A copy of the finished project for edits."""
    return finished.copied(tmp_path / "copy")


def test_again_there_is_nothing_to_do_whatever_the_triggers(finished):
    assert "Nothing to be done" in finished.run(DATASET, FIGURE)
    triggers = ["--rerun-triggers", "mtime", "params", "input", "software-env", "code"]
    assert finished.planned(DATASET, FIGURE, *triggers) == {}


@pytest.mark.parametrize(
    ("axis", "values", "batches", "new"),
    [
        ("velocity", [0.5, 1, 1.5, 2], 3, 3),
        ("amplitude", [0.5, 0.7, 1, 2], 1, 3),
        ("poisson", [0, 0.3], 3, 9),
    ],
)
def test_a_grown_axis_solves_its_new_points_alone(axis, values, batches, new, project):
    project.configure(configured(**{axis: values}))
    output = project.run(DATASET)
    assert jobs_in(output)["solve_batch"] >= batches
    assert f"New points and runs: {new}\n" in output
    assert len(project.solved()) == 9 + new
    assert project.values(axis) == values
    assert project.planned(DATASET) == {}
    project.configure(configured())
    assert project.planned(DATASET) == {}
    assert len(project.values("velocity")) == 3


@pytest.fixture
def emptied(project):
    """A project without results."""
    shutil.rmtree(project.folder / "results")
    (project.folder / "solved").unlink()
    return project


def batch_files(project):
    return list(project.folder.glob("results/batches/*/*.jsonl"))


def test_kills_of_all_processes_lose_the_points_in_flight_at_most(finished, emptied):
    """Each kill waits until a point is being solved."""
    (emptied.folder / "slow").touch()
    draw = random.Random(1)
    for _ in range(3):
        count = len(emptied.solved())
        running = emptied.started(DATASET, "--nolock")
        wait_until(lambda before=count: len(emptied.solved()) > before)
        time.sleep(draw.uniform(0.0, 0.3))
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()
    (emptied.folder / "slow").unlink()
    emptied.run(DATASET)
    solved = emptied.solved()
    assert len(set(solved)) == 9
    assert len(solved) <= 9 + 3 * 2
    assert (emptied.folder / DATASET).read_bytes() == (finished.folder / DATASET).read_bytes()
    assert emptied.planned(DATASET) == {}
    assert not list(emptied.folder.rglob("*.journal"))


PLAIN = ["--workflow-profile", "none", "--rerun-triggers", "mtime", "--rerun-incomplete"]


@pytest.mark.parametrize(
    ("moment", "options"),
    [("after its jobs", []), ("after its jobs", PLAIN), ("beside its jobs", [])],
    ids=["after", "after, without the profile", "beside"],
)
def test_one_run_makes_every_file_after_a_kill_of_snakemake_alone(
    moment, options, finished, emptied
):
    """The jobs of the killed process go on, and end before the next run begins or during it."""
    hold = emptied.folder / "hold"
    hold.touch()
    running = emptied.started(DATASET, FIGURE)
    try:
        wait_until(emptied.solved)
        running.kill()
        running.wait()
        assert is_alive(running.pid)  # the job that solves
        assert not batch_files(emptied)
        if moment == "after its jobs":
            hold.unlink()
            wait_until(lambda: not is_alive(running.pid))
            assert batch_files(emptied)
        assert emptied.snakemake("--unlock", *RUN).returncode == 0
        hold.unlink(missing_ok=True)
        emptied.run(DATASET, FIGURE, *options)
        wait_until(lambda: not is_alive(running.pid))
    finally:
        if is_alive(running.pid):
            os.killpg(running.pid, signal.SIGKILL)
    for file in (DATASET, FIGURE):
        assert (emptied.folder / file).read_bytes() == (finished.folder / file).read_bytes()
    assert emptied.planned(DATASET, FIGURE) == {}


def test_what_snakemake_remembers_does_not_count(project):
    """Another working directory has the same folder of results."""
    there = project.folder.parent / "there"
    shutil.copytree(project.folder, there, ignore=shutil.ignore_patterns(".snakemake", "results"))
    (there / "results").symlink_to(project.folder / "results")
    elsewhere = Counted.at(there)
    assert elsewhere.planned(DATASET, FIGURE) == {}
    elsewhere.configure(configured(velocity=[0.5, 1]))
    assert elsewhere.planned(DATASET)["make_dataset"] == 1


def test_dates_do_not_count(project):
    """Dates between 1970 and 2096, in any order."""
    draw = random.Random(1)
    for path in (project.folder / "results").rglob("*"):
        os.utime(path, (draw.uniform(1e3, 4e9),) * 2, follow_symlinks=False)
    assert project.planned(DATASET, FIGURE) == {}
    shutil.rmtree(project.folder / "results" / "data")
    assert "solve_batch" not in jobs_in(project.run(DATASET, FIGURE))


def test_two_configurations_share_a_folder_of_results(finished, project):
    """Configurations A, B, A: first the dataset, then its figure alone."""
    first = (finished.folder / DATASET).read_bytes()
    figure = (finished.folder / FIGURE).read_bytes()
    project.configure(configured(velocity=[0.5, 1, 2, 3]))
    project.run(FIGURE)
    assert project.values("velocity") == [0.5, 1, 2, 3]
    assert (project.folder / FIGURE).read_bytes() != figure
    project.configure(configured())
    assert "Nothing to be done" in project.run(DATASET, FIGURE)
    assert (project.folder / DATASET).read_bytes() == first
    assert (project.folder / FIGURE).read_bytes() == figure
    assert len(project.solved()) == 9 + 3


EDITING = """

from pathlib import Path as _Path
_before = solve

def solve(*arguments, **settings):
    file = _Path(__file__).parents[1] / "theory" / "paper.py"
    if "EDITED" not in file.read_text():
        file.write_text(file.read_text() + "\\nEDITED = True\\n")
    return _before(*arguments, **settings)
"""


def test_a_solver_that_is_edited_during_a_run_ends_it(project):
    project.append("src/microslip/answer/point.py", EDITING)
    before = project.records()
    process = project.snakemake(DATASET, *RUN)
    assert process.returncode != 0
    assert "was edited while its code was running" in process.stderr
    assert "Traceback" not in process.stderr
    assert project.records() == before
    assert not list((project.folder / "results").rglob("*.journal"))
    project.run(DATASET)
    assert project.planned(DATASET) == {}


def test_a_collector_that_fails_leaves_the_old_dataset(finished, project):
    project.append("src/microslip/datasets/sweep_dataset.py", "\n\ndef report(*_):\n    1 / 0\n")
    process = project.snakemake(DATASET, *RUN)
    assert process.returncode != 0
    assert (project.folder / DATASET).read_bytes() == (finished.folder / DATASET).read_bytes()


@pytest.mark.parametrize(
    ("file", "damage", "rules"),
    [
        (DATASET, lambda path: os.truncate(path, 1000), {"make_dataset", "draw_figure"}),
        ("results/summaries/slide.html", os.unlink, {"make_dataset", "draw_figure"}),
        (FIGURE, lambda path: os.truncate(path, 0), {"draw_figure"}),
        (FIGURE, lambda path: os.truncate(path, 9000), {"draw_figure"}),
    ],
)
def test_a_damaged_product_is_made_again(file, damage, rules, finished, project):
    damage((project.folder / file).resolve())
    jobs = jobs_in(project.run(DATASET, FIGURE))
    assert set(jobs) == rules | {"link_file"}
    for path in (DATASET, FIGURE):
        assert (project.folder / path).read_bytes() == (finished.folder / path).read_bytes()
    assert project.planned(DATASET, FIGURE) == {}


def test_a_dry_run_changes_no_content(project):
    os.truncate((project.folder / DATASET).resolve(), 1000)
    results = project.folder / "results"

    def contents():
        files = (path for path in results.rglob("*") if path.is_file())
        return {path: path.read_bytes() for path in files}

    before = contents()
    for arguments in (["-n"], ["--list"], ["--lint"]):
        process = project.snakemake("--configfile", "tiny.yaml", *arguments)
        assert process.returncode == 0, process.stderr
        assert contents() == before


FAILING = """

from microslip.foundation.errors import SolverError
_good = solve

def solve(**arguments):
    if arguments["velocity"] == 2 and not (_folder / "mended").exists():
        raise SolverError("no luck")
    return _good(**arguments)
"""


def test_a_point_that_failed_is_a_gap_and_is_tried_again(project):
    project.append("src/microslip/answer/point.py", FAILING)
    assert "slide: 9 points, 3 not converged" in project.run(DATASET)
    assert project.planned(DATASET)["solve_batch"] == 3
    assert "slide: 9 points, 3 not converged" in project.run(DATASET)
    (project.folder / "mended").touch()
    assert "slide: 9 points, all converged" in project.run(DATASET)
    assert project.planned(DATASET) == {}
