"""The log of a workflow job, and the message if the job fails."""

import gc
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from microslip.foundation.errors import NO_WRITING, CacheError, SolverError
from microslip.foundation.files import advice


class _LogFile(logging.FileHandler):
    """A log file that stores an operating system error as `problem` instead of raising it."""

    problem: OSError | None = None

    def handleError(self, record: logging.LogRecord) -> None:
        # The next message, or closing the file, writes the rest.
        if not isinstance(sys.exc_info()[1], OSError):
            super().handleError(record)

    def close(self) -> None:
        try:
            super().close()
        except OSError as error:
            self.problem = error


@contextmanager
def job_log(path: str | Path, shown: int = logging.WARNING) -> Iterator[logging.Logger]:
    """Context manager for a job.  It yields a logger that writes to the file `path`.

    Messages of at least the level `shown` also go to standard error.  An error ends the process
    with exit code 1.  The log then contains the traceback, or only one line for a CacheError, a
    SolverError or a full disk.
    """
    try:
        file = _LogFile(path, mode="w", encoding="utf-8")
        handlers: list[logging.Handler] = [file, logging.StreamHandler()]
    except OSError as error:
        sys.exit(f"Error: {advice('write', path, error)}")
    log = logging.getLogger("microslip")
    log.setLevel(logging.INFO)
    handlers[1].setLevel(shown)
    for handler in handlers:
        handler.setFormatter(logging.Formatter("%(message)s"))
        log.addHandler(handler)
    failed = True
    try:
        yield log
        failed = False
    except (CacheError, SolverError) as error:
        log.error("Error: %s", error)
    except Exception as error:
        if getattr(error, "errno", None) in NO_WRITING:
            log.error(
                "Error: %s", advice("write", getattr(error, "filename", None) or "a file", error)
            )
        else:
            log.exception("The job failed:")
    finally:
        for handler in handlers:
            log.removeHandler(handler)
            handler.close()
        # The process is about to end: a last garbage collection would take a quarter of a second.
        gc.freeze()
    if failed:
        sys.exit(1)
    # An incomplete log might lack points that did not converge.
    if file.problem is not None:
        sys.exit(f"Error: {advice('write', path, file.problem)}")
