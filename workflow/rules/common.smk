# Shared by all rules: the package, the configuration, its plan, and the test for outdated files.

import atexit
import functools
import os
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

from snakemake.exceptions import WorkflowError

# The package of this tree runs, even if another one is installed.
ROOT = Path(str(workflow.current_basedir)).parents[1]
if (ROOT / "src").is_dir():
    sys.path.insert(0, str(ROOT / "src"))
    search = [str(ROOT / "src"), *filter(None, [os.environ.get("PYTHONPATH")])]
    os.environ.update(PYTHONPATH=os.pathsep.join(search))

# The jobs inherit this: each process solves one point at a time, with one thread.
for library in ("OMP", "OPENBLAS", "MKL", "NUMBA"):
    os.environ[f"{library}_NUM_THREADS"] = "1"


def hang_up(*_):
    """After SIGHUP (closed terminal), end the jobs, and end Snakemake without leaving a lock.

    A terminal sends SIGHUP to its first process only. A shell sends it to the whole group.
    """
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    if os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGHUP)
    signal.raise_signal(signal.SIGTERM)


if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:
    signal.signal(signal.SIGHUP, hang_up)  # not reached under nohup

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
    """Context manager: end the run with one line, before any job, for errors the user can fix."""
    try:
        yield
    except load.ConfigError as error:
        sys.exit(f"Error in {error}")
    except CacheError as error:
        sys.exit(f"Error in {ORIGIN}: results: {error}")


# A file given with --configfile replaces the default configuration.  The default is
# config/config.yaml in the working directory, or else in the package. A module is configured by the
# outer workflow.
MAIN = os.path.abspath(workflow.basedir) in (str(ROOT), str(ROOT / "workflow"))
if not (config and workflow.configfiles):
    DEFAULT = "config/config.yaml"
    if not (MAIN and os.path.exists(DEFAULT)):
        DEFAULT = str(ROOT / DEFAULT)
    if not ROOT.is_dir():  # a workflow on a server
        DEFAULT = workflow.source_path("../../config/config.yaml")
    with refused_in_one_line():
        load.read_yaml(os.path.relpath(DEFAULT))  # its errors have line numbers

    configfile: DEFAULT

elif MAIN:
    with refused_in_one_line():
        for file in workflow.configfiles:
            load.read_yaml(os.path.relpath(file))  # rejects duplicate keys

# In a module, these files belong to the outer workflow and can have other keys.
FILES = [os.path.relpath(file) for file in workflow.configfiles] if MAIN else []
ORIGIN = ", ".join(FILES) or "configuration"
# Folders of files named in the configuration; the working directory comes after them.
FOLDERS = [os.path.dirname(os.path.abspath(file)) for file in workflow.configfiles]

with refused_in_one_line():
    CONFIGURATION = load.from_mapping(config, source=ORIGIN, folders=FOLDERS)
    # Adds default values for captions, and makes file paths absolute for jobs.
    config = load.with_defaults_and_paths(config, source=ORIGIN, folders=FOLDERS)
PLAN = Plan(CONFIGURATION)
RESULTS = os.path.normpath(CONFIGURATION.results)

# The end of the Snakefile defines PLACE: RESULTS with the prefix of a module.
HERE = exists(os.devnull)  # False for results in remote storage, where stamps cannot be read
AGAIN = f"{RESULTS}/{stamps.AGAIN}"
in_place = update if HERE else str  # keeps the old file until a job has written the new one
marked = str if HERE else local
TO_SOLVE = {}


def made_again(right):
    """Return the file AGAIN. If all is up to date, it is ancient: Snakemake ignores its date."""
    return ancient(marked(AGAIN)) if right else marked(AGAIN)


@functools.cache
def is_whole(file):
    """Return True for a final or missing batch. Any other batch is backdated."""
    path = f"{PLACE}/{file}"
    if not (HERE and os.path.exists(path)):
        return True  # batches in remote storage are trusted
    right = store.is_final(path)
    stamps.date([path], right)
    if not right:
        print(f"{path} is damaged, or has points that failed: made again", file=sys.stderr)
    return right


@functools.cache
def is_right(product):
    """Return True if a product is up to date. An outdated product is backdated."""
    if not HERE:
        return False  # made again, from batches or datasets
    stamp = f"{PLACE}/{stamps.stamp_of(product)}"
    paths = [f"{PLACE}/{file}" for file in PLAN.products[product].files]
    right = stamps.fits(stamp, PLAN.made_of(product), paths)
    stamps.date([*paths, stamp], right)
    return right


# Snakemake runs an existing file with its mark of an unfinished job again, and from there it does
# not follow an ancient input.  So an input is ancient only where the product itself is up to date.


def batches_for(product):
    """Return the batches of a product. Whole batches of a product that is up to date are ancient,
    so that they start no job."""
    names = PLAN.batch_files(*PLAN.products[product].groups)
    if HERE and not is_right(product):
        missing = [f for f in names if not (is_whole(f) and os.path.exists(f"{PLACE}/{f}"))]
        TO_SOLVE.update(dict.fromkeys(missing))
    dated = ancient if is_right(product) else str
    return [(dated if is_whole(file) else str)(f"{RESULTS}/{file}") for file in names]


def datasets_for(product):
    """Return the datasets of a product. If it and a dataset are up to date, the dataset is
    ancient."""
    names = PLAN.products[product].datasets
    dated = ancient if is_right(product) else str
    return [(dated if is_right(name) else str)(f"{RESULTS}/{name}.nc") for name in names]


def batch_of(group, name):
    """Return a batch (the requests of a job) as JSON, or null for a certified map."""
    if name not in PLAN.batches_in(group):  # in a job on another machine
        sys.exit(
            f"Error: the batch {name} of {group} was planned with another solver, or its times on "
            "another CPU: run again, on one kind of CPU"
        )
    batch = PLAN.batches_in(group)[name]
    return canonical_json(batch and batch._asdict())


def kernels_for(group):
    """Return the files that mark the compiled kernels of a group."""
    with_drive = {*CONFIGURATION.drives, *(f"certified_{name}" for name in CONFIGURATION.drives)}
    return compiled("rings", "angles", *["pulled"] * (group in with_drive))


def compiled(*kernels, place=RESULTS):
    """Return the files that mark compiled kernels. Their names contain the solver's digest."""
    return [f"{place}/warm_up/{source_digest.of_solver()[:16]}_{name}.txt" for name in kernels]


def files_of_target(target):
    """Return the input function of a target."""

    def files(wildcards):
        try:
            products = PLAN.products_of(target)
        except load.ConfigError as error:
            sys.exit(f"Error in {ORIGIN}: {error}")
        return [f"{RESULTS}/{file}" for name in products for file in PLAN.products[name].files]

    return files


def report_work():
    """Write the number of points to solve to standard error."""
    names = [file.split("/")[1:] for file in TO_SOLVE]
    work = [PLAN.batches_in(group).get(Path(name).stem) for group, name in names]
    if work:
        print(*dry_run.summary(work, PLACE), sep="\n", file=sys.stderr)
    TO_SOLVE.clear()


def make_ready():
    """Before the first job, check that results can be written, and remove files of killed runs."""
    with refused_in_one_line():
        store.Store(PLACE).try_writing()
    for path in files.clear_abandoned(PLACE):
        print(f"{path}: removed, a partial file of a killed run", file=sys.stderr)
    report_work()


atexit.register(report_work)  # for runs without jobs, such as dry runs
