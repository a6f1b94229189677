# Set up the objects that all rules share: package, configuration, plan, and missing results.

import os
import re
import signal
import sys
from contextlib import contextmanager
from pathlib import Path

# Use the package of this source tree, even if another one is installed.
ROOT = Path(str(workflow.current_basedir)).parents[1]
if (ROOT / "src").is_dir():
    sys.path.insert(0, str(ROOT / "src"))
    search = [str(ROOT / "src"), *filter(None, [os.environ.get("PYTHONPATH")])]
    os.environ.update(PYTHONPATH=os.pathsep.join(search))

# Jobs inherit these variables, so that each process solves one point at a time with one thread.
for library in ("OMP", "OPENBLAS", "MKL", "NUMBA"):
    os.environ[f"{library}_NUM_THREADS"] = "1"


def hang_up(*_):
    """After SIGHUP (closed terminal), end the jobs, and end Snakemake so that no lock remains.

    A terminal sends SIGHUP only to its first process, whereas a shell sends it to the whole process
    group.
    """
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    if os.getpgrp() == os.getpid():
        os.killpg(0, signal.SIGHUP)
    signal.raise_signal(signal.SIGTERM)


if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) == signal.SIG_DFL:
    signal.signal(signal.SIGHUP, hang_up)  # not reached under nohup, which ignores SIGHUP

from microslip.app.plan import Plan, Results
from microslip.config import load
from microslip.foundation import files
from microslip.foundation.errors import CacheError, InputError


@contextmanager
def refused_in_one_line():
    """Context manager that ends the run with a one-line message for errors that the user can
    fix."""
    try:
        yield
    except load.ConfigError as error:
        sys.exit(f"Error in {error}")
    except CacheError as error:
        sys.exit(f"Error in {ORIGIN}: results: {error}")
    except InputError as error:  # in a user's file
        sys.exit(f"Error in {ORIGIN}: {error}")


# A file given with --configfile replaces the default configuration.  The default is
# config/config.yaml in the working directory, or else in the package. If this workflow is a module,
# the outer workflow configures it.
MAIN = os.path.abspath(workflow.basedir) in (str(ROOT), str(ROOT / "workflow"))
if not (config and workflow.configfiles):
    DEFAULT = "config/config.yaml"
    if not (MAIN and os.path.exists(DEFAULT)):
        DEFAULT = str(ROOT / DEFAULT)
    if not ROOT.is_dir():  # a workflow on a server
        DEFAULT = workflow.source_path("../../config/config.yaml")
    with refused_in_one_line():
        load.read_yaml(os.path.relpath(DEFAULT))  # to report errors with line numbers

    configfile: DEFAULT

elif MAIN:
    with refused_in_one_line():
        for file in workflow.configfiles:
            load.read_yaml(os.path.relpath(file))  # rejects duplicate keys

# If this workflow is a module, these files belong to the outer workflow and can contain other keys.
FILES = [os.path.relpath(file) for file in workflow.configfiles] if MAIN else []
ORIGIN = ", ".join(FILES) or "configuration"
# Folders in which files named in the configuration are searched for, before the working directory.
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
"""If True, apply the rules to all files, and not only to missing ones."""
MARKER = f"{RESULTS}/data/{os.urandom(8).hex()}.made"
PRODUCT_OF = {}  # names of products, keyed by the stem of the files


def look(place):
    """Return the state of the results folder, and check that the solver accepts the missing
    points."""
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
    if HERE and state.missing and not IS_JOB:
        maps = " and certified maps" if state.batches(certified=True) else ""
        print(f"New points and runs: {state.new_points()}{maps}", file=sys.stderr)
    return state


def any_of(names):
    """Return a regular expression that matches any of these names, or nothing if there are no
    names."""
    return "|".join(map(re.escape, names)) or "(?!)"


def files_of(*names):
    """Return the paths of the files of products."""
    return [f"{RESULTS}/{file}" for name in names for file in STATE.files(name)]


def inputs_of(*names):
    """Return an input function that lists the files from which products are made, except files of
    these products themselves."""

    def inputs(wildcards):
        here = {file for name in names if name in STATE.missing for file in STATE.files(name)}
        paths = [path for name in names for path in STATE.missing.get(name, ())]
        return [ancient(f"{RESULTS}/{path}") for path in dict.fromkeys(paths) if path not in here]

    return inputs


def inputs_of_stem(stem):
    """Return the paths of the files from which a product is made."""
    return inputs_of(PRODUCT_OF[stem])(None)


def everything(wildcards):
    """Return the files of all products. If several products are missing, one job makes them."""
    if WHOLE or len(STATE.missing) < 2:
        return files_of(*PLAN.products)
    return [MARKER, *files_of(*(name for name in PLAN.products if name not in STATE.missing))]


def inputs_of_link(plain):
    """Return the file to which a plain name refers. For a link to another file, also return the
    folder, which is newer than the link (see `Results.link`)."""
    name, file = STATE.plain()[plain]
    if name not in STATE.missing:
        return {"file": ancient(f"{RESULTS}/{file}")}
    folder = f"{RESULTS}/data"
    return {"file": f"{RESULTS}/{file}", "folder": [folder] * (HERE and os.path.isdir(folder))}


def make_ready():
    """Before the first job, check that results can be written, and remove the files of killed
    runs."""
    with refused_in_one_line():
        files.refuse_unwritable(STATE.folder)
    for path in files.clear_abandoned(STATE.folder):
        print(f"{path}: removed, a partial file of a killed run", file=sys.stderr)
