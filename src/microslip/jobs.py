"""What every job of the workflow has: a log, a line of progress, one clear message on failure."""

import logging
import sys
from contextlib import contextmanager

from tqdm import tqdm

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


def progress(items, title):
    """Yield the items, showing on standard error how many are done, the rate and the time left."""
    # A terminal gets a moving line, a file a line now and then.
    pause = 0.5 if sys.stderr.isatty() else 10
    return tqdm(items, desc=title, unit="point", mininterval=pause, delay=pause, leave=False)
