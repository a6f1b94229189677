"""What all tests share: the order in which files of them are handed out.

A file is one process's, since its tests share what is slow to make (--dist loadfile).
"""

LONG = ("test_workflow", "test_docs", "test_explorer_browser", "test_studies", "test_claims")
"""Files with few tests that take long: they come first, so that no process ends alone with one."""


def pytest_collection_modifyitems(items):
    items.sort(key=lambda item: not item.path.name.startswith(LONG))
