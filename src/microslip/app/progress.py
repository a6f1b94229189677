"""Display of a calculation's elapsed time on standard error."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

FIRST_LINE, BETWEEN_LINES = 2.0, 1.0
"""Seconds until a terminal first shows the elapsed time, and seconds between updates.  Most
calculations end before the time is shown."""
BETWEEN_LINES_OF_A_FILE = 15.0
"""Seconds between two progress lines if standard error is not a terminal."""


@contextmanager
def elapsed_time(title: str) -> Iterator[None]:
    """Context manager that shows a calculation's title and elapsed time on standard error.

    On a terminal, one line is updated.  In a file, a line is added every BETWEEN_LINES_OF_A_FILE
    seconds.
    """
    ended = threading.Event()
    thread = threading.Thread(target=_show, args=[title, ended], daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _show(title: str, ended: threading.Event) -> None:
    form, first, pause = "{}\n", BETWEEN_LINES_OF_A_FILE, BETWEEN_LINES_OF_A_FILE
    if sys.stderr.isatty():
        form, first, pause = "\r{}", FIRST_LINE, BETWEEN_LINES
    start, text = time.monotonic(), ""
    with suppress(OSError, ValueError):  # standard error was closed
        while not ended.wait(pause if text else first):
            text = f"{title}: {time.monotonic() - start:.0f} s"
            sys.stderr.write(form.format(text))
            sys.stderr.flush()
        if text and sys.stderr.isatty():  # the answer replaces the line
            sys.stderr.write(f"\r{' ' * len(text)}\r")
            sys.stderr.flush()
