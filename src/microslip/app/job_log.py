"""The log of a job of the workflow, and one clear message on failure."""

import gc
import logging
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from microslip.foundation.errors import NO_WRITING, CacheError, SolverError
from microslip.foundation.files import advice


class _LogFile(logging.FileHandler):
    """A log that keeps what the system has against writing it, and raises nothing."""

    problem: OSError | None = None

    def handleError(self, record: logging.LogRecord) -> None:
        # What could not be written is tried again with the next message, and on closing.
        if not isinstance(sys.exc_info()[1], OSError):
            super().handleError(record)

    def close(self) -> None:
        try:
            super().close()
        except OSError as error:
            self.problem = error


@contextmanager
def job_log(path: str | Path, shown: int = logging.WARNING) -> Iterator[logging.Logger]:
    """Context of a job: yields a logger that writes to the file `path`.

    Messages from the level `shown` on go to standard error too. An error goes to the log in full;
    one that the user can mend ends the process with its message alone.
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
        # The process is about to end: searching all that its libraries made for garbage once more
        # would take it a quarter of a second.
        gc.freeze()
    if failed:
        sys.exit(1)
    # A log that is cut short would leave out points that did not converge.
    if file.problem is not None:
        sys.exit(f"Error: {advice('write', path, file.problem)}")
