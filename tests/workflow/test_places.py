"""The workflow in another folder, as a module of another workflow, and as an installed copy.

All give the dataset of an ordinary run, byte for byte. Also: the report of a run.
"""

import re
import shutil
import subprocess
import sys
import zipfile

import pytest
import xarray as xr
import yaml
from stubs.workflow_project import ENVIRONMENT, ROOT, RUN, TINY, Project, jobs_in

from microslip.foundation import source_digest

pytestmark = pytest.mark.slow

CONFIGURATION = {"sweeps": {"bore": TINY["sweeps"]["bore"]}, "points_per_job": 4}
DATASET = "results/bore.nc"


@pytest.fixture(scope="module")
def ordinary(finished, tmp_path_factory):
    """A project after an ordinary run, for comparison. Tests must not change it."""
    project = finished.copied(tmp_path_factory.mktemp("places") / "microslip")
    project.said = finished.said
    return project


def beside(project, name, configuration=CONFIGURATION):
    """A new folder next to a project, with a configuration in tiny.yaml."""
    place = Project.at(project.folder.parent / name)
    place.folder.mkdir()
    place.configure(configuration)
    return place


def bytes_of(place, path=DATASET):
    return (place.folder / path).read_bytes()


# Other folders


@pytest.mark.long
def test_another_folder_gets_the_results_of_a_run_there(ordinary):
    place = beside(ordinary, "elsewhere")
    place.run(DATASET, "-s", "../microslip/Snakefile")
    assert bytes_of(place) == bytes_of(ordinary)
    # From a third folder, with the option --directory, nothing remains to do.
    third = beside(ordinary, "third")
    there = ("-s", "../microslip/workflow/Snakefile", "-d", "../elsewhere")
    assert third.planned(DATASET, *there) == {}
    assert not (third.folder / "results").exists()


def test_the_default_configuration_is_found_from_another_folder_unless_that_has_one(ordinary):
    place = beside(ordinary, "bare")
    plan = ["-s", "../microslip/Snakefile", "--dry-run"]
    assert jobs_in(place.snakemake(*plan).stdout)["make_products"] == 1
    (place.folder / "config").mkdir()
    (place.folder / "config" / "config.yaml").write_text(yaml.safe_dump(CONFIGURATION))
    assert jobs_in(place.snakemake(*plan).stdout)["make_dataset"] == 1


@pytest.mark.long
def test_files_that_a_configuration_names_lie_beside_it(ordinary):
    """Files of a configuration are found from any folder."""
    place, far = beside(ordinary, "pads"), ordinary.folder.parent / "far"
    far.mkdir()
    pad = {"motion": "transverse", "pressure": "file:pad.csv", "tolerance": 0.1}
    pad |= {"velocity": [20, 30], "amplitude": [0.1]}
    stroke = {"motion": "file:stroke.csv", "velocity": [20, 30]}
    stroke |= {"amplitude": [0.1], "tolerance": 0.1}
    (far / "stroke.csv").write_text("lateral\n0\n1\n0\n-1\n")
    (far / "mine.yaml").write_text(yaml.safe_dump({"sweeps": {"pad": pad, "stroke": stroke}}))
    there = ("-s", "../microslip/Snakefile", "--configfile", "../far/mine.yaml")
    (far / "pad.csv").write_text("forward,lateral,pressure\n0,0,1\n0,1,1\n1,0,1\n1,1,1\n")
    process = place.snakemake("results/pad.nc", "results/stroke.nc", *there, "-j1")
    assert process.returncode == 0, process.stderr
    with xr.open_dataset(place.folder / "results" / "stroke.nc") as data:
        assert data.attrs["motion"].startswith("file:sha256=")
        assert data.attrs["motion_file"] == "stroke.csv"
        assert bool(data.converged.all())
    with xr.open_dataset(place.folder / "results" / "pad.nc") as data:
        assert data.attrs["pressure"].startswith("file:sha256=")
        assert bool(data.converged.all())


# Modules

OUTER = """
configfile: "tiny.yaml"

rule all:
    input:
        "outer.txt",

module friction:
    snakefile: "../microslip/Snakefile"
    config: config["friction"]
    prefix: "sub"

use rule * from friction as friction_*

rule outer:
    input:
        "sub/results/bore.nc",
    output:
        "outer.txt",
    shell:
        "ls {input} > {output}"
"""
# A Snakefile as written by snakedeploy.
DEPLOYED = """
configfile: "tiny.yaml"

module friction:
    snakefile: "../microslip/workflow/Snakefile"
    config: config

use rule * from friction
"""


@pytest.mark.long
def test_a_module_of_another_workflow_gives_the_same_dataset(ordinary):
    place = beside(ordinary, "outer", {"friction": CONFIGURATION, "of_another": 1})
    (place.folder / "Snakefile").write_text(OUTER)
    message = place.run()
    assert "friction_make_dataset" in message
    assert (place.folder / "outer.txt").read_text() == f"sub/{DATASET}\n"
    assert bytes_of(place, f"sub/{DATASET}") == bytes_of(ordinary)
    assert [p.name for p in (place.folder / "sub").iterdir()] == ["results"]
    assert not (place.folder / "results").exists()
    assert place.planned() == {}


def test_a_module_may_be_the_whole_workflow_and_says_when_its_configuration_is_bad(ordinary):
    place = beside(ordinary, "deployed")
    (place.folder / "Snakefile").write_text(DEPLOYED)
    assert place.planned()["make_dataset"] == 1
    place.configure({**CONFIGURATION, "sweep": {}})
    process = place.snakemake("--dry-run")
    assert process.returncode != 0
    assert "Error in configuration: sweep: unknown key" in process.stderr


# Installed copies


@pytest.fixture(scope="module")
def installed(ordinary):
    """Function that runs `microslip` from an unpacked wheel, without the source tree."""
    pytest.importorskip("hatchling", reason="builds the package")
    folder = ordinary.folder.parent / "installed"
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    with zipfile.ZipFile(*folder.glob("*.whl")) as wheel:
        wheel.extractall(folder)

    def microslip(place, *arguments):
        return subprocess.run(
            [sys.executable, "-m", "microslip", *arguments],
            cwd=place.folder,
            env={**ENVIRONMENT, "PYTHONPATH": str(folder)},
            capture_output=True,
            text=True,
            timeout=300,
        )

    return microslip


@pytest.mark.long
def test_an_installed_copy_gives_the_same_dataset_and_finds_what_a_tree_made(ordinary, installed):
    place = beside(ordinary, "empty")
    process = installed(place, "sweep", DATASET, *RUN)
    assert process.returncode == 0, process.stderr
    assert bytes_of(place) == bytes_of(ordinary)
    # The source tree uses the results of the installed copy, and the other way round.
    assert place.planned(DATASET, "-s", "../microslip/Snakefile") == {}
    copy = beside(ordinary, "copied")
    shutil.copytree(ordinary.folder / "results", copy.folder / "results", symlinks=True)
    shutil.copytree(ordinary.folder / ".snakemake", copy.folder / ".snakemake")
    process = installed(copy, "sweep", "--configfile", "tiny.yaml")
    assert "Nothing to be done" in process.stdout + process.stderr, process.stderr
    # Without arguments: the sweeps of the paper, whose configuration is in the package.
    plan = installed(place, "sweep", "--dry-run", "--quiet", "host")
    assert re.search(r"make_products +1\n", plan.stdout)


# The report


def offline():
    """Beginning of a command line that disables the network, if the system allows it."""
    without = ["unshare", "--map-root-user", "--net"]
    tried = shutil.which("unshare") and subprocess.run([*without, "true"], capture_output=True)
    return without if tried and tried.returncode == 0 else []


@pytest.mark.long
def test_the_report_is_made_offline_and_holds_captions_and_what_made_the_datasets(ordinary):
    report = ordinary.folder.parent / "report.zip"
    command = [sys.executable, "-m", "snakemake", *RUN[1:], "--report", str(report)]
    process = subprocess.run([*offline(), *command], cwd=ordinary.folder, capture_output=True)
    assert process.returncode == 0, process.stderr
    with zipfile.ZipFile(report) as files:
        raw = sorted(name.rpartition("/")[2] for name in files.namelist() if "/raw/" in name)
        page = files.read("report/report.html").decode()
        about = next(files.read(n).decode() for n in files.namelist() if "/transverse." in n)
    pages = [name.partition(".")[0] for name in raw if name.endswith(".html")]
    assert pages == ["bore", "continuous_bore", "transverse"]
    assert [name[:4] for name in raw if name.startswith("fig")] == [f"fig{i}" for i in range(1, 7)]
    assert "fig1_force_history.</strong>" in page and "fig2_transverse_map.</strong>" in page
    assert "how much vibration reduces the friction" in page
    assert "transverse: 4 points, all converged" in about
    assert f"source_digest: {source_digest.of_solver()}" in about
    assert "amplitude: [0.0, 1.0]" in about
