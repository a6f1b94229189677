"""Which tests a command line runs: what is long is left out unless something is named."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
TIERS = """\
import pytest


def test_quick():
    pass


@pytest.mark.slow
def test_half_a_second():
    pass


@pytest.mark.long
def test_several_seconds():
    pass


@pytest.mark.slow
@pytest.mark.parametrize("case", range(4))
def test_of_cases(case):
    pass
"""
ENDS = {"test_of_cases[0]", "test_of_cases[3]"}
CASES = ENDS | {"test_of_cases[1]", "test_of_cases[2]"}
QUICK, SLOW, LONG = "test_quick", "test_half_a_second", "test_several_seconds"


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a test of each tier, set up as this one is."""
    folder = tmp_path_factory.mktemp("marks")
    (folder / "tests").mkdir()
    shutil.copy(TESTS / "conftest.py", folder / "tests")
    shutil.copy(TESTS.parent / "pyproject.toml", folder)
    shutil.copytree(TESTS.parent / ".ci", folder / ".ci")
    (folder / "tests" / "test_tiers.py").write_text(TIERS)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["-n1"], {QUICK, SLOW} | ENDS),  # another process is handed what the first one was told
        (["-n1", "tests"], {QUICK, SLOW, LONG} | CASES),
        (["-n0", "-m", "slow"], {SLOW, LONG} | CASES),
        (["-n0", "-k", "seconds or cases"], {LONG} | CASES),
    ],
)
def test_what_is_long_runs_when_something_is_named(arguments, expected, folder):
    assert passed([sys.executable, "-m", "pytest", *arguments], folder) == expected


@pytest.mark.slow
def test_everything_is_run_by_one_script(folder):
    assert passed(["bash", ".ci/whole", "-n0"], folder) == {QUICK, SLOW, LONG} | CASES


def passed(command, folder):
    """Names of the tests that a command runs."""
    loads_nothing = ["-o", "filterwarnings="]  # the package's warnings are those of libraries
    done = subprocess.run(
        [*command, "-rA", *loads_nothing],
        cwd=folder,
        env=os.environ | {"PYTHON": sys.executable},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return {line.rpartition("::")[2] for line in done.stdout.splitlines() if "::" in line}
