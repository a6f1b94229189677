"""Run the command line in this process, which saves the start of Python, or in another process."""

import io
import os
import shlex
import subprocess
import sys
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from subprocess import CompletedProcess

import microslip
from microslip.app import cli

SOURCE = str(Path(microslip.__file__).parents[1])
ENVIRONMENT = {**os.environ, "PYTHONPATH": SOURCE}
"""Environment of a process that imports this package."""


def run(*arguments):
    """Result of `microslip` with these arguments, as from subprocess.run."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as end:  # raised by argparse after --help
            code = end.code or 0
    return CompletedProcess(arguments, code, out.getvalue(), err.getvalue())


def options(**settings):
    """Options of a command line with these settings.  None: no such option."""
    given = {name.replace("_", "-"): one for name, one in settings.items() if one is not None}
    return shlex.join(f"--{name}={one}" for name, one in given.items())


def answer(line, code=0, complaints=()):
    """Standard output of a command line with this exit code, and with a line of standard error for
    each complaint, which it contains."""
    process = run(*shlex.split(line))
    assert process.returncode == code, process.stderr
    for message, part in zip(process.stderr.splitlines(), complaints, strict=True):
        assert part in message
    return process.stdout


def run_apart(*words, folder=None, **environment):
    """Result of `microslip` with these arguments in another process, as users run it."""
    return subprocess.run(
        [sys.executable, "-m", "microslip", *map(str, words)],
        cwd=folder,
        env=ENVIRONMENT | environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
