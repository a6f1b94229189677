"""Selection and order of the tests, and a finished run for all of them.

All tests of a file run in one process, since they share expensive fixtures (--dist loadfile).

Tests marked `long` take a second to a minute each: workflows, pages, figures, and fine runs of
behaviour that a faster test checks, too. `pytest` without arguments omits them, and runs only
the first and the last case of a test marked `slow`. With a file, a folder, -k or -m, all
selected tests run; `.ci/whole` runs everything.
"""

import gc
import os
import shutil
import signal
from collections import defaultdict

import pytest
import yaml
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
"""Everyone gets the same random inputs; campaigns use others."""

for library in ("OMP", "OPENBLAS", "MKL"):
    # One thread per process, as in jobs of the workflow.
    # NumPy reads these variables at import, which comes later.
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # Shells ignore SIGINT in background processes, and tests that send it need the default.
    signal.signal(signal.SIGINT, signal.default_int_handler)

FIRST = (
    "test_workflow.py",  # compiles the solver, which takes a fresh clone a minute or two
    *("test_figures", "test_refus", "test_bad", "test_compiled", "test_terminal"),  # need none
    *("test_workflow_", "test_docs", "test_explorer", "test_point"),
    *("test_pressure", "test_static_loop", "test_normal", "test_period"),
    *("test_stability", "test_sweep", "test_fit", "test_drives"),
)
"""Beginnings of the names of long files, which run first, so that all processes end together."""


def pytest_configure(config):
    """Omit long tests unless the command line selects tests; pytest-xdist passes the option on."""
    option = config.option
    is_named = config.args_source == config.ArgsSource.ARGS  # and not those of pyproject.toml
    if not (is_named or option.markexpr or option.keyword):
        option.markexpr = "not long"


@pytest.hookimpl(tryfirst=True)  # before pytest applies -m
def pytest_collection_modifyitems(items):
    """Mark long tests as slow, and the middle cases of slow tests as long; put long files first."""
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("long"):
            item.add_marker("slow")
        elif item.get_closest_marker("slow"):
            cases[item.nodeid.partition("[")[0]].append(item)
    for of_one_test in cases.values():
        for item in of_one_test[1:-1]:
            item.add_marker("long")

    def place(item):
        found = (i for i, start in enumerate(FIRST) if item.path.name.startswith(start))
        return next(found, len(FIRST))

    items.sort(key=place)


def pytest_collection_finish(session):
    """Exclude the objects that exist now from garbage collection, which would take long."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    """Number of processes: one per core, at most 16."""
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else range(os.cpu_count())
    return min(len(cores), 16)


def made_once(tmp_path_factory, name, make):
    """A folder that the first process fills by `make(folder)`; other processes wait."""
    import fcntl

    top = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        top = top.parent  # the folder that all processes share
    folder = top / name
    with open(top / f"{name}.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not (folder / "made").exists():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            make(folder)
            (folder / "made").touch()
    return folder


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """A project after its first run, with its output in `said`. Tests must not change it."""
    from stubs.workflow_project import TINY, Project

    def run(place):
        project = Project(place / "microslip")
        (project.folder / "config" / "config.yaml").write_text(yaml.safe_dump(TINY))
        (place / "said").write_text(project.run())

    place = made_once(tmp_path_factory, "finished", run)
    project = Project.at(place / "microslip")
    project.said = (place / "said").read_text()
    return project


@pytest.fixture
def project(finished, tmp_path):
    """A copy of the finished project for edits."""
    return finished.copied(tmp_path / "copy")
