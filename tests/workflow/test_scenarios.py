"""Datasets and figures match the configuration and the code after any sequence of runs."""

import os
import random
import shutil
import signal
import subprocess
import time

import pytest
import xarray as xr
from stubs.workflow_project import ENVIRONMENT, RUN, SNAKEMAKE, Project, jobs_in

pytestmark = pytest.mark.long

AXES = {"velocity": [0.5, 1, 2], "amplitude": [0.5, 1, 2], "tolerance": 1e-2}
RIGID = {**AXES, "motion": "transverse", "model": "rigid", "group": "rigid"}
DATASET, FIGURE = "results/slide.nc", "results/figures/extended_rigid.png"
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
    slide = RIGID | changed
    paper = {"transverse": {"velocity": [1], "amplitude": [0]}}
    return {"sweeps": paper, "extended": {"slide": slide}, "points_per_job": 3}


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
    project.append("src/microslip/adaptive/point.py", COUNTING)
    project.configure(configured())
    assert jobs_in(project.run(DATASET, FIGURE)) == {
        "warm_up": 2,
        "solve": 3,
        "collect": 1,
        "draw": 1,
    }
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
        ("poisson", [0, 0.3], 3, 9),
    ],
)
def test_a_grown_axis_solves_its_new_points_alone(axis, values, batches, new, project):
    project.configure(configured(**{axis: values}))
    assert jobs_in(project.run(DATASET))["solve"] >= batches
    assert len(project.solved()) == 9 + new
    assert project.values(axis) == values
    assert project.planned(DATASET) == {}
    project.configure(configured())
    assert jobs_in(project.run(DATASET)) == {"collect": 1}


def started(project, *arguments):
    """Start a run as the leader of a session."""
    return subprocess.Popen(
        [SNAKEMAKE, *arguments, *RUN],
        cwd=project.folder,
        env=ENVIRONMENT,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def killed(project, seconds):
    """Start a run, and kill it with its jobs after some seconds."""
    running = started(project, DATASET, "--nolock")
    time.sleep(seconds)
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()


def test_kills_lose_the_points_in_flight_at_most(finished, project):
    shutil.rmtree(project.folder / "results" / "points")
    shutil.rmtree(project.folder / "results" / "batches")
    (project.folder / DATASET).unlink()
    (project.folder / "solved").unlink()
    (project.folder / "slow").touch()
    draw = random.Random(1)
    for _ in range(6):
        killed(project, draw.uniform(2.0, 12.0))
    (project.folder / "slow").unlink()
    project.run(DATASET)
    solved = project.solved()
    assert len(set(solved)) == 9
    assert len(solved) - 9 <= 6 * 2
    assert (project.folder / DATASET).read_bytes() == (finished.folder / DATASET).read_bytes()
    assert project.planned(DATASET) == {}


def wait_until(holds):
    for _ in range(1000):
        if holds():
            return
        time.sleep(0.1)
    pytest.fail("it never happens")


def is_alive(session):
    """True if a process of the session runs, or may not be looked at."""
    try:
        os.killpg(session, 0)
    except ProcessLookupError:
        return False
    return True


PLAIN = ["--workflow-profile", "none", "--rerun-triggers", "mtime", "--rerun-incomplete"]


@pytest.mark.parametrize(
    ("moment", "options"),
    [("after its jobs", []), ("after its jobs", PLAIN), ("beside its jobs", [])],
    ids=["after", "after, without the profile", "beside"],
)
def test_one_run_makes_every_file_after_a_kill_of_snakemake_alone(
    moment, options, finished, project
):
    """The jobs of the killed process go on, and end before the next run begins or during it."""
    shutil.rmtree(project.folder / "results" / "points")
    shutil.rmtree(project.folder / "results" / "batches")
    for name in (DATASET, FIGURE, "solved"):
        (project.folder / name).unlink()
    (project.folder / "hold").touch()
    running = started(project, DATASET, FIGURE)
    try:
        wait_until(project.solved)
        running.kill()
        running.wait()
        assert is_alive(running.pid)  # the job that solves
        assert not list(project.folder.glob("results/batches/*/*"))
        if moment == "after its jobs":
            (project.folder / "hold").unlink()
            wait_until(lambda: not is_alive(running.pid))
            assert list(project.folder.glob("results/batches/*/*"))
        assert project.snakemake("--unlock", *RUN).returncode == 0
        (project.folder / "hold").unlink(missing_ok=True)
        project.run(DATASET, FIGURE, *options)
        wait_until(lambda: not is_alive(running.pid))
    finally:
        if is_alive(running.pid):
            os.killpg(running.pid, signal.SIGKILL)
    for file in (DATASET, FIGURE):
        assert (project.folder / file).read_bytes() == (finished.folder / file).read_bytes()
    assert project.planned(DATASET, FIGURE) == {}


def forget(project):
    shutil.rmtree(project.folder / ".snakemake")
    return project


def copy(project):
    """Results copied to another working directory, with the dates of copying."""
    there = project.folder.parent / "there"
    shutil.copytree(project.folder, there, ignore=shutil.ignore_patterns(".snakemake"))
    for path in there.rglob("*"):
        os.utime(path)
    return Counted.at(there)


def share(project):
    """Another working directory with the same folder of results."""
    there = project.folder.parent / "there"
    shutil.copytree(project.folder, there, ignore=shutil.ignore_patterns(".snakemake", "results"))
    (there / "results").symlink_to(project.folder / "results")
    return Counted.at(there)


@pytest.mark.parametrize("how", [forget, copy, share])
def test_what_snakemake_remembers_does_not_count(how, project):
    elsewhere = how(project)
    assert elsewhere.planned(DATASET, FIGURE) == {}
    elsewhere.configure(configured(velocity=[0.5, 1]))
    assert elsewhere.planned(DATASET)["collect"] == 1


def test_dates_do_not_count(project):
    """Dates between 1970 and 2096, in any order."""
    draw = random.Random(1)
    for path in (project.folder / "results").rglob("*"):
        os.utime(path, (draw.uniform(1e3, 4e9),) * 2)
    assert project.planned(DATASET, FIGURE) == {}


def test_two_configurations_share_a_folder_of_results(finished, project):
    """Configurations A, B, A: first the dataset, then its figure alone."""
    first = (finished.folder / DATASET).read_bytes()
    figure = (finished.folder / FIGURE).read_bytes()
    project.configure(configured(velocity=[0.5, 1, 2, 3]))
    project.run(FIGURE)
    assert project.values("velocity") == [0.5, 1, 2, 3]
    assert (project.folder / FIGURE).read_bytes() != figure
    project.configure(configured())
    assert jobs_in(project.run(DATASET)) == {"collect": 1}
    assert (project.folder / DATASET).read_bytes() == first
    project.run(FIGURE)
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
    project.append("src/microslip/adaptive/point.py", EDITING)
    before = project.points()
    process = project.snakemake(DATASET, "-j2", "--configfile", "tiny.yaml")
    assert process.returncode != 0
    assert "was edited while its code was running" in process.stderr
    assert "Traceback" not in process.stderr
    assert project.points() == before
    project.run(DATASET)
    assert project.planned(DATASET) == {}


def test_a_collector_that_fails_leaves_the_old_dataset(finished, project):
    project.append("src/microslip/datasets/sweep_dataset.py", "\n\ndef report(*_):\n    1 / 0\n")
    process = project.snakemake(DATASET, "-j2", "--configfile", "tiny.yaml")
    assert process.returncode != 0
    assert (project.folder / DATASET).read_bytes() == (finished.folder / DATASET).read_bytes()


DAMAGED = {
    "a dataset cut short": (DATASET, lambda path: os.truncate(path, 1000), {"collect", "draw"}),
    "a dataset of another": (DATASET, lambda path: path.write_text("mine"), {"collect", "draw"}),
    "no page": ("results/summaries/slide.html", lambda path: path.unlink(), {"collect", "draw"}),
    "an empty figure": (FIGURE, lambda path: os.truncate(path, 0), {"draw"}),
    "no stamp": ("results/.made/slide.json", lambda path: path.unlink(), {"collect", "draw"}),
    "a bad stamp": (
        "results/.made/slide.json",
        lambda path: path.write_text("{"),
        {"collect", "draw"},
    ),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_a_damaged_product_is_made_again(case, finished, project):
    file, damage, rules = DAMAGED[case]
    damage(project.folder / file)
    message = project.run(DATASET, FIGURE)
    assert set(jobs_in(message)) >= rules
    for path in (DATASET, FIGURE):
        assert (project.folder / path).read_bytes() == (finished.folder / path).read_bytes()
    files = project.folder / f"{DATASET}.damaged"
    assert files.exists() == (
        case in ("a dataset cut short", "a dataset of another", "no stamp", "a bad stamp")
    )
    assert project.planned(DATASET, FIGURE) == {}


def test_a_damaged_batch_is_made_again_from_its_points(finished, project):
    batch, *_ = (project.folder / "results/batches/slide").glob("*.jsonl")
    whole = batch.read_bytes()
    os.truncate(batch, len(whole) - 30)
    message = project.run(DATASET)
    assert jobs_in(message) == {"solve": 1, "collect": 1}
    assert batch.read_bytes() == whole
    assert len(project.solved()) == 9
    point, *_ = (project.folder / "results/points/transverse").rglob("*.json")
    os.truncate(point, 40)
    shutil.rmtree(project.folder / "results/batches")
    (project.folder / DATASET).unlink()
    assert "damaged result" in project.run(DATASET)
    assert len(project.solved()) == 10
    assert (project.folder / DATASET).read_bytes() == (finished.folder / DATASET).read_bytes()


def test_a_dry_run_changes_no_content(project):
    (project.folder / DATASET).write_bytes(b"\x89HDF, once")
    results = project.folder / "results"

    def contents():
        files = (path for path in results.rglob("*") if path.is_file() and path.name != ".again")
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
        raise {error}("no luck")
    return _good(**arguments)
"""


def test_a_point_that_failed_is_a_gap_and_is_tried_again(project):
    project.append("src/microslip/adaptive/point.py", FAILING.format(error="SolverError"))
    assert "slide: 9 points, 3 not converged" in project.run(DATASET)
    assert project.planned(DATASET)["solve"] == 3
    (project.folder / "mended").touch()
    assert "slide: 9 points, all converged" in project.run(DATASET)
    assert project.planned(DATASET) == {}


def test_an_error_of_the_code_fails_the_run(project):
    project.append("src/microslip/adaptive/point.py", FAILING.format(error="TypeError"))
    process = project.snakemake(DATASET, "-j2", "--configfile", "tiny.yaml")
    assert process.returncode != 0
    assert "TypeError: no luck" in process.stderr
