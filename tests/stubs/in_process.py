"""The command line without a process of its own, which takes a second or two to start."""

import io
from contextlib import redirect_stderr, redirect_stdout
from subprocess import CompletedProcess

from microslip.app import cli


def run(*arguments):
    """What `microslip` does with these arguments, as subprocess.run tells it."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as end:  # of argparse, after help
            code = end.code or 0
    return CompletedProcess(arguments, code, out.getvalue(), err.getvalue())
