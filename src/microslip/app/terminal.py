"""Handling of Ctrl-C, closed pipes, full devices and closed streams when a command ends.

The module imports nothing slow, so that Ctrl-C works from the start.
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
"""Exit code if the output cannot be written: EX_IOERR of sysexits.h."""
CLOSED_PIPE = 141
"""Exit code if the program that reads the output has ended.  A program ended by SIGPIPE has the
same code."""
OF_SIGNAL = 128
"""Offset of the exit code: a program that is ended by signal n returns this number plus n."""

STOPPED_BY = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "terminal closed"}
GRACE = 0.4
"""Time limit in seconds for Python to stop by itself and to remove partial files."""


def run(command: Callable[[], int], *, stoppable: bool = True) -> int:
    """Run a command as the main function of this process.

    Parameters
    ----------
    command
        Function that prints to `sys.stdout`.  It returns an exit code, or raises SystemExit with
        the exit code.
    stoppable
        True to end the command on signals; False for a command that handles signals itself.

    Returns
    -------
    int
        The exit code.  This function does not return if a signal ends the command.
    """
    _open_closed_streams()
    stop = _Stop() if stoppable else None
    try:
        code = _code_of(command)
        if stop and stop.signal:  # the command has caught KeyboardInterrupt
            stop.end()
    except BaseException:
        if stop and stop.signal:  # KeyboardInterrupt, or the error of a library after it
            stop.end()
        raise
    if stop:
        stop.ignore()
    return _written(code)


def complain(text: str) -> None:
    """Write one line to standard error, unless standard error is closed."""
    try:
        sys.stderr.write(" ".join(text.split()) + "\n")
        sys.stderr.flush()
    except OSError:
        sys.stderr = open(os.devnull, "w")  # noqa: SIM115 - it stays open until the end


def _code_of(command: Callable[[], int]) -> int:
    try:
        return command()
    except SystemExit as error:  # from argparse
        return error.code if isinstance(error.code, int) else int(error.code is not None)


# Streams


def _open_closed_streams() -> None:
    """Open the standard streams that are closed, and buffer standard output until the end.

    Otherwise a file that is opened later would get the number of a closed stream and receive its
    output.  With the buffer, the output is complete or missing, and only `_written` has to handle a
    full device.
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
    buffered: Any = io.TextIOWrapper(
        io.BytesIO(), encoding, errors="backslashreplace", write_through=True
    )
    buffered.closed_before = missing
    sys.stdout = buffered


def _written(code: int) -> int:
    """Write the buffered output.  Returns `code`, or another exit code if writing fails."""
    buffered: Any = sys.stdout  # set by _open_closed_streams
    output = buffered.buffer.getvalue()
    if not output:
        return code
    try:
        if buffered.closed_before:
            raise OSError(None, "it is closed")
        while output:
            output = output[os.write(1, output) :]
    except BrokenPipeError:
        return CLOSED_PIPE
    except OSError as error:
        complain(f"microslip: cannot write to standard output: {error.strerror}")
        return CANNOT_WRITE
    return code


# Signals


class _Stop:
    """End this process within about half a second of a signal.

    Python handles a signal between two bytecode instructions, and a compiled kernel is one
    instruction, which may take a minute.  Kernels do not block other threads.  So another thread
    also receives the signal, and ends the process after GRACE seconds.  Before that, a
    KeyboardInterrupt in the main thread can remove partial files.

    Attributes
    ----------
    signal : signal.Signals or None
        The first signal; None before the first signal.
    """

    def __init__(self) -> None:
        self.signal: signal.Signals | None = None
        self._ending = threading.Lock()
        reader, writer = socket.socketpair()  # Windows does not allow a pipe here
        writer.setblocking(False)
        signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
        self._sockets = reader, writer
        self._numbers = [
            getattr(signal, name)
            for name in STOPPED_BY
            if hasattr(signal, name)
            and signal.getsignal(getattr(signal, name)) != signal.SIG_IGN  # set by nohup
        ]
        threading.Thread(target=self._listen, args=(reader,), daemon=True).start()
        sys.unraisablehook = self._unraisable
        for number in self._numbers:
            signal.signal(number, self._interrupt)

    def _interrupt(self, number: int, frame: object) -> None:
        """Signal handler in the main thread."""
        if self.signal is None:  # a second exception would interrupt the removal of files
            self.signal = signal.Signals(number)
            raise KeyboardInterrupt

    def _listen(self, reader: socket.socket) -> None:
        number = 0
        while number not in self._numbers:
            (number,) = reader.recv(1)
        time.sleep(GRACE)
        self.signal = self.signal or signal.Signals(number)
        self.end()

    def _unraisable(self, problem: sys.UnraisableHookArgs) -> None:
        if self.signal is None:
            sys.__unraisablehook__(problem)

    def end(self) -> NoReturn:
        """Print one line and end this process with the exit code of the signal."""
        ended = self.signal
        assert ended is not None
        self._ending.acquire()  # never released, so that only one of the two threads continues
        try:
            own_line = "\n" if sys.stderr.isatty() else ""  # after ^C, or a line of progress
            os.write(2, f"{own_line}microslip: {STOPPED_BY[ended.name]}\n".encode())
        finally:
            os._exit(OF_SIGNAL + ended)

    def ignore(self) -> None:
        """Ignore signals from now on, since the output is complete."""
        for number in self._numbers:
            signal.signal(number, signal.SIG_IGN)
        signal.set_wakeup_fd(-1)
