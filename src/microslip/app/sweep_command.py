"""`microslip sweep`: the workflow of this package, run by Snakemake in the current folder.

An installed package carries the workflow in its folder `bundle`; in a source tree it lies at the
top. Either gives results that the other finds, since they are named by the solver's sources.
"""

import os
import re
import signal
import subprocess
import sys
from pathlib import Path

from microslip.app.terminal import complain

PACKAGE = Path(__file__).parents[1]

# Arguments that say how many jobs run at once, by themselves or through a profile.
SETS_CORES = re.compile(r"-[cje]|--(cores|jobs|executor|profile|workflow-profile)(=|$)")

TARGETS = {
    "all": "the datasets and figures of the configuration's sweeps (unless said otherwise)",
    "extended": "the same of other motions and pressures, its key extended",
    "drives": "datasets of contacts that a force or a spring pulls, its key drives",
    "certified": "maps with an error that holds everywhere, of the sweeps that say adaptive",
    "accuracy": "what accuracy costs, for all models and methods",
    "stability": "where methods fail",
    "claims": "what the paper says, judged",
    "propulsion": "what self-propelled motions pull with, from stall to no load",
    "explorer": "one page that shows what is behind every point of the maps",
    "explorer_all": "the same page with every other sweep of the configuration",
}
"""Targets by name: the rules of the workflow without wildcards that users need."""
RULES = ("warm_up", "warm_up_angles", "warm_up_pulled")
"""Others that Snakemake makes by name."""

_LISTED = "\n".join(f"    {name:<14}{text}" for name, text in TARGETS.items())
HELP = f"""\
usage: microslip sweep [TARGET ...] [--configfile FILE] [options of Snakemake]

Run the workflow in the current folder: maps of friction over velocity and amplitude, as datasets in
results/ and figures in results/figures/. What is there already is not computed again. The sweeps
of the paper are transverse, bore (spin: rotation about the contact normal) and continuous_bore.

  TARGET             what to make, by name or a file such as results/bore.nc:
{_LISTED}
    fig1 ... fig6   one figure of the paper with its datasets; other figures by their names, such as
                    stability_atlas
  --configfile FILE  what to compute; without it config/config.yaml, or where there is no such file
                     the sweeps of the paper. It takes all names that follow: targets come before it
  --cores N          jobs at the same time, 1 or more; all cores unless said otherwise
  --dry-run          say what there is to do, and do nothing
  --report FILE      after a run: one page (.html or .zip) of figures, captions, what made them
  -h, --help         show this

All else is handed to Snakemake as it is, see snakemake --help, and its exit code comes back;
of bad input it is 2. The defaults are those of profiles/default, here or in the package.

  microslip sweep --cores 2
  microslip sweep --cores 2 --configfile mine.yaml --config points_per_job=10
"""


def main(arguments: list[str]) -> int:
    """Run Snakemake with these arguments; return its exit code."""
    if {"-h", "--help"} & set(arguments):
        print(HELP, end="")
        return 0
    try:
        os.getcwd()
    except OSError as error:
        complain(f"microslip sweep: the current folder: {error.strerror}")
        return 2
    try:
        command = [sys.executable, "-m", "microslip.app.sweep_process"]
        command += ["--snakefile", str(snakefile())]
    except FileNotFoundError as error:
        complain(f"microslip sweep: {error}")
        return 2
    if "SNAKEMAKE_PROFILE" not in os.environ and not any(map(SETS_CORES.match, arguments)):
        command += ["--cores", "all"]
    with subprocess.Popen([*command, *arguments]) as running:
        signal.signal(signal.SIGTERM, lambda *_: running.terminate())
        if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) != signal.SIG_IGN:
            signal.signal(signal.SIGHUP, lambda *_: _hang_up(running))  # unless nohup asks not to
        while True:
            try:
                code = running.wait()
                return code if code >= 0 else 128 - code  # as shells say it: 128 + signal
            except KeyboardInterrupt:
                pass  # Snakemake got it too: it tidies up and ends


def _hang_up(running: subprocess.Popen) -> None:
    """End Snakemake and its jobs, the terminal of which was closed.

    A terminal sends the signal to its first process only, a shell to the whole group.  If this
    process is the first one, or was started by the shell, the group is its own.
    """
    signal.signal(signal.SIGHUP, signal.SIG_IGN)  # its own is to come
    if os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGHUP)  # jobs end at once, Snakemake when they have
    running.terminate()


def snakefile() -> Path:
    """Path of the workflow that belongs to this package. Raises FileNotFoundError."""
    places = (PACKAGE / "bundle", PACKAGE.parents[1])
    for place in places:
        if (place / "Snakefile").is_file():
            return place / "Snakefile"
    raise FileNotFoundError(f"no Snakefile in {' or '.join(map(str, places))}")
