"""The command ``microslip``, also as ``python -m microslip``.

Takes care of Ctrl-C before anything else is imported, so that as little as can be is left to
Python's own way, a traceback.
"""

import gc
import signal
import sys

OBJECTS = 200_000
"""New objects between two collections of garbage, more than imports make, all of which stay; with
Python's own number of 700 collections take a tenth of the time of `microslip point`."""


def main() -> int:
    """Run this process as the command; returns the exit code, see microslip.app.cli.main."""
    gc.set_threshold(OBJECTS)
    stoppable = sys.argv[1:2] != ["sweep"]  # whose signals are for Snakemake
    asked = signal.getsignal(signal.SIGINT)
    if asked != signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # until there is something better
    from microslip.app import terminal

    if not stoppable:
        signal.signal(signal.SIGINT, asked)
    code = terminal.run(_command, stoppable=stoppable)
    gc.freeze()  # a search of all modules for garbage at the end would take as long as their import
    return code


def _command() -> int:
    from microslip.app import cli

    return cli.main(sys.argv[1:])


if __name__ == "__main__":
    raise SystemExit(main())
