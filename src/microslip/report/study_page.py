"""The page about a study's dataset."""

from microslip.report import claims_page, dataset_page

_PAGES = {"claims": claims_page}
"""Those that have a page of their own."""


def write(study, path, dataset, lines):
    """Write the page about a study's dataset; lines: those of its report.

    Raises CacheError as `cache.writing_beside` does.
    """
    _PAGES.get(study, dataset_page).write(path, dataset, lines)
