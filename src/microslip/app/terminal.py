"""Handle Ctrl-C, closed pipes, full devices and closed streams when a command ends.

This module imports only fast modules, so that Ctrl-C works from the start.
"""

from __future__ import annotations

import io
import os
import signal
import sys
import threading
from collections.abc import Callable
from typing import Any, NoReturn

from microslip.foundation import files

CANNOT_WRITE = 74
"""Exit code if the output cannot be written: EX_IOERR of sysexits.h."""
CLOSED_PIPE = 141
"""Exit code if the program that reads the output has ended.  A program ended by SIGPIPE has the
same code."""
STOPPED_BY = {"SIGINT": "interrupted", "SIGTERM": "terminated", "SIGHUP": "terminal closed"}
STACK = 2**24
"""Size of a thread's stack in bytes, 16 MB.  On some systems, the default stack is too small for
the compiler of the kernels."""
WAIT = 0.1
"""Longest wait in seconds before pending signals are handled.  Windows handles no signals during a
wait."""


def run(command: Callable[[], int], *, stoppable: bool = True) -> int:
    """Run a command as the main function of this process.

    Parameters
    ----------
    command
        Function that prints to `sys.stdout`.  It returns an exit code, or raises SystemExit with
        the exit code.
    stoppable
        If True, signals end the command.  If False, the command replaces the handler of SIGINT.

    Returns
    -------
    int
        The exit code.  This function does not return if a signal ends the command.
    """
    _open_closed_streams()
    if not stoppable:
        if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
            signal.signal(signal.SIGINT, _end)
        return _written(_code_of(command))
    numbers = [getattr(signal, name) for name in STOPPED_BY if hasattr(signal, name)]
    numbers = [n for n in numbers if signal.getsignal(n) != signal.SIG_IGN]  # set by nohup
    for number in numbers:
        signal.signal(number, _end)
    code = _code_in_thread(command)
    for number in numbers:  # the output is complete
        signal.signal(number, signal.SIG_IGN)
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
    except SystemExit as error:  # from argparse, or with a message from the rules of the workflow
        if isinstance(error.code, str):
            complain(error.code)
        return error.code if isinstance(error.code, int) else int(error.code is not None)


# Streams


def _open_closed_streams() -> None:
    """Open the standard streams that are closed, and buffer standard output until the end.

    If a stream stays closed, a file that is opened later gets the number of the stream.  The output
    of the stream is then written to this file.  Because of the buffer, standard output is either
    complete or missing.  Only the function `_written`, which writes the buffer, has to handle a
    full device.
    """
    missing = sys.stdout is None
    while (number := os.open(os.devnull, os.O_RDWR)) < 3:
        pass  # the lowest number that is free
    os.close(number)
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


def _code_in_thread(command: Callable[[], int]) -> int:
    """Run a command in another thread.

    Python handles signals in the main thread, between two bytecode instructions.  For Python, the
    call of a compiled kernel is a single instruction.  The call may take a minute, but does not
    block other threads.
    """
    threading.stack_size(STACK)
    codes: list[int] = []
    thread = threading.Thread(target=lambda: codes.append(_code_of(command)))
    thread.start()
    while thread.is_alive():
        thread.join(WAIT)
    return codes[0] if codes else 1  # after an error with a traceback


def _end(number: int, frame: object) -> NoReturn:
    """Signal handler that removes partial files, prints one line and ends this process."""
    signal.signal(number, signal.SIG_IGN)
    try:
        files.remove_partial()
        own_line = "\n" if sys.stderr.isatty() else ""  # after ^C, or after a progress line
        os.write(2, f"{own_line}microslip: {STOPPED_BY[signal.Signals(number).name]}\n".encode())
    finally:
        os._exit(128 + number)  # as shells report a program that a signal has ended
