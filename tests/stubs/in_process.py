"""The command line in this process, which saves the start of Python."""

import io
from contextlib import redirect_stderr, redirect_stdout
from subprocess import CompletedProcess

from microslip.app import cli


def run(*arguments):
    """Result of `microslip` with these arguments, as from subprocess.run."""
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err):
        try:
            code = cli.main([str(argument) for argument in arguments])
        except SystemExit as end:  # raised by argparse after --help
            code = end.code or 0
    return CompletedProcess(arguments, code, out.getvalue(), err.getvalue())
