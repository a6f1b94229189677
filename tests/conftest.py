"""What all tests share: the order in which files of them are handed out, and a finished run.

A file is one process's, since its tests share what is slow to make (--dist loadfile).
"""

import shutil

import pytest
from hypothesis import settings

settings.register_profile("repeatable", derandomize=True, deadline=None)
settings.load_profile("repeatable")
"""Whoever runs the tests sees the same random inputs; campaigns look at others."""

LONG = ("test_workflow", "test_docs", "test_explorer_browser", "test_studies", "test_claims")
"""Files with few tests that take long: they come first, so that no process ends alone with one."""


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: not item.path.name.startswith(LONG))


@pytest.fixture(scope="session")
def finished(tmp_path_factory):
    """A project after its first run, and what that run said. To be left as it is."""
    from stubs.workflow_project import ALL_JOBS, Project

    project = Project(tmp_path_factory.mktemp("finished"))
    assert project.planned() == ALL_JOBS
    project.said = project.run()
    return project


@pytest.fixture
def project(finished, tmp_path):
    """A copy of the finished project to edit."""
    copy = object.__new__(type(finished))
    copy.folder = tmp_path / "copy"
    shutil.copytree(finished.folder, copy.folder)
    return copy
