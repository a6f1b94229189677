"""What every job of the workflow has: a log, and one clear message on failure."""

import logging
import sys
from contextlib import contextmanager
from pathlib import Path

from .cache import CacheError


@contextmanager
def job_log(path, shown=logging.WARNING):
    """Context of a job: yields a logger that writes to the file `path`.

    Messages from the level `shown` on go to standard error too. An error goes to the log in full;
    one that the user can mend ends the process with its message alone.
    """
    form = logging.Formatter("%(message)s")
    handlers = [logging.FileHandler(path, mode="w", encoding="utf-8"), logging.StreamHandler()]
    log = logging.getLogger("microslip")
    log.setLevel(logging.INFO)
    handlers[1].setLevel(shown)
    for handler in handlers:
        handler.setFormatter(form)
        log.addHandler(handler)
    try:
        yield log
    except CacheError as error:
        log.error("Error: %s", error)
        sys.exit(1)
    except Exception:
        log.exception("The job failed:")
        sys.exit(1)
    finally:
        for handler in handlers:
            log.removeHandler(handler)
            handler.close()


def closing_lines(folder, names):
    """What the logs of collecting say about datasets: a list of lines; names: of the datasets.

    How many points each has, and which of them did not converge.
    """
    paths = (Path(folder, "logs", "collect", f"{name}.log") for name in names)
    lines = [line for p in paths if p.is_file() for line in p.read_text("utf-8").splitlines()]
    # Damage that was met on the way was a warning, and has been shown.
    return [line for line in lines if not line.startswith("damaged result")]
