"""``microslip sweep``: refused arguments, help, and the end of a run."""

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from bad_input_tables.bad_configurations import FILES, GOOD, changed
from stubs import in_process
from stubs.in_process import ENVIRONMENT
from stubs.workflow_project import is_alive, started, wait_until

ROOT = Path(__file__).parents[2]
SWEEP = [sys.executable, "-m", "microslip", "sweep"]
SNAKEMAKE = [str(Path(sys.executable).with_name("snakemake")), "-s", str(ROOT / "Snakefile")]


# Refused arguments and configurations

GIVEN = "-n --configfile good.yaml"
REFUSED = {
    "": "config.yaml: sweeps.bores: ",
    "--configfile config/config.yaml": "config/config.yaml: sweeps.bores: ",
    "--cores=0": "--cores = 0",
    "-nj0": "--jobs = 0",
    "--no-such-option": "unrecognized arguments: --no-such-option",
    "--cores 1 --configfile": "argument --configfile",
    "al --configfile good.yaml": "TARGET = 'al': did you mean all?",
    "-n --config poisson": "--config = 'poisson'",
    "-n --configfile none.yaml": "--configfile = 'none.yaml'",
    "--configfile made.nc": "--configfile = 'made.nc'",
    f"{GIVEN} fig2": "'fig2': no such file",
    f"{GIVEN} {GIVEN}": "--configfile",
    f"{GIVEN} tabs.yaml": "tabs.yaml: not valid YAML:",
    f"{GIVEN} --config points_per_job=0": "good.yaml, --config: points_per_job: 0 is not allowed",
    f"{GIVEN} --config results=good.yaml": "--config: results: good.yaml is not a folder",
    f"{GIVEN} --directory /proc/x --quiet all": "cannot write to /proc/x/.snakemake: ",
}


@pytest.fixture
def here(monkeypatch, tmp_path):
    """An empty working directory; Snakemake must not start."""
    monkeypatch.chdir(tmp_path)
    # This comes first, since some plugins of Snakemake start a process at import.
    monkeypatch.setattr("snakemake.cli.main", lambda *_: pytest.fail("Snakemake has started"))
    return tmp_path


@pytest.mark.parametrize("arguments", REFUSED)
def test_bad_arguments_are_one_line_before_snakemake_starts(arguments, here):
    (here / "config").mkdir()
    (here / "good.yaml").write_text(GOOD)
    (here / "config" / "config.yaml").write_text(changed({"sweeps.bores": "[-1]"}))
    (here / "tabs.yaml").write_bytes(FILES["tabs"][0])
    (here / "made.nc").write_bytes(b"")
    process = in_process.run("sweep", *arguments.split())
    assert (process.returncode, process.stdout, process.stderr.count("\n")) == (2, "", 1)
    assert process.stderr.startswith("microslip sweep: ")
    assert REFUSED[arguments] in process.stderr


@pytest.mark.parametrize("place", ["the package", "here"])
def test_targets_and_the_name_of_a_configuration_are_handed_to_snakemake(place, here, monkeypatch):
    started = []
    monkeypatch.setattr("snakemake.cli.main", started.append)
    if place == "here":
        (here / "config").mkdir()
        (here / "config" / "extended.yaml").write_text(GOOD)
    in_process.run("sweep", "extended", "-c1")
    option = started[0].index("--configfile")
    folder = here if place == "here" else ROOT
    assert Path(started[0][option + 1]).resolve() == folder / "config" / "extended.yaml"
    assert "extended" not in started[0]
    for target in ("fig2_transverse_map", "bore", "results/bore.nc", "all"):
        in_process.run("sweep", target)
        assert target in started.pop()


def test_a_failure_is_a_line_also_if_snakemake_prints_nothing(here, monkeypatch):
    monkeypatch.setattr("snakemake.cli.main", lambda _: sys.exit(1))
    (here / "given.yaml").write_text(GOOD)
    process = in_process.run("sweep", "--configfile", "given.yaml", "--quiet", "all")
    assert (process.returncode, process.stderr.count("\n")) == (1, 1)
    assert "not finished" in process.stderr


def test_an_interrupt_ends_with_its_exit_code(here, monkeypatch):
    """Snakemake ends its jobs and exits with the code 1."""

    def interrupted(words):
        with contextlib.suppress(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        raise SystemExit(1)

    monkeypatch.setattr("snakemake.cli.main", interrupted)
    (here / "given.yaml").write_text(GOOD)
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        process = in_process.run("sweep", "--configfile", "given.yaml")
    finally:
        signal.signal(signal.SIGINT, handler)
    assert process.returncode == 130
    assert process.stderr.endswith("microslip sweep: interrupted\n")


def test_a_folder_that_is_gone_is_one_line(tmp_path):
    line = f"rmdir {tmp_path}; exec {' '.join(SWEEP)} -n"
    process = subprocess.run(
        ["bash", "-c", line], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True
    )
    assert (process.returncode, process.stdout) == (2, "")
    assert process.stderr == "microslip sweep: the current folder: No such file or directory\n"


# The end of a run

# Two jobs of hours.
SLOW = """
sweeps:
  bore: {motion: bore, velocity: [1e-3, 2e-3], amplitude: [0.5, 0.6], tolerance: 1e-6}
points_per_job: 2
"""


@pytest.mark.long
@pytest.mark.parametrize("command", [SWEEP, SNAKEMAKE], ids=["microslip sweep", "snakemake"])
def test_a_terminal_that_is_closed_ends_all_processes_and_leaves_no_lock(command, tmp_path):
    """A terminal signals the first process of a session, and a shell all of its processes."""
    (tmp_path / "slow.yaml").write_text(SLOW)
    with started(tmp_path, *command, "-c1", "--configfile", "slow.yaml") as process:
        try:
            wait_until(lambda: [*tmp_path.glob("results/logs/bore/*.log")])
            tell = os.killpg if command is SNAKEMAKE else os.kill
            tell(process.pid, signal.SIGHUP)
            wait_until(lambda: process.poll() is not None)
            wait_until(lambda: not is_alive(process.pid))
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 1
    assert not list(tmp_path.glob(".snakemake/locks/*"))
