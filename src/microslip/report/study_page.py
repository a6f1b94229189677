"""Write the page of a study."""

import os

import xarray as xr

from microslip.report import claims_page, dataset_page

_PAGES = {"claims": claims_page}
"""Modules that write a study's page. For all other studies, `dataset_page` writes the page."""


def write(study: str, path: str | os.PathLike, dataset: xr.Dataset, lines: list[str]) -> None:
    """Write the page of a study to a file. lines: log of the collection of its dataset.

    Raises CacheError if the file cannot be written.
    """
    _PAGES.get(study, dataset_page).write(path, dataset, lines)
