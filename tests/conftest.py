"""What all tests share: which of them run, the order in which files of them are handed out, and a
finished run.

A file is one process's, since its tests share what is slow to make (--dist loadfile).

Tests that are marked `long` take a second to a minute each: whole workflows, pages, figures, and
finer runs of what something quicker shows, too. A run that names nothing leaves them out, and takes
the first and the last case only of a test that is marked `slow`.
Whatever is named on the command line runs whole, be it a file, a folder, an expression of -k or
one of -m; `.ci/whole` runs everything.
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
"""Whoever runs the tests sees the same random inputs; campaigns look at others."""

for library in ("OMP", "OPENBLAS", "MKL"):
    # As in jobs of the workflow: each process has a core, and threads that wait would take another.
    # NumPy, which reads this when it is loaded, is not loaded yet.
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # A shell starts what runs in its background so, and processes that tests interrupt inherit it.
    signal.signal(signal.SIGINT, signal.default_int_handler)

FIRST = (
    "test_workflow.py",  # compiles the solver, which takes a fresh clone a minute or two
    *("test_figures", "test_odd_files", "test_bad", "test_compiled", "test_terminal"),  # need none
    *("test_workflow_", "test_docs", "test_explorer", "test_several", "test_point"),
    *("test_pressure", "test_side_by_side", "test_static_loop", "test_normal", "test_period"),
    *("test_stability", "test_sweep_command", "test_fit", "test_drives"),
)
"""Files that take long, by how their names begin: they come first, so that all processes end at
about the same time."""


def pytest_configure(config):
    """Leave out what is long where nothing is named; processes that run tests are told the same."""
    option = config.option
    is_named = config.args_source == config.ArgsSource.ARGS  # and not what pyproject.toml names
    if not (is_named or option.markexpr or option.keyword):
        option.markexpr = "not long"


@pytest.hookimpl(tryfirst=True)  # before pytest leaves out what it is asked to leave out
def pytest_collection_modifyitems(items):
    """What is long is slow, too, and what lies between the ends of slow cases is long; files that
    take long come first."""
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
    """What is loaded by now stays: to look through it again and again for garbage takes long."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    """As many processes as there are cores for this one, though no more than there is work for."""
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else range(os.cpu_count())
    return min(len(cores), 16)


def made_once(tmp_path_factory, name, make):
    """A folder that whichever process needs it first fills, by `make(folder)`; others wait."""
    import fcntl

    top = tmp_path_factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        top = top.parent  # which the processes share
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
    """A project after its first run; `said` holds what that run said. To be left as it is."""
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
    """A copy of the finished project to edit."""
    return finished.copied(tmp_path / "copy")


@pytest.fixture
def unplaced(monkeypatch):
    """Figures are drawn without looking for room for what they hold, which takes the longest."""
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda engine, figure: None)
