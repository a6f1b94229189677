"""Datasets and figures are of what is asked, whatever Snakemake remembers and whatever happened."""

import os
import shutil
import signal
import subprocess
import time

import pytest
import xarray as xr
import yaml
from stubs.workflow_project import AXES, RUN, SNAKEMAKE, TINY

from microslip.sweeps import sealed_files

pytestmark = pytest.mark.slow
OTHER = {**TINY, "sweeps": {**TINY["sweeps"], "transverse": {**AXES, "velocity": [0.5, 3]}}}
DRAWN = {"collect": 1, "draw_figure": 2, "all": 1}
"""Jobs for a dataset and its figures whose batches are there."""


def velocities(project, name="transverse"):
    with xr.open_dataset(project.folder / "results" / f"{name}.nc") as data:
        return list(data.velocity.values)


def both_solved(project):
    """Have the points of two configurations there, the datasets being of the other one."""
    project.configure(OTHER)
    project.run()
    assert velocities(project) == [0.5, 3]
    project.configure(TINY)


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


@pytest.mark.parametrize("how", [forget, copy_to_a_new_clone, share_the_folder])
def test_a_dataset_of_another_configuration_is_made_again(how, project):
    both_solved(project)
    how(project)
    assert project.planned() == DRAWN
    project.run()
    assert velocities(project) == [0.5, 2]
    assert project.planned() == {}


def unsealed(project):
    path = project.folder / "results" / "bore.nc"
    sealed_files.seal_of(path).unlink()


def foreign(project):
    """A dataset and its seal, both whole, of some other project."""
    results = project.folder / "results"
    for path in (results / "bore.nc", sealed_files.seal_of(results / "bore.nc")):
        path.write_bytes(path.with_name(path.name.replace("bore", "transverse")).read_bytes())


@pytest.mark.parametrize("how", [unsealed, foreign])
def test_a_dataset_without_its_own_seal_is_made_again(how, project):
    expected = (project.folder / "results" / "bore.nc").read_bytes()
    how(project)
    forget(project)
    assert project.planned() == {"collect": 1, "draw_figure": 1, "all": 1}
    project.run()
    assert (project.folder / "results" / "bore.nc").read_bytes() == expected


def test_a_figure_without_its_own_seal_is_drawn_again(project):
    figures = project.folder / "results" / "figures"
    shutil.copy(figures / "fig2_transverse_map.png", figures / "fig6_bore_map.png")
    forget(project)
    assert project.planned() == {"draw_figure": 1, "all": 1}


def snapshot(folder):
    """Names, contents and dates of all files but Snakemake's own notes."""
    files = (p for p in folder.rglob("*") if p.is_file() and ".snakemake" not in p.parts)
    return {p: (p.read_bytes(), p.stat().st_mtime_ns) for p in files}


@pytest.mark.parametrize("arguments", [["-n"], ["--list"], ["--lint"], ["--report", "r.html"]])
def test_asking_removes_and_renames_nothing(arguments, project):
    results = project.folder / "results"
    (results / "bore.nc").write_bytes(b"\x89HDF, once")
    (results / ".bore.nc.99999999.part").write_text("half")
    os.utime(results / ".bore.nc.99999999.part", (0, 0))
    before = snapshot(results)
    project.snakemake(*RUN, *arguments)
    assert snapshot(results) == before


def test_a_damaged_target_that_is_named_alone_is_made_again(project):
    path = project.folder / "results" / "bore.nc"
    expected = path.read_bytes()
    path.write_bytes(expected[:1000])
    said = project.run("results/bore.nc")
    assert "results/bore.nc is made again: it is damaged" in said
    assert path.read_bytes() == expected
    assert path.with_name("bore.nc.damaged").read_bytes() == expected[:1000]


def test_a_damaged_batch_is_made_again_from_the_points(project):
    batch = next(project.folder.glob("results/batches/bore/*.json"))
    expected = batch.read_bytes()
    batch.write_bytes(expected[:-20])
    points = project.points()
    assert project.planned()["solve_batch"] == 1
    project.run()
    assert batch.read_bytes() == expected
    assert project.points() == points
    assert project.planned() == {}


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
    project.run()
    assert velocities(project) == [0.5, 3]


EDITS = """

from pathlib import Path as _Path

_solve = solve


def solve(scene, velocity, amplitude=None, **settings):
    _file = _Path(__file__).parents[1] / "theory" / "paper.py"
    if "EDITED" not in _file.read_text():
        _file.write_text(_file.read_text() + "\\nEDITED = True\\n")
    return _solve(scene, velocity, amplitude, **settings)
"""


def test_sources_that_are_edited_while_a_run_is_on_end_it(project):
    """What is computed then is kept under no name, and the next run is of the new sources."""
    project.append("src/microslip/adaptive/point.py", EDITS)
    before = project.points()
    done = project.snakemake(*RUN)
    assert done.returncode != 0
    assert "was edited while its code was running" in done.stderr
    assert "Traceback" not in done.stderr
    assert project.points() == before
    project.run()
    assert project.planned() == {}


def test_results_of_one_place_serve_another(project):
    """Copied without what Snakemake noted: nothing to do."""
    copy_to_a_new_clone(project)
    assert project.planned() == {}
    assert yaml.safe_load((project.folder / "tiny.yaml").read_text()) == TINY
