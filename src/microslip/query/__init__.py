"""Questions to a finished sweep.

    friction = microslip.open_map("transverse")
    friction.mu_macro.sel(velocity=0.1, method="nearest")     # plain xarray
    friction.friction.at(velocity=0.05, amplitude=0.8)        # a value and a bound of its error

`interpolation` holds the rule and its error, `beyond` what is known where a map ends, `accessor`
asks both.
"""

from __future__ import annotations

import os
from pathlib import Path

import xarray as xr

from microslip.cache import CacheError, is_damaged
from microslip.settings import SCENE_OF_SWEEP

from .accessor import SOURCES, Friction

__all__ = ["SOURCES", "Friction", "open_map"]


def open_map(
    name: str | os.PathLike[str], results: str | os.PathLike[str] = "results", chunks=None
):
    """Open the dataset of a sweep, with the accessor ``friction`` for certified answers.

    name: transverse, bore, continuous_bore or another sweep of the configuration, or the path of
    such a dataset; results: folder that the workflow wrote to; chunks: as for xarray.open_dataset,
    {} for dask.  Returns an xarray.Dataset.  Raises ValueError for another name, CacheError, one
    line, for a file that is missing, damaged, or not from a sweep.
    """
    path = Path(name)
    if path.suffix != ".nc":
        path = Path(results, f"{name}.nc")
        if str(name) not in SCENE_OF_SWEEP and not path.is_file():
            raise ValueError(
                f"name = {name!r}: allowed is {', '.join(SCENE_OF_SWEEP)}, another sweep of which "
                f"{results} has the dataset, or a path"
            )
    if not path.is_file():
        raise CacheError(f"{path} is not there: run the workflow first, or name its results folder")
    if is_damaged(path):
        raise CacheError(f"{path} is damaged: run the workflow again, which makes it anew")
    dataset = xr.open_dataset(path, engine="netcdf4", chunks=chunks)
    if "scene" not in dataset.attrs or "mu_macro" not in dataset:
        raise CacheError(f"{path} is not the dataset of a sweep")
    return dataset
