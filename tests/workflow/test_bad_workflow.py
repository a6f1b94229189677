"""Bad input to the workflow: runs of Snakemake that end with one line, before any job."""

import re
from pathlib import Path

import pytest
from bad_input_tables.bad_configurations import FILES, GOOD, changed
from stubs.workflow_project import snakemake

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.slow

DEFAULT = "config/config.yaml"
LINKED = ("profiles", "src", "workflow", "Snakefile")
FOLDER = None
"""Content of an empty folder."""

# Text of given.yaml for --configfile or None, contents of other files, arguments of Snakemake,
# beginning of its message. Tests of all keys, by the same reader but without Snakemake, are in
# tests/config/test_bad_input.py.
IN_RESULTS = "given.yaml: results: "
OWN = changed({"sweeps.transverse.motion": "own.py"})
KEY = "sweeps.transverse.velocities"
CASES = {
    "a misspelt key": (changed({KEY: "[1]"}), {}, "-n", f"given.yaml: {KEY}: "),
    "overridden": (GOOD, {}, "-j1 --config points_per_job=0", "given.yaml: points_per_job: 0 is "),
    "an own motion": (OWN, {"own.py": b"1 / 0"}, "-n", "given.yaml: motion = 'own.py:sha256="),
    "tabs": (None, {DEFAULT: FILES["tabs"][0]}, "-n", f"{DEFAULT}: not valid YAML: "),
    "no default": (None, {}, "-j1", f"{DEFAULT}: cannot be read: No such file"),
    "a file": (GOOD, {"results": b"kept"}, "-n", IN_RESULTS + "results is not a folder; allowed: "),
    "a folder": (GOOD, {"results/bore.nc": FOLDER}, "-j1", IN_RESULTS + "results/bore.nc is a fol"),
    "a name": (f"results: {'x' * 300}\n{GOOD}", {}, "-n", IN_RESULTS + "cannot use xxx"),
}


def ended(folder, text, files, arguments):
    """Run of Snakemake in a new folder of links to this project."""
    for name in LINKED:
        (folder / name).symlink_to(ROOT / name)
    given = {} if text is None else {"given.yaml": text.encode(), DEFAULT: GOOD.encode()}
    for name, content in (given | files).items():
        path = folder / name
        (path if content is FOLDER else path.parent).mkdir(parents=True, exist_ok=True)
        if content is not FOLDER:
            path.write_bytes(content)
    options = ["--configfile", "given.yaml"] if text else []
    return snakemake([*arguments.split(), *options], folder)


@pytest.mark.parametrize("case", CASES)
def test_the_workflow_ends_with_one_line_before_any_job(case, tmp_path):
    *given, message = CASES[case]
    run = ended(tmp_path, *given)
    assert (run.returncode, run.stdout) == (1, "")
    lines = [line for line in run.stderr.splitlines() if "specific profile" not in line]
    assert len(lines) == 1
    assert lines[0].startswith(f"Error in {message}")
    assert {path.name for path in tmp_path.glob("results/**/*")} <= {"bore.nc"}


def test_results_that_cannot_be_made_end_a_run_before_its_first_job(tmp_path):
    run = ended(tmp_path, f"results: /proc/none/here\n{GOOD}", {}, "-j1")
    assert run.returncode == 1
    line = run.stderr.strip().splitlines()[-1]
    message = "results: cannot write to /proc/none/here: .*make room or set perm"
    assert re.match(f"Error in given.yaml: {message}", line)
    assert "Traceback" not in run.stderr
    assert not list((tmp_path / ".snakemake" / "locks").glob("*"))  # no lock prevents the next run
