"""Python programs in a process of their own."""

import os
import subprocess
import sys
from pathlib import Path

import microslip

PACKAGE = Path(microslip.__file__).parent


def run(program, *arguments, package=PACKAGE, **environment):
    """Result of a program with a copy of the package, as from subprocess.run."""
    return subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        env=os.environ | {"PYTHONPATH": str(package.parent)} | environment,
        capture_output=True,
        text=True,
        timeout=300,
    )


def output(program, *arguments, **options):
    """Standard output of a program that succeeds."""
    process = run(program, *arguments, **options)
    assert process.returncode == 0, process.stderr
    return process.stdout
