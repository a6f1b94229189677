"""The end of a command: Ctrl-C, closed pipes, full devices, closed streams."""

import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from stubs.in_process import ENVIRONMENT

COMMAND = [sys.executable, "-m", "microslip"]
INTERRUPTED = (130, "", "microslip: interrupted\n")
pytestmark = pytest.mark.skipif(os.name != "posix", reason="signals and devices of POSIX")


def shell(line, **changes):
    """Run a line of bash, in which $M is the command; return the result of subprocess."""
    return subprocess.run(
        ["bash", "-c", line],
        env={**ENVIRONMENT, "M": " ".join(COMMAND), **changes},
        capture_output=True,
        text=True,
        timeout=120,
    )


# Ctrl-C


def stopped(command, ready, number=signal.SIGINT):
    """Exit code, output and errors of a process that receives a signal once it is ready.

    ready: function of the process. A process that runs for another minute is killed.
    """
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    with subprocess.Popen(command, env=ENVIRONMENT, **options) as process:
        try:
            while process.poll() is None and not ready(process):
                time.sleep(0.02)
            process.send_signal(number)
            out, errors = process.communicate(timeout=60)
        finally:
            with contextlib.suppress(ProcessLookupError):
                process.kill()
    return process.returncode, out, errors


def loaded(part):
    """True once the process has loaded a library, according to /proc."""

    def ready(process):
        with contextlib.suppress(OSError):
            return part in Path(f"/proc/{process.pid}/maps").read_text()
        return True

    return ready


HARD = "point bore --velocity 1e-3 --amplitude 0.5 --tolerance 1e-5"


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="needs Linux")
@pytest.mark.parametrize("moment", ["_multiarray_umath", "llvmlite"])
def test_an_interrupt_is_one_line_also_while_the_solver_is_loaded(moment):
    assert stopped([*COMMAND, *HARD.split()], loaded(moment)) == INTERRUPTED


# Compiled code that releases the GIL and runs no Python handler, like a long kernel.
KERNEL = """
import hashlib, signal, sys
from microslip.app import terminal
from microslip.foundation import files

signal.signal(signal.SIGHUP, signal.SIG_DFL)  # ignored in what nohup starts

def command():
    with files.writing_beside(sys.argv[1]) as beside:
        beside.write_text("half")
        hashlib.pbkdf2_hmac("sha256", b"", b"", 2**31 - 1)

terminal.run(command)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("number", "code", "word"),
    [
        (signal.SIGINT, 130, "interrupted"),
        (signal.SIGTERM, 143, "terminated"),
        (signal.SIGHUP, 129, "terminal closed"),
    ],
)
def test_a_signal_ends_a_kernel_and_leaves_no_file_half_written(number, code, word, tmp_path):
    command = [sys.executable, "-c", KERNEL, str(tmp_path / "point.json")]
    result = stopped(command, lambda _: list(tmp_path.iterdir()), number)
    assert result == (code, "", f"microslip: {word}\n")
    assert list(tmp_path.iterdir()) == []


# Pipes, devices and streams

FULL = "microslip: cannot write to standard output: No space left on device\n"
CLOSED = "microslip: cannot write to standard output: it is closed\n"
BAD = "microslip point: --nu = "
ANSWER = "$M point continuous-bore --velocity 1"

# A line of bash, its exit code (of the first command of a pipe), and its standard error.
ENDINGS = [
    (f"PYTHONUNBUFFERED=1 {ANSWER} --json | true", 141, ""),
    (f"{ANSWER} > /dev/full", 74, FULL),
    (f"{ANSWER} >&-", 74, CLOSED),
    (f"{ANSWER} --nu 7 >&-", 2, f"{BAD}'7': allowed is a finite number of at least 0"),
    (f"{ANSWER} <&- >&- 2>&-", 74, ""),
    (f"PYTHONIOENCODING=ascii {ANSWER} --nu \N{ARABIC-INDIC DIGIT THREE}", 2, rf"{BAD}'\u0663'"),
    (f"{ANSWER} --nu $'1\\e[31m'", 2, rf"{BAD}'1\x1b[31m': allowed is a number"),
]


@pytest.mark.slow
@pytest.mark.parametrize(("line", "code", "message"), ENDINGS)
def test_a_stream_that_is_closed_or_full_is_one_line_at_most(line, code, message):
    process = shell(f"{line}; exit ${{PIPESTATUS[0]}}")
    assert (process.returncode, process.stdout) == (code, "")
    assert process.stderr.startswith(message) and process.stderr.count("\n") == bool(message)


@pytest.mark.slow
def test_an_answer_needs_no_more_than_its_output(tmp_path):
    (tmp_path / "gone").mkdir()
    bare = "TERM= COLUMNS=wide LC_ALL=C PYTHONIOENCODING=ascii env -u HOME"
    for line in (f"{ANSWER} <&- 2>&-", f"cd $FOLDER && rmdir ../gone && {bare} {ANSWER}"):
        process = shell(line, FOLDER=str(tmp_path / "gone"))
        assert (process.returncode, process.stderr) == (0, "")
        assert process.stdout.startswith("mu_macro = 0.883573\n")  # Eq 21 at 1: 0.88357
