"""Bad input to the workflow: runs of Snakemake that end with one line, before any job."""

import re
from pathlib import Path

import pytest
from bad_input_tables.bad_configurations import FILES, GOOD, changed
from stubs import snakemake_server
from stubs.workflow_project import ENVIRONMENT

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow

GIVEN = ["--configfile", "given.yaml"]
LINKED = ("profiles", "src", "workflow", "Snakefile")


def given(content=GOOD):
    """Function that writes given.yaml, for --configfile, into the folder of a project."""
    content = content.encode() if isinstance(content, str) else content
    return lambda folder: (folder / "given.yaml").write_bytes(content)


def default(case):
    """Replace the default configuration by an invalid file."""
    return lambda folder: (folder / "config" / "config.yaml").write_bytes(FILES[case][0])


def beside(make):
    """Function that writes a valid given.yaml and then calls `make` with the folder."""
    return lambda folder: (given()(folder), make(folder))


def key(name, value):
    """A bad value of a key, and the beginning of its message."""
    return given(changed({name: value})), GIVEN, f"given.yaml: {name}: "


# Preparation, arguments of Snakemake, beginning of its message. Tests of all keys, by the same
# reader but without Snakemake, are in tests/config/test_bad_input.py.
CASES = {
    "a misspelt key": key("sweeps.transverse.velocities", "[1]"),
    "a bad name": key("sweeps.Bore", "{}"),
    "a misspelt motion": key("sweeps.transverse.motion", "eliptic"),
    "a key twice": (given(FILES["a key twice"][0]), GIVEN, "given.yaml: not valid YAML: the key"),
    "overridden": (
        given(),
        [*GIVEN, "--config", "points_per_job=0"],
        "given.yaml: points_per_job: 0 is not allowed; allowed: a whole number >= 1",
    ),
    "overridden under another name": (
        given(),
        [*GIVEN, "--config", "result=here"],
        "given.yaml: result: unknown key; did you mean results?",
    ),
    "a default with tabs": (default("tabs"), [], "config/config.yaml: not valid YAML: "),
    "a default that is no text": (default("not UTF-8"), [], "config/config.yaml: line 1: not text"),
    "no default": (
        lambda folder: (folder / "config" / "config.yaml").unlink(),
        [],
        "config/config.yaml: cannot be read: No such file",
    ),
    "a file for results": (
        beside(lambda folder: (folder / "results").write_text("kept")),
        GIVEN,
        "given.yaml: results: results is not a folder; allowed: ",
    ),
    "a file for batches": (
        beside(lambda folder: ((folder / "results").mkdir(), (folder / "results/batches").touch())),
        GIVEN,
        "given.yaml: results: results/batches is not a folder; allowed: ",
    ),
    "a folder for a dataset": (
        beside(lambda folder: (folder / "results" / "bore.nc").mkdir(parents=True)),
        GIVEN,
        "given.yaml: results: results/bore.nc is a folder; allowed there: ",
    ),
    "a long name for results": (
        given(f"results: {'x' * 300}\n{GOOD}"),
        GIVEN,
        "given.yaml: results: cannot use xxx",
    ),
}
# Half of them are dry runs, half runs: all must end before planning.
MODES = {case: ["-n"] if index % 2 else ["-j1"] for index, case in enumerate(CASES)}


def snakemake(folder, *arguments):
    return snakemake_server.start(arguments, folder, ENVIRONMENT, timeout=120)


def project(folder, prepare):
    """A project in a new folder of links to this one."""
    (folder / "config").mkdir(parents=True)
    (folder / "config" / "config.yaml").write_text(GOOD)
    for name in LINKED:
        (folder / name).symlink_to(ROOT / name)
    prepare(folder)
    return folder


def content(folder):
    """Contents of all files of a project, except those of Snakemake itself."""
    files = [p for p in folder.rglob("*") if ".snakemake" not in p.parts and p.name not in LINKED]
    return {p: p.is_file() and p.read_bytes() for p in files}


@pytest.mark.parametrize("case", CASES)
def test_the_workflow_ends_with_one_line_before_any_job(case, tmp_path):
    prepare, arguments, message = CASES[case]
    folder = project(tmp_path / "it", prepare)
    before = content(folder)
    ended = snakemake(folder, *MODES[case], *arguments)
    assert ended.returncode == 1
    assert ended.stdout == ""
    lines = [line for line in ended.stderr.splitlines() if "specific profile" not in line]
    assert len(lines) == 1
    assert lines[0].startswith(f"Error in {message}")
    assert content(folder) == before


def test_results_that_cannot_be_made_end_a_run_before_its_first_job(tmp_path):
    folder = project(tmp_path / "it", given(f"results: /proc/none/here\n{GOOD}"))
    ended = snakemake(folder, "-j1", *GIVEN)
    assert ended.returncode == 1
    line = ended.stderr.strip().splitlines()[-1]
    message = "results: cannot write to /proc/none/here: .*make room or set perm"
    assert re.match(f"Error in given.yaml: {message}", line)
    assert "Traceback" not in ended.stderr
    assert not list((folder / ".snakemake" / "locks").glob("*"))  # no lock prevents the next run
