# What the rules share: the package, the checked configuration, its plan, and what is made again.

import atexit
import functools
import os
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

from snakemake.exceptions import WorkflowError

# The package of this tree is the one that runs, whether it is installed or not.
ROOT = Path(str(workflow.current_basedir)).parents[1]
if (ROOT / "src").is_dir():
    sys.path.insert(0, str(ROOT / "src"))
    search = [str(ROOT / "src"), *filter(None, [os.environ.get("PYTHONPATH")])]
    os.environ.update(PYTHONPATH=os.pathsep.join(search))

# Jobs inherit this.  Parallel work is many points at a time, one thread each.
for library in ("OMP", "OPENBLAS", "MKL", "NUMBA"):
    os.environ[f"{library}_NUM_THREADS"] = "1"


def hang_up(*_):
    """End jobs at once and Snakemake as SIGTERM does, so that no lock stays: the terminal closed.

    A terminal sends the signal to its first process only, a shell to the whole group.
    """
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    if os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGHUP)
    signal.raise_signal(signal.SIGTERM)


if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:
    signal.signal(signal.SIGHUP, hang_up)  # not so under nohup

from microslip.app import dry_run, figure_targets
from microslip.app.plan import Plan
from microslip.config import load
from microslip.foundation import files, source_digest
from microslip.foundation.canonical import canonical_json
from microslip.foundation.errors import CacheError
from microslip.report.explorer import explorer
from microslip.sweeps import batches, stamps, store


@contextmanager
def refused_in_one_line():
    """Context in which what the user has to mend ends the run with one line, before any job."""
    try:
        yield
    except load.ConfigError as error:
        sys.exit(f"Error in {error}")
    except CacheError as error:
        sys.exit(f"Error in {ORIGIN}: results: {error}")


# A file given with --configfile takes the place of the default, they are not mixed.  Without one,
# that of the working directory comes first.  A module is configured by the workflow that uses it.
MAIN = os.path.abspath(workflow.basedir) in (str(ROOT), str(ROOT / "workflow"))
if not (config and workflow.configfiles):
    DEFAULT = "config/config.yaml"
    if not (MAIN and os.path.exists(DEFAULT)):
        DEFAULT = str(ROOT / DEFAULT)
    if not ROOT.is_dir():  # a workflow that Snakemake reads from elsewhere
        DEFAULT = workflow.source_path("../../config/config.yaml")
    with refused_in_one_line():
        load.read_yaml(os.path.relpath(DEFAULT))  # says where a mistake is

    configfile: DEFAULT

elif MAIN:
    with refused_in_one_line():
        for file in workflow.configfiles:
            load.read_yaml(os.path.relpath(file))  # refuses a key that occurs twice

# In a module the files are those of the other workflow, which may hold more than this one knows.
FILES = [os.path.relpath(file) for file in workflow.configfiles] if MAIN else []
ORIGIN = ", ".join(FILES) or "configuration"
# Where files are looked for that the configuration names, before the working directory.
FOLDERS = [os.path.dirname(os.path.abspath(file)) for file in workflow.configfiles]

with refused_in_one_line():
    CONFIGURATION = load.from_mapping(config, source=ORIGIN, folders=FOLDERS)
    # Captions name the defaults too, and jobs find the files that were found here.
    config = load.with_files_found(config, source=ORIGIN, folders=FOLDERS)
PLAN = Plan(CONFIGURATION)
RESULTS = os.path.normpath(CONFIGURATION.results)

HERE = exists(os.devnull)  # False where results are in a storage: no stamp can be read there
AGAIN = f"{RESULTS}/{stamps.AGAIN}"
kept = update if HERE else str  # the old file stays until a job has written the new one
marked = str if HERE else local
TO_SOLVE = {}


def made_again(right):
    """The file AGAIN; ancient, which means that its date does not count, where all is right."""
    return ancient(marked(AGAIN)) if right else marked(AGAIN)


@functools.cache
def is_whole(file):
    """Whether a batch is whole and final, or missing; dates it back if it is not."""
    path = f"{PLACE}/{file}"
    if not (HERE and os.path.exists(path)):
        return True  # in a storage batches are trusted
    right = store.is_final(path)
    stamps.date([path], right)
    if not right:
        print(f"{path} is made again: it is damaged, or has points that failed", file=sys.stderr)
    return right


@functools.cache
def is_right(product):
    """Whether a product is what the configuration and the code lead to; dates it back if not."""
    if not HERE:
        return False  # made again, from batches or datasets
    stamp = f"{PLACE}/{stamps.stamp_of(product)}"
    paths = [f"{PLACE}/{file}" for file in PLAN.products[product].files]
    right = stamps.fits(stamp, PLAN.made_of(product), paths)
    stamps.date([*paths, stamp], right)
    return right


def batches_for(product):
    """Batches of a product, ancient where they are whole: then they are no reason to collect."""
    found = PLAN.batch_files(*PLAN.products[product].groups)
    if HERE and not is_right(product):
        missing = [f for f in found if not (is_whole(f) and os.path.exists(f"{PLACE}/{f}"))]
        TO_SOLVE.update(dict.fromkeys(missing))
    return [(ancient if is_whole(file) else str)(f"{RESULTS}/{file}") for file in found]


def datasets_for(product):
    """Datasets of a product, ancient where they are right."""
    names = PLAN.products[product].datasets
    return [(ancient if is_right(name) else str)(f"{RESULTS}/{name}.nc") for name in names]


def batch_of(group, name):
    """A batch as JSON: the requests that a job answers."""
    batch = PLAN.batches_in(group).get(name)
    if batch is None:  # in a job on another machine
        sys.exit(
            f"Error: the batch {name} of {group} was planned with another solver, or its times on "
            "another CPU: run again, on one kind of CPU"
        )
    return canonical_json(batch._asdict())


def kernels_for(group):
    """Compiled code that a group needs; its name holds the digest of the solver."""
    pulled = {*CONFIGURATION.drives, *(f"certified_{name}" for name in CONFIGURATION.drives)}
    return compiled("rings", "angles", *["pulled"] * (group in pulled))


def compiled(*kernels, place=RESULTS):
    """Marks that kernels are compiled."""
    return [f"{place}/warm_up/{source_digest.of_solver()[:16]}_{name}.txt" for name in kernels]


def files_of_target(target):
    """Input function of a target."""

    def files(wildcards):
        try:
            products = PLAN.products_of(target)
        except load.ConfigError as error:
            sys.exit(f"Error in {ORIGIN}: {error}")
        return [f"{RESULTS}/{file}" for name in products for file in PLAN.products[name].files]

    return files


def report_work():
    """Write to standard error how many points there are to solve, and about how long it takes."""
    try:
        cores = min(workflow.cores, max(len(TO_SOLVE), 1))
    except WorkflowError:  # jobs run elsewhere
        cores = max(len(TO_SOLVE), 1)
    names = [file.split("/")[1:] for file in TO_SOLVE]
    work = [(group, PLAN.batches_in(group).get(Path(name).stem)) for group, name in names]
    if work:
        missing = not all(map(os.path.exists, compiled("rings", "angles", place=PLACE)))
        print(*dry_run.summary(work, PLACE, cores, compiles=missing), sep="\n", file=sys.stderr)
    TO_SOLVE.clear()


def make_ready():
    """Before the first job: see that results can be written, clear what killed runs left."""
    with refused_in_one_line():
        store.Store(PLACE).try_writing()
    for path in files.clear_abandoned(PLACE):
        print(f"{path} was left by a run that was killed: removed", file=sys.stderr)
    report_work()


atexit.register(report_work)  # where no job starts, as in a dry run
