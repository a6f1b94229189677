"""Messages of failed jobs, with and without a writable log."""

import errno
import logging
import signal
from contextlib import suppress
from pathlib import Path

import pytest

from microslip.app.job_log import end_job, job_log
from microslip.foundation.errors import CacheError, SolverError
from microslip.foundation.files import writing_beside

FULL = Path("/dev/full")


@pytest.fixture(autouse=True)
def quiet_afterwards():
    yield
    logging.getLogger("microslip").setLevel(logging.NOTSET)


def test_a_job_that_is_done_leaves_its_log(tmp_path, capsys):
    with job_log(tmp_path / "log") as log:
        log.info("4 points")
    assert (tmp_path / "log").read_text() == "4 points\n"
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("path", [FULL, Path("/none/log")])
def test_a_log_that_cannot_be_written_fails_the_job_with_one_line(path):
    if path == FULL and not FULL.exists():
        pytest.skip("no device that is always full")
    with pytest.raises(SystemExit) as caught, job_log(path) as log:
        log.info("4 points")
    assert str(caught.value).startswith(f"Error: cannot write {path}: ")


ERRORS = [
    (SolverError("every point of this batch failed (6)"), "every point of this batch failed (6)"),
    (CacheError("cannot write x: No space left on device"), "cannot write x: No space left"),
    (OSError(errno.EROFS, "refused", "kernel.nbi"), "cannot write kernel.nbi: refused; make room"),
    (FileNotFoundError(errno.ENOENT, "missing"), "Traceback"),
]


@pytest.mark.parametrize(("error", "line"), ERRORS, ids=repr)
def test_an_error_that_the_user_can_mend_is_one_line_and_any_other_a_traceback(
    error, line, tmp_path, capsys
):
    with pytest.raises(SystemExit), job_log(tmp_path / "log"):
        raise error
    message = (tmp_path / "log").read_text()
    assert line in message and capsys.readouterr().err == message
    assert (message.startswith("Error: ") and message.count("\n") == 1) == (line != "Traceback")


def test_an_interrupt_ends_a_job_and_removes_its_partial_file(tmp_path, monkeypatch):
    ended = []
    monkeypatch.setattr("os._exit", lambda code: ended.append((code, *tmp_path.iterdir())))
    with suppress(CacheError), writing_beside(tmp_path / "batch") as part:
        part.write_text("incomplete")
        end_job(signal.SIGINT, None)
    assert ended == [(130,)]
