"""The log of a job of the workflow, and one clear message on failure."""

import errno
import gc
import logging
import re
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from microslip.foundation.errors import SolverError
from microslip.sweeps.sealed_files import NO_WRITING, CacheError, advice


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


REFUSED = re.compile(r"^\w+: \[Errno (\d+)\] ([^:\n]+)(?:: '(.+)')?\s*\Z", re.MULTILINE)


def plain_words(folder: str | Path) -> Callable[[logging.LogRecord], bool]:
    """Filter for Snakemake's log: where the system refuses Snakemake itself, what to do about it.

    It comes in the place of a traceback. folder: named where the system names no file.
    """

    def say_plainly(record: logging.LogRecord) -> bool:
        refused = REFUSED.search(str(record.msg))
        if refused and "Traceback" in record.msg and int(refused[1]) in (*NO_WRITING, errno.EACCES):
            error = OSError(int(refused[1]), refused[2])
            record.msg = f"Error: {advice('write', refused[3] or folder, error)}"
        return True

    return say_plainly


def closing_lines(folder: str | Path, names: Iterable[str]) -> list[str]:
    """Lines about datasets from the logs of collecting them; names: those of the datasets.

    The lines give the number of points of each, and the points that did not converge.
    """
    paths = (Path(folder, "logs", "collect", f"{name}.log") for name in names)
    lines = [line for p in paths if p.is_file() for line in p.read_text("utf-8").splitlines()]
    # Damage that was met on the way was a warning, and has been shown.
    return [line for line in lines if not line.startswith("damaged result")]
