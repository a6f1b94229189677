"""The elapsed time of a calculation on standard error."""

from __future__ import annotations

import sys
import threading
import time

FIRST_LINE, BETWEEN_LINES = 2.0, 1.0
"""Seconds until a terminal first shows the elapsed time, and between updates; most calculations end
sooner."""
BETWEEN_LINES_OF_A_FILE = 15.0
"""Seconds between two lines about progress where standard error is not a terminal."""


class Elapsed:
    """A context manager that shows the elapsed time on standard error during a calculation.

    A terminal gets one line that is updated, a file a line every BETWEEN_LINES_OF_A_FILE seconds.
    """

    def __init__(self, title: str):
        """title: name of the calculation, before the time."""
        self.title, self.stopped = title, threading.Event()
        self.thread: threading.Thread | None = None

    def __enter__(self) -> Elapsed:
        show = self._change_a_line if sys.stderr.isatty() else self._add_lines
        self.thread = threading.Thread(target=show, args=[time.monotonic()], daemon=True)
        self.thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        if self.thread is not None:
            self.stopped.set()
            self.thread.join()

    def _add_lines(self, started: float) -> None:
        try:
            while not self.stopped.wait(BETWEEN_LINES_OF_A_FILE):
                sys.stderr.write(f"{self.title}: {time.monotonic() - started:.0f} s\n")
                sys.stderr.flush()
        except (OSError, ValueError):  # standard error was closed
            pass

    def _change_a_line(self, started: float) -> None:
        text, pause = "", FIRST_LINE
        try:
            while not self.stopped.wait(pause):
                text = f"{self.title}: {time.monotonic() - started:.0f} s"
                sys.stderr.write(f"\r{text}")
                sys.stderr.flush()
                pause = BETWEEN_LINES
            if text:  # the answer takes the place of the line
                sys.stderr.write(f"\r{' ' * len(text)}\r")
                sys.stderr.flush()
        except OSError:  # the terminal was closed
            pass
