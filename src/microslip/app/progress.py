"""How far all jobs of a run have come: points done, rate and time left, in one line.

Every job adds a byte to a file for each point that it is done with; what the file has grown to is
what has been done, by whichever process and on whichever machine that sees the same folder.
"""

from __future__ import annotations

import atexit
import sys
import threading
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

from tqdm import tqdm

FIRST_LINE, BETWEEN_LINES = 2.0, 1.0
"""Seconds until a terminal first shows the elapsed time, and between updates; most calculations end
sooner."""
BETWEEN_LINES_OF_A_FILE = 15.0
"""Seconds between two lines about progress where standard error is not a terminal."""


def counted(items: Iterable, path: str | Path) -> Iterator:
    """Yield the items; each one that is done with adds a byte to the file `path`.

    What cannot be written is not counted: a full disk is reported where results are stored.
    """
    for item in items:
        yield item
        try:
            with open(path, "ab") as file:
                file.write(b".")
        except OSError:
            pass


class Watch:
    """A line on standard error while a run lasts; `start` and `stop` it."""

    def __init__(self, path: str | Path):
        """path: of the file that jobs add to; it is emptied by `start`."""
        self.path, self.stopped = Path(path), threading.Event()
        self.thread: threading.Thread | None = None

    def start(self, total: int | None) -> None:
        """Begin to show progress.

        total: number of points to do; None: not known yet, so that their number and rate are shown
        without an end; 0: nothing is shown.
        """
        if total == 0:
            return
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self.path.write_bytes(b"")
        except OSError:
            return  # the first job says what is wrong
        atexit.register(self.stop)  # where Snakemake itself fails, nobody else does
        self.thread = threading.Thread(target=self._show, args=[total], daemon=True)
        self.thread.start()

    def stop(self) -> None:
        """Show where things stand, and no more."""
        if self.thread is not None:
            self.stopped.set()
            self.thread.join()

    def done(self) -> int:
        """Number of points done so far."""
        try:
            return self.path.stat().st_size
        except OSError:
            return 0

    def _show(self, total: int | None) -> None:
        # A terminal gets a moving line, a file a line now and then.
        pause = 0.5 if sys.stderr.isatty() else BETWEEN_LINES_OF_A_FILE
        with tqdm(desc="points", total=total, unit="point", mininterval=0.0) as bar:
            while not self.stopped.wait(pause):
                bar.update(self.done() - bar.n)
            bar.update(self.done() - bar.n)


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
