"""What a job says when it fails, also where its log cannot be written."""

import errno
import logging
import os
import subprocess
import sys
import textwrap
import traceback
from pathlib import Path

import pytest

from microslip.app.job_log import job_log, plain_words
from microslip.foundation.errors import SolverError
from microslip.foundation.files import CacheError

FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="no device that is always full")


@pytest.fixture(autouse=True)
def quiet_afterwards():
    level = logging.getLogger("microslip").level
    yield
    logging.getLogger("microslip").setLevel(level)


def test_a_job_that_is_done_leaves_its_log(tmp_path, capsys):
    with job_log(tmp_path / "log") as log:
        log.info("4 points")
    assert (tmp_path / "log").read_text() == "4 points\n"
    assert capsys.readouterr().err == ""


@needs_full
def test_a_log_on_a_full_disk_fails_the_job_with_one_line():
    with pytest.raises(SystemExit) as caught, job_log(FULL) as log:
        log.info("4 points")
    assert str(caught.value).startswith("Error: cannot write /dev/full: No space left on device;")


@needs_full
def test_a_job_that_fails_on_a_full_disk_says_one_line(capsys):
    with pytest.raises(SystemExit), job_log(FULL):
        raise CacheError("cannot write x: No space left on device")
    assert capsys.readouterr().err == "Error: cannot write x: No space left on device\n"


def test_a_batch_in_which_every_point_failed_is_one_line(tmp_path, capsys):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise SolverError("every point of this batch failed (6)")
    assert capsys.readouterr().err == "Error: every point of this batch failed (6)\n"


def test_a_log_that_cannot_be_opened_gives_one_line(tmp_path):
    with (
        pytest.raises(SystemExit, match=r"^Error: cannot write .*log: .*make room"),
        job_log(tmp_path / "none" / "log"),
    ):
        pass


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EROFS])
def test_what_the_system_refuses_needs_no_traceback(number, tmp_path, capsys):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise OSError(number, "refused", "kernel.nbi")
    said = (tmp_path / "log").read_text()
    assert said.startswith("Error: cannot write kernel.nbi: refused; make room")
    assert capsys.readouterr().err == said


def test_any_other_error_goes_to_the_log_in_full(tmp_path):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise FileNotFoundError(errno.ENOENT, "missing")
    assert "Traceback" in (tmp_path / "log").read_text()


def logged(message):
    record = logging.LogRecord("snakemake", logging.ERROR, "", 0, message, None, None)
    assert plain_words("results")(record)
    return record.getMessage()


@pytest.mark.parametrize("path", [["results/logs/x.log"], []])
def test_snakemakes_own_trouble_with_a_disk_is_said_plainly(path):
    try:
        raise OSError(errno.EROFS, "Read-only file system", *path)
    except OSError as error:
        said = "\n".join(traceback.format_exception(error))
    where = path[0] if path else "results"
    assert logged(said).startswith(f"Error: cannot write {where}: Read-only file system; make room")


@pytest.mark.parametrize(
    "message",
    [
        "4 of 9 steps (100%) done",
        "OSError: [Errno 28] No space left on device: 'x'",  # says it itself
        "Traceback\nFileNotFoundError: [Errno 2] No such file or directory: 'x'\n",
    ],
)
def test_what_else_snakemake_says_is_left_alone(message):
    assert logged(message) == message


def test_the_line_of_progress_ends_with_the_process(tmp_path):
    program = f"""
        from microslip.app.progress import Watch
        Watch({str(tmp_path / "counter")!r}).start(3)
        raise SystemExit("no more")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)],
        env={"PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
    )
    assert "0/3" in done.stderr
    assert done.stderr.endswith("\n")
