"""Read and check datasets for figures, and select Poisson's ratios and curves."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np
import xarray as xr

from microslip.datasets.netcdf import whole
from microslip.foundation.files import CacheError

Curve = tuple[np.ndarray, np.ndarray]


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


def require(figure: str, key: str, dataset: xr.Dataset, variables: Iterable[str]) -> None:
    """Raise ValueError unless the dataset has all variables.

    figure, key: names of the figure and of the dataset, for the message.
    """
    missing = [name for name in variables if name not in dataset.variables]
    if missing:
        raise ValueError(
            f"figure {figure}: dataset {key!r} has no variable {', '.join(map(repr, missing))}"
        )


def at_one_poisson(dataset: xr.Dataset) -> tuple[xr.Dataset, float]:
    """Select the Poisson's ratio nearest 0 (as in the paper). Returns the dataset and the ratio."""
    if "poisson" not in dataset.variables:
        return dataset, 0.0
    if "poisson" in dataset.dims:
        dataset = dataset.isel(poisson=int(np.argmin(np.abs(dataset["poisson"].values))))
    return dataset, float(dataset["poisson"])


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Split a dataset by Poisson's ratio, in ascending order."""
    if "poisson" not in dataset.dims:
        return [dataset]
    ordered = dataset.sortby("poisson")
    return [ordered.isel(poisson=index) for index in range(ordered.sizes["poisson"])]


def sweep(dataset: xr.Dataset, dims: tuple[str, ...]) -> tuple[xr.Dataset, float]:
    """Reduce a dataset so that `mu_macro` has the dimensions `dims` only, in ascending order.

    Returns the dataset and its Poisson's ratio. Raises ValueError if a dimension is missing, or if
    another dimension has more than one entry.
    """
    dataset, poisson = at_one_poisson(dataset)
    present = dataset["mu_macro"].dims
    if missing := [dim for dim in dims if dim not in present]:
        raise ValueError(f"mu_macro has no dimension {missing[0]!r}; it has {present}")
    for extra in set(present) - set(dims):
        if dataset.sizes[extra] > 1:
            raise ValueError(f"mu_macro has another dimension {extra!r}: select one entry of it")
        dataset = dataset.isel({extra: 0})
    return dataset.sortby(list(dims)), poisson


def limit(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Return a theoretical limit, on a fine axis if the dataset has one."""
    return dataset[f"{name}_curve"] if f"{name}_curve" in dataset else dataset[name]


def curve(variable: xr.DataArray, **at: float) -> Curve:
    """Return abscissa and ordinate of a variable along the dimension that `at` does not select.

    Dimensions in `at` that the variable does not have are ignored.
    """
    line = variable.sel({dim: value for dim, value in at.items() if dim in variable.dims})
    if line.ndim != 1:
        raise ValueError(f"variable {variable.name!r} has dims {variable.dims}; allowed: one")
    return np.asarray(line[line.dims[0]].values), np.asarray(line.values, dtype=float)


def columns(dataset: xr.Dataset, *names: str) -> tuple[np.ndarray, ...]:
    """Return the values of several variables as arrays."""
    return tuple(dataset[name].values for name in names)


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """Replace infinite values by NaN, which matplotlib does not draw."""
    values = np.asarray(values, dtype=float)
    return np.where(np.isfinite(values), values, np.nan)
