"""The command ``microslip``, also as ``python -m microslip``.

SIGINT is handled before anything else is imported, so that Ctrl-C prints no traceback.
"""

import gc
import signal
import sys

OBJECTS = 200_000
"""Number of new objects between two garbage collections.  This number exceeds the number of objects
that the imports create.  With Python's default of 700, garbage collection takes a tenth of the run
time of `microslip point`."""


def main() -> int:
    """Run the command in this process and return its exit code, see microslip.app.cli.main."""
    gc.set_threshold(OBJECTS)
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)  # until terminal.run installs its handler
    from microslip.app import terminal

    # Snakemake handles the signals of a sweep
    code = terminal.run(_command, stoppable=sys.argv[1:2] != ["sweep"])
    gc.freeze()  # otherwise the last collection takes as long as the imports
    return code


def _command() -> int:
    from microslip.app import cli

    return cli.main(sys.argv[1:])


if __name__ == "__main__":
    raise SystemExit(main())
