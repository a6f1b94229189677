"""Messages of failed jobs, with and without a writable log."""

import errno
import logging
from pathlib import Path

import pytest

from microslip.app.job_log import job_log
from microslip.foundation.errors import CacheError, SolverError

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


def test_a_log_that_cannot_be_opened_gives_one_line(tmp_path):
    with (
        pytest.raises(SystemExit, match=r"^Error: cannot write .*log: .*make room"),
        job_log(tmp_path / "none" / "log"),
    ):
        pass


ERRORS = [
    (CacheError("cannot write x: No space left on device"), "cannot write x: No space left"),
    (SolverError("every point of this batch failed (6)"), "every point of this batch failed (6)"),
    (OSError(errno.ENOSPC, "full", "kernel.nbi"), "cannot write kernel.nbi: full; make room"),
    (OSError(errno.EROFS, "refused", "kernel.nbi"), "cannot write kernel.nbi: refused; make room"),
]


@pytest.mark.parametrize(("error", "line"), ERRORS, ids=repr)
def test_an_error_that_the_user_can_mend_is_one_line(error, line, tmp_path, capsys):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise error
    message = (tmp_path / "log").read_text()
    assert message.startswith(f"Error: {line}") and message.count("\n") == 1
    assert capsys.readouterr().err == message


def test_any_other_error_goes_to_the_log_in_full(tmp_path):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise FileNotFoundError(errno.ENOENT, "missing")
    assert "Traceback" in (tmp_path / "log").read_text()
