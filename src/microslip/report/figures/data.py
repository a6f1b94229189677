"""Read datasets for figures, and select parts of them."""

from __future__ import annotations

import os

import numpy as np
import xarray as xr

from microslip.datasets.netcdf import whole
from microslip.foundation.files import CacheError


def loaded(path: str | os.PathLike[str]) -> xr.Dataset:
    """Read a file, including its groups, into one dataset for `draw`.

    Raises CacheError if the file is missing or damaged.
    """
    try:
        return whole(path)
    except (OSError, RuntimeError, ValueError) as error:
        why = " ".join(str(getattr(error, "strerror", None) or error).split())
        raise CacheError(
            f"cannot read the dataset {path}: {why}; allowed: a netCDF file that the workflow made;"
            " remove it and run again: finished points are kept"
        ) from error


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Split a dataset by Poisson's ratio, in ascending order."""
    if "poisson" not in dataset.dims:
        return [dataset]
    dataset = dataset.sortby("poisson")
    return [dataset.isel(poisson=index) for index in range(dataset.sizes["poisson"])]


def moving(dataset: xr.Dataset) -> xr.Dataset:
    """Select the velocities above 0."""
    if "velocity" not in dataset.dims:
        return dataset
    return dataset.isel(velocity=dataset["velocity"].values > 0)


def limit(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Return a theoretical limit, on a fine axis if the dataset has one."""
    return dataset[f"{name}_curve"] if f"{name}_curve" in dataset else dataset[name]


def columns(dataset: xr.Dataset, *names: str) -> tuple[np.ndarray, ...]:
    """Return the values of several variables as arrays."""
    return tuple(dataset[name].values for name in names)


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """Replace infinite values by NaN, which matplotlib does not draw."""
    values = np.asarray(values, dtype=float)
    return np.where(np.isfinite(values), values, np.nan)
