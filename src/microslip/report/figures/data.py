"""Access of figures to a dataset: checks, one Poisson ratio, curves along one dimension."""

from __future__ import annotations

import os
from collections.abc import Iterable

import numpy as np
import xarray as xr

from microslip.datasets.netcdf import whole
from microslip.foundation.files import CacheError

Curve = tuple[np.ndarray, np.ndarray]


def loaded(path: str | os.PathLike[str]) -> xr.Dataset:
    """A dataset from its file, with what is in groups of the file, as `draw` takes it.

    Raises CacheError, one line, where the file is none or damaged.
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
    """Raise ValueError unless the dataset holds all these variables."""
    missing = [name for name in variables if name not in dataset.variables]
    if missing:
        raise ValueError(
            f"figure {figure}: dataset {key!r} has no variable {', '.join(map(repr, missing))}"
        )


def at_one_poisson(dataset: xr.Dataset) -> tuple[xr.Dataset, float]:
    """The part of a dataset with the Poisson ratio nearest 0 (the paper's), and that ratio."""
    if "poisson" not in dataset.variables:
        return dataset, 0.0
    if "poisson" in dataset.dims:
        nearest = int(np.argmin(np.abs(dataset["poisson"].values)))
        dataset = dataset.isel(poisson=nearest)
    return dataset, float(dataset["poisson"])


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """The parts of a dataset at each of its Poisson's ratios, from the smallest on."""
    if "poisson" not in dataset.dims:
        return [dataset]
    ordered = dataset.sortby("poisson")
    return [ordered.isel(poisson=index) for index in range(ordered.sizes["poisson"])]


def sweep(dataset: xr.Dataset, dims: tuple[str, ...]) -> tuple[xr.Dataset, float]:
    """A dataset whose `mu_macro` has exactly these dims, in rising order, and its Poisson ratio.

    Further sweep axes are allowed only with one entry, since a figure shows one of them.
    """
    dataset, poisson = at_one_poisson(dataset)
    found = dataset["mu_macro"].dims
    if missing := [dim for dim in dims if dim not in found]:
        raise ValueError(f"mu_macro has no dimension {missing[0]!r}; it has {found}")
    for extra in set(found) - set(dims):
        if dataset.sizes[extra] > 1:
            raise ValueError(f"mu_macro has a further dimension {extra!r}: select one entry of it")
        dataset = dataset.isel({extra: 0})
    return dataset.sortby(list(dims)), poisson


def limit(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """A limit from theory: on its fine axis where the dataset has that, else on the sweep's."""
    return dataset[f"{name}_curve"] if f"{name}_curve" in dataset else dataset[name]


def curve(variable: xr.DataArray, **at: float) -> Curve:
    """Abscissa and ordinate of a variable along its only dimension after the selection `at`.

    Dimensions in `at` that the variable lacks are skipped. The abscissa is the variable's own, so
    a theory curve may be stored on a finer axis than the computed points.
    """
    line = variable.sel({dim: value for dim, value in at.items() if dim in variable.dims})
    if line.ndim != 1:
        raise ValueError(f"variable {variable.name!r} has dims {variable.dims}; one expected")
    return np.asarray(line[line.dims[0]].values), np.asarray(line.values, dtype=float)


def finite_or_nan(values: np.ndarray) -> np.ndarray:
    """The values with infinities made NaN, which drawing skips."""
    values = np.asarray(values, dtype=float)
    return np.where(np.isfinite(values), values, np.nan)
