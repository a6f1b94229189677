"""Datasets and figures are of what is asked, whatever Snakemake remembers and whatever happened."""

import os
import shutil
import signal
import subprocess
import time

import pytest
import xarray as xr
import yaml
from stubs.workflow_project import AXES, ENVIRONMENT, RUN, SNAKEMAKE, TINY, jobs_in

from microslip.foundation import files

pytestmark = pytest.mark.slow
OTHER = {**TINY, "sweeps": {**TINY["sweeps"], "transverse": {**AXES, "velocity": [0.5, 3]}}}
DRAWN = {"collect": 1, "draw_figure": 2, "all": 1}
"""Jobs for a dataset and its figures whose batches are there."""


def velocities(project, name="transverse"):
    with xr.open_dataset(project.folder / "results" / f"{name}.nc") as data:
        return list(data.velocity.values)


COUNTING = """
import atexit, hashlib
names, digest = [], hashlib.file_digest

def counted(file, *arguments):
    names.append(file.name)
    return digest(file, *arguments)

hashlib.file_digest = counted
atexit.register(lambda: open("hashed.txt", "w").write("\\n".join(names)))
"""


@pytest.mark.long
def test_planning_reads_each_output_once(finished, tmp_path):
    project = finished.copied(tmp_path / "copy")
    (project.folder / "sitecustomize.py").write_text(COUNTING)
    environment = ENVIRONMENT | {"PYTHONPATH": "."}
    command = [SNAKEMAKE, "--dry-run", *RUN]
    subprocess.run(command, cwd=project.folder, env=environment, check=True, capture_output=True)
    hashed = (project.folder / "hashed.txt").read_text().split()
    assert len(hashed) == len(set(hashed)) == 3 + 3 + 2 * 6  # datasets, pages, figures


@pytest.fixture(scope="module")
def both_solved(finished, tmp_path_factory):
    """The points of two configurations are there, the datasets are of the other one."""
    project = finished.copied(tmp_path_factory.mktemp("solved") / "copy")
    project.configure(OTHER)
    project.run("results/transverse.nc")
    assert velocities(project) == [0.5, 3]
    project.configure(TINY)
    return project


def forget(project):
    shutil.rmtree(project.folder / ".snakemake")


def copy_to_a_new_clone(project):
    """Results copied into another working directory; their dates are those of copying."""
    moved = project.folder.parent / "moved"
    shutil.copytree(project.folder, moved, ignore=shutil.ignore_patterns(".snakemake"))
    now = time.time()
    for path in moved.rglob("*"):
        os.utime(path, (now, now))
    project.folder = moved


def share_the_folder(project):
    """Another working directory whose results are the same folder."""
    there = project.folder.parent / "there"
    shutil.copytree(project.folder, there, ignore=shutil.ignore_patterns(".snakemake", "results"))
    (there / "results").symlink_to(project.folder / "results")
    project.folder = there


@pytest.mark.long
@pytest.mark.parametrize("how", [forget, copy_to_a_new_clone, share_the_folder])
def test_a_dataset_of_another_configuration_is_to_be_made_again(how, both_solved, tmp_path):
    project = both_solved.copied(tmp_path / "copy")
    how(project)
    assert project.planned() == DRAWN


@pytest.mark.long
def test_a_dataset_of_another_configuration_is_made_again(both_solved, tmp_path):
    project = both_solved.copied(tmp_path / "copy")
    share_the_folder(project)
    target = "results/transverse.nc"
    assert jobs_in(project.run(target)) == {"collect": 1}
    assert velocities(project) == [0.5, 2]
    assert project.planned(target) == {}


@pytest.mark.long
def test_what_has_no_seal_of_its_own_is_made_again(project):
    """A dataset without one; one of some other project, with its seal; a figure that is another."""
    results = project.folder / "results"
    bore, continuous = results / "bore.nc", results / "continuous_bore.nc"
    expected = [path.read_bytes() for path in (bore, continuous)]
    files.seal_of(bore).unlink()
    transverse = results / "transverse.nc"
    shutil.copy(transverse, continuous)
    shutil.copy(files.seal_of(transverse), files.seal_of(continuous))
    figures = results / "figures"
    shutil.copy(figures / "fig2_transverse_map.png", figures / "fig1_force_history.png")
    forget(project)
    of_datasets = 1 + 3
    assert project.planned() == {"collect": 2, "draw_figure": of_datasets + 1, "all": 1}
    project.run("results/bore.nc", "results/continuous_bore.nc")
    assert [path.read_bytes() for path in (bore, continuous)] == expected


def snapshot(folder):
    """Names, contents and dates of all files but Snakemake's own notes."""
    files = (p for p in folder.rglob("*") if p.is_file() and ".snakemake" not in p.parts)
    return {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in files}


@pytest.mark.long
def test_asking_removes_and_renames_nothing(project):
    results = project.folder / "results"
    (results / "bore.nc").write_bytes(b"\x89HDF, once")
    (results / ".bore.nc.99999999.part").write_text("half")
    os.utime(results / ".bore.nc.99999999.part", (0, 0))
    before = snapshot(results)
    for arguments in (["-n"], ["--list"], ["--report", "r.html"]):
        project.snakemake(*RUN, *arguments)
        assert snapshot(results) == before
    done = project.snakemake(*RUN, "--lint")
    assert done.returncode == 0, done.stderr
    assert "good condition" in done.stdout + done.stderr
    assert snapshot(results) == before


SLOWLY = """
import os, time
_write = write_sweep
def write_sweep(*given):
    open("collecting", "w").close()
    time.sleep(60)
    _write(*given)
"""


def test_a_kill_while_a_dataset_is_collected_leaves_the_old_one(project):
    path = project.folder / "results" / "transverse.nc"
    old = path.read_bytes()
    project.configure(OTHER)
    project.append("src/microslip/datasets/sweep_dataset.py", SLOWLY)
    running = subprocess.Popen(
        [SNAKEMAKE, "results/transverse.nc", *RUN],
        cwd=project.folder,
        stderr=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        start_new_session=True,
    )
    for _ in range(1200):
        if (project.folder / "collecting").exists() or running.poll() is not None:
            break
        time.sleep(0.1)
    assert running.poll() is None
    os.killpg(running.pid, signal.SIGKILL)
    running.wait()
    assert path.read_bytes() == old
    text = (project.folder / "src/microslip/datasets/sweep_dataset.py").read_text()
    (project.folder / "src/microslip/datasets/sweep_dataset.py").write_text(
        text.replace(SLOWLY, "")
    )
    done = project.snakemake("--unlock", *RUN)
    assert done.returncode == 0, done.stderr
    project.run("results/transverse.nc")
    assert velocities(project) == [0.5, 3]


EDITS = """

from pathlib import Path as _Path

_solve = solve


def solve(motion, velocity, amplitude=None, **settings):
    _file = _Path(__file__).parents[1] / "theory" / "paper.py"
    if "EDITED" not in _file.read_text():
        _file.write_text(_file.read_text() + "\\nEDITED = True\\n")
    return _solve(motion, velocity, amplitude, **settings)
"""


@pytest.mark.long
def test_sources_that_are_edited_while_a_run_is_on_end_it(project):
    """What is computed then is kept under no name, and the next run is of the new sources."""
    project.append("src/microslip/adaptive/point.py", EDITS)
    before, target = project.points(), "results/bore.nc"
    done = project.snakemake(target, *RUN)
    assert done.returncode != 0
    assert "was edited while its code was running" in done.stderr
    assert "Traceback" not in done.stderr
    assert project.points() == before
    project.run(target)
    assert project.planned(target) == {}


def test_results_of_one_place_serve_another(project):
    """Copied without what Snakemake noted: nothing to do."""
    copy_to_a_new_clone(project)
    assert project.planned() == {}
    assert yaml.safe_load((project.folder / "tiny.yaml").read_text()) == TINY
