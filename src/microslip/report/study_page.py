"""The page of a study."""

import os

import xarray as xr

from microslip.report import claims_page, dataset_page

_PAGES = {"claims": claims_page}
"""Modules of studies with a special page."""


def write(study: str, path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page of a study's dataset to a file; lines: log of collecting it.

    Raises CacheError if the file cannot be written.
    """
    _PAGES.get(study, dataset_page).write(path, dataset, lines)
