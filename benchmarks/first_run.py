"""Measure the time of the workflow's first run, without compiled code or stored results.

    python benchmarks/first_run.py [--cores N] [--markdown FILE]

Runs the default configuration in an empty folder with an empty cache of compiled code.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import tables

from microslip.foundation import machine

ROOT = Path(__file__).parents[1]
STEPS = ("compile, solve all points, collect and draw", "second run: nothing to do")


def row(step, folder, cores):
    """Run the workflow and return one row of the table."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(folder / "compiled")}
    environment["PYTHONPATH"] = str(ROOT / "src")
    command = [sys.executable, "-m", "microslip", "sweep", "--cores", str(cores)]
    before, begun = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.DEVNULL)
    wall, after = time.perf_counter() - begun, resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return {"step": step, "wall clock, s": f"{wall:.0f}", "CPU time, s": f"{seconds:.0f}"}


def main():
    parser = tables.parser_of(__doc__)
    parser.add_argument("--cores", type=int, default=2)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as place:
        rows = [row(step, Path(place), options.cores) for step in STEPS]
    load = f"a mean load of {os.getloadavg()[2]:.1f} on {os.cpu_count()} cores"
    note = f"Two runs with {options.cores} jobs at a time on {machine.cpu_model()}, at {load}."
    tables.publish(f"{tables.markdown(rows)}\n\n{note}\n", options)


if __name__ == "__main__":
    main()
