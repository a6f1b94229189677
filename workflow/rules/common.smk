# Shared by all rules: the package, the configuration, its plan, and what the results folder lacks.

import os
import re
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

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

from microslip.app.plan import Plan, Results
from microslip.config import load
from microslip.foundation import files
from microslip.foundation.errors import CacheError


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
    config = load.reread(config, FILES)
    CONFIGURATION = load.from_mapping(config, source=ORIGIN, folders=FOLDERS)
    config = load.with_paths(config, folders=FOLDERS)  # jobs find files from any folder
    PLAN = Plan(CONFIGURATION)

RESULTS = os.path.normpath(CONFIGURATION.results)
HERE = exists(os.devnull)  # False for results in remote storage
in_place = update if HERE else str  # keeps the old file until a job has written the new one
IS_JOB = "--target-jobs" in sys.argv  # on another machine
WHOLE = IS_JOB or not HERE or "--report" in sys.argv
"""True to apply the rules to all files, and not only to missing ones."""
MARKER = f"{RESULTS}/data/{os.urandom(8).hex()}.made"
PRODUCT_OF = {}  # name of a product by the stem of its files


def look(place):
    """Return the state of the results folder, and check what is missing with the solver."""
    with refused_in_one_line():
        if HERE:
            folders = [f"{place}/{name}" for name in ("batches", "data", "figures", "summaries")]
            links = [f"{place}/{link}" for one in PLAN.products.values() for link in one.links]
            files.refuse_unusable(folders, links)
        state = Results(PLAN, place, HERE, WHOLE)
        PRODUCT_OF.update({stem: name for name, stem in state.stems.items()})
        if not IS_JOB:
            load.refuse_unsolvable(CONFIGURATION, state.missing, source=ORIGIN)
        if HERE:
            state.link()
    return state


def any_of(names):
    """Return a regular expression for these names, or for none."""
    return "|".join(map(re.escape, names)) or "(?!)"


def files_of(*names):
    """Return the paths of products."""
    return [f"{RESULTS}/{file}" for name in names for file in STATE.files(name)]


def inputs_of(*names):
    """Return an input function: the paths of what products are made from, except each other."""

    def inputs(wildcards):
        here = {file for name in names if name in STATE.missing for file in STATE.files(name)}
        paths = [path for name in names for path in STATE.missing.get(name, ())]
        return [ancient(f"{RESULTS}/{path}") for path in dict.fromkeys(paths) if path not in here]

    return inputs


def inputs_of_stem(stem):
    """Return the paths of what a product is made from."""
    return inputs_of(PRODUCT_OF[stem])(None)


def everything(wildcards):
    """Return all products, with one job for the missing ones."""
    if WHOLE or len(STATE.missing) < 2:
        return files_of(*PLAN.products)
    return [MARKER, *files_of(*(name for name in PLAN.products if name not in STATE.missing))]


def inputs_of_link(plain):
    """Return the file to which a plain name refers, and for a link to another file the folder,
    which is newer than the link, see `Results.link`."""
    name, file = STATE.plain()[plain]
    if name not in STATE.missing:
        return {"file": ancient(f"{RESULTS}/{file}")}
    folder = f"{RESULTS}/data"
    return {"file": f"{RESULTS}/{file}", "folder": [folder] * (HERE and os.path.isdir(folder))}


def make_ready():
    """Before the first job, check that results can be written, and remove files of killed runs."""
    with refused_in_one_line():
        files.refuse_unwritable(STATE.folder)
    for path in files.clear_abandoned(STATE.folder):
        print(f"{path}: removed, a partial file of a killed run", file=sys.stderr)
