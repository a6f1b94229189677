"""Log files, error messages and interrupts of the jobs of the workflow."""

import gc
import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NoReturn

from microslip.foundation.errors import NO_WRITING, CacheError, SolverError
from microslip.foundation.files import advice, remove_partial
from microslip.foundation.named_files import problem_in_code


@contextmanager
def job_log(path: str | Path, shown: int = logging.WARNING) -> Iterator[logging.Logger]:
    """Context manager that yields a logger for a job.  The logger writes to the file `path`.

    Messages at or above the level `shown` are also printed on standard error.  An error ends the
    process with exit code 1.  The log then contains the traceback.  For a CacheError, a
    SolverError, an error in a user's Python file or a full disk, the log contains only one line.
    """
    try:
        file = logging.FileHandler(path, "w", "utf-8")
    except OSError as error:
        sys.exit(f"Error: {advice('write', path, error)}")
    log = logging.getLogger("microslip")
    log.setLevel(logging.INFO)
    logging.raiseExceptions = False  # errors of a full disk are handled below
    screen = logging.StreamHandler()
    screen.setLevel(shown)
    for handler in (file, screen):
        log.addHandler(handler)
    code: str | int = 1
    try:
        yield log
        code = 0
    except Exception as error:
        is_plain = isinstance(error, CacheError | SolverError)
        problem = str(error) if is_plain else problem_in_code(error)
        if getattr(error, "errno", None) in NO_WRITING:
            problem = advice("write", getattr(error, "filename", None) or "a file", error)
        if problem:
            log.error("Error: %s", problem)
        else:
            log.exception("The job failed:")
    finally:
        for handler in (file, screen):
            log.removeHandler(handler)
        try:
            file.close()
        except OSError as error:  # an incomplete log might lack points that did not converge
            code = code or f"Error: {advice('write', path, error)}"
        # The process is about to end: a last garbage collection would take a quarter of a second.
        gc.freeze()
    if code:
        sys.exit(code)


def end_job(number: int, frame: object) -> NoReturn:
    """Signal handler that removes partial files and ends this process without a message.

    Without this handler, a KeyboardInterrupt would print a long traceback.  Moreover, a pool of
    processes would end only after all its points are computed.
    """
    remove_partial()
    os._exit(128 + number)
