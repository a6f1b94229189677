"""``microslip sweep``: the workflow of this package, run by Snakemake in the current folder.

An installed package carries the workflow in its folder `bundle`; in a source tree it lies at the
top. Either gives results that the other finds, since they are named by the solver's sources.
"""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

PACKAGE = Path(__file__).parent

# Arguments that say how many jobs run at once, by themselves or through a profile.
SETS_CORES = re.compile(r"-[cje]|--(cores|jobs|executor|profile|workflow-profile)(=|$)")

HELP = """\
usage: microslip sweep [TARGET ...] [--configfile FILE] [options of Snakemake]

Run the workflow in the current folder: maps of friction over velocity and amplitude, as datasets in
results/ and figures in results/figures/. What is there already is not computed again.

  TARGET             what to make: all (unless said otherwise), accuracy, stability, or a file
  --configfile FILE  what to compute; without it config/config.yaml, or where there is no such file
                     the sweeps of the paper. It takes all names that follow: targets come before it
  --cores N          jobs at the same time; all cores unless said otherwise
  --dry-run          say what there is to do, and do nothing
  --report FILE      after a run: one page (.html or .zip) of figures, captions, what made them
  -h, --help         show this

All else is handed to Snakemake as it is, see snakemake --help, and its exit code comes back. The
defaults are those of profiles/default, here or in the package.

  microslip sweep --cores 2
  microslip sweep --cores 2 --configfile mine.yaml --config points_per_job=10
"""


def main(arguments):
    """Run Snakemake with these arguments (list of str); return its exit code."""
    if {"-h", "--help"} & set(arguments):
        print(HELP, end="")
        return 0
    try:
        command = [sys.executable, "-m", "snakemake", "--snakefile", str(snakefile())]
    except FileNotFoundError as error:
        print(f"microslip sweep: {error}", file=sys.stderr)
        return 2
    if "SNAKEMAKE_PROFILE" not in os.environ and not any(map(SETS_CORES.match, arguments)):
        command += ["--cores", "all"]
    with subprocess.Popen([*command, *arguments]) as running:
        signal.signal(signal.SIGTERM, lambda *_: running.terminate())
        while True:
            try:
                code = running.wait()
                return code if code >= 0 else 128 - code  # as shells say it: 128 + signal
            except KeyboardInterrupt:
                pass  # Snakemake got it too: it tidies up and ends


def snakefile():
    """Path of the workflow that belongs to this package. Raises FileNotFoundError."""
    places = (PACKAGE / "bundle", PACKAGE.parents[1])
    for place in places:
        if (place / "Snakefile").is_file():
            return place / "Snakefile"
    raise FileNotFoundError(f"no Snakefile in {' or '.join(map(str, places))}")
