"""The page about a study's dataset."""

import os

import xarray as xr

from microslip.report import claims_page, dataset_page

_PAGES = {"claims": claims_page}
"""Studies that have a page of their own."""


def write(study: str, path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page about a study's dataset; lines: those of its report.

    Raises CacheError as `files.writing_beside` does.
    """
    _PAGES.get(study, dataset_page).write(path, dataset, lines)
