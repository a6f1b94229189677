# The package, before anything else needs it, and how bad input ends a run.

import os
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

# The package of this tree is the one that runs, whether it is installed or not.
SOURCE = Path(str(workflow.current_basedir), "../../src").resolve()
if SOURCE.is_dir():
    sys.path.insert(0, str(SOURCE))
    search = [str(SOURCE), *filter(None, [os.environ.get("PYTHONPATH")])]
    os.environ.update(PYTHONPATH=os.pathsep.join(search))

# Jobs inherit this. Parallel work is many points at a time, one thread each.
os.environ.update(
    dict.fromkeys(
        ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"], "1"
    )
)

from microslip.config import load
from microslip.sweeps import sealed_files


@contextmanager
def refused_in_one_line(origin):
    """Context in which what the user has to mend ends the run with one line, before any job."""
    try:
        yield
    except load.ConfigError as error:
        sys.exit(f"Error in {error}")
    except sealed_files.CacheError as error:
        sys.exit(f"Error in {origin}: results: {error}")


# Snakemake waits for ever with no cores, and begins jobs with less than none.
for option in ("cores", "nodes"):
    count = getattr(workflow.resource_settings, option)
    if workflow.is_main_process and count is not None and count < 1:
        name = {"nodes": "jobs"}.get(option, option)
        sys.exit(f"Error in --{name}: {count} is not allowed; allowed: a whole number >= 1, or all")

# A terminal that is closed ends Snakemake as SIGTERM does: no new jobs, and no lock stays behind.
# Jobs do not inherit this, and end at once.
if workflow.is_main_process and hasattr(signal, "SIGHUP"):
    if signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:  # not so under nohup
        signal.signal(signal.SIGHUP, lambda *_: signal.raise_signal(signal.SIGTERM))
