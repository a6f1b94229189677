"""How a command ends in a shell: Ctrl-C, a closed pipe, a full device, streams that were closed.

Imports nothing heavy, so that hardly any time goes by before Ctrl-C is taken care of.
"""

from __future__ import annotations

import io
import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, NoReturn

CANNOT_WRITE = 74
"""Exit code where the answer could not be written: EX_IOERR of the BSD's sysexits.h."""
CLOSED_PIPE = 141
"""Exit code where nobody reads the answer any more: as of a program that SIGPIPE ends."""
OF_SIGNAL = 128
"""Shells add the number of a signal to this for the exit code of the program that it ended."""

STOPPED_BY = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "terminal closed"}
GRACE = 0.4
"""Seconds in which Python's own way to stop may remove what is half written."""


def run(command: Callable[[], int], *, stoppable: bool = True) -> int:
    """Run a command as the whole of this process.

    Parameters
    ----------
    command
        Prints its answer to `sys.stdout` and returns an exit code, or raises SystemExit with it.
    stoppable
        Whether signals end it; a command that leaves them to a process of its own says no.

    Returns
    -------
    int
        The exit code.  Where a signal ends the command, this function does not return.
    """
    _open_closed_streams()
    stop = _Stop() if stoppable else None
    try:
        code = _code_of(command)
        if stop and stop.signal:  # what raised KeyboardInterrupt was caught on its way
            stop.end()
    except BaseException:
        if stop and stop.signal:  # KeyboardInterrupt, or what a library makes of it
            stop.end()
        raise
    if stop:
        stop.ignore()
    return _written(code)


def complain(text: str) -> None:
    """Write one line to standard error, if anybody listens there."""
    try:
        sys.stderr.write(" ".join(text.split()) + "\n")
        sys.stderr.flush()
    except OSError:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 - it stays open until the end


def _code_of(command: Callable[[], int]) -> int:
    try:
        return command()
    except SystemExit as error:  # how argparse ends
        return error.code if isinstance(error.code, int) else int(error.code is not None)


# Streams


def _open_closed_streams() -> None:
    """Give this process the three streams, whichever of them it was started without.

    A file opened later would otherwise get their place, and be written to as if it were a stream.
    The answer is kept until it is whole: half of one is no use to anybody, and a device that is
    full is noticed at the one place that writes.
    """
    missing = sys.stdout is None
    for number, mode in ((0, os.O_RDONLY), (1, os.O_WRONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            null = os.open(os.devnull, mode)
            if null != number:
                os.dup2(null, number)
                os.close(null)
    if sys.stderr is None:
        sys.stderr = open(2, "w", errors="backslashreplace", closefd=False)  # noqa: SIM115
    encoding = "utf-8" if missing else sys.stdout.encoding
    kept: Any = io.TextIOWrapper(
        io.BytesIO(), encoding, errors="backslashreplace", write_through=True
    )
    kept.lost = missing
    sys.stdout = kept


def _written(code: int) -> int:
    """Write the answer; returns the exit code, changed where it could not be written."""
    kept: Any = sys.stdout  # as _open_closed_streams makes it
    answer = kept.buffer.getvalue()
    if not answer:
        return code
    try:
        if kept.lost:
            raise OSError(None, "it is closed")
        while answer:
            answer = answer[os.write(1, answer) :]
    except BrokenPipeError:
        return CLOSED_PIPE
    except OSError as error:
        complain(f"microslip: cannot write to standard output: {error.strerror}")
        return CANNOT_WRITE
    return code


# Signals


class _Stop:
    """Ends this process within about half a second of a signal.

    Python handles a signal between two steps of its own code, and a compiled kernel is one step,
    be it a minute long.  So beside the exception that Python raises, which lets files that are
    half written be removed, a thread of its own hears of the signal at once: kernels hold no lock
    that it has to wait for.

    Attributes
    ----------
    signal : signal.Signals or None
        What ended the command; None until then.
    """

    def __init__(self) -> None:
        self.signal: signal.Signals | None = None
        self._ending = threading.Lock()
        heard, told = socket.socketpair()  # not a pipe, which Windows does not take here
        told.setblocking(False)
        signal.set_wakeup_fd(told.fileno(), warn_on_full_buffer=False)
        self._sockets = heard, told
        self._numbers = [
            getattr(signal, name)
            for name in STOPPED_BY
            if hasattr(signal, name)
            and signal.getsignal(getattr(signal, name)) != signal.SIG_IGN  # as nohup asks for
        ]
        threading.Thread(target=self._listen, args=(heard,), daemon=True).start()
        sys.unraisablehook = self._unraisable
        for number in self._numbers:
            signal.signal(number, self._interrupt)

    def _interrupt(self, number: int, frame: object) -> None:
        """Signal handler, which Python calls in the main thread as soon as it can."""
        if self.signal is None:  # a second one would end the tidying up
            self.signal = signal.Signals(number)
            raise KeyboardInterrupt

    def _listen(self, heard: socket.socket) -> None:
        number = 0
        while number not in self._numbers:
            (number,) = heard.recv(1)
        time.sleep(GRACE)
        self.signal = self.signal or signal.Signals(number)
        self.end()

    def _unraisable(self, problem: sys.UnraisableHookArgs) -> None:
        if self.signal is None:
            sys.__unraisablehook__(problem)

    def end(self) -> NoReturn:
        """End this process with one line and the exit code of the signal."""
        ended = self.signal
        assert ended is not None  # as whoever calls this has seen
        self._ending.acquire()  # for good: one of the two threads says it
        try:
            own_line = "\n" if sys.stderr.isatty() else ""  # after ^C, or a line of progress
            os.write(2, f"{own_line}microslip: {STOPPED_BY[ended.name]}\n".encode())
        finally:
            os._exit(OF_SIGNAL + ended)

    def ignore(self) -> None:
        """From now on signals change nothing: the answer is there."""
        for number in self._numbers:
            signal.signal(number, signal.SIG_IGN)
        signal.set_wakeup_fd(-1)
