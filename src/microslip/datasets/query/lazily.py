"""Answers to questions that lie in chunks of dask: chunk by chunk, when they are computed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import xarray as xr


def is_lazy(*given: object) -> bool:
    """Whether any of these is a DataArray in chunks."""
    return any(isinstance(one, xr.DataArray) and one.chunks is not None for one in given)


def answered(
    at: Callable,
    dataset: xr.Dataset,
    asked: dict[str, xr.DataArray | None],
    **settings: float | None,
) -> xr.Dataset:
    """Evaluate `at` lazily: a Dataset in the chunks of the request.

    Parameters
    ----------
    at : callable
        Friction.at or Drift.at, for what is in memory.
    dataset : xarray.Dataset
        Dataset to evaluate.
    asked : dict of xarray.DataArray
        The question by the names of the arguments of `at`, in the order of the dimensions of an
        answer; None for the amplitude of a steady motion.
    **settings
        poisson and tolerance, of `at`, where it has these.
    """
    asked = {name: places for name, places in asked.items() if places is not None}
    # The names and attributes of an answer are those of any other one.
    inside = {name: _largest(dataset, name) for name in asked}
    pattern = at(**inside, **settings | dict.fromkeys(settings.keys() & {"tolerance"}))

    def block(*places: np.ndarray) -> tuple[np.ndarray, ...]:
        arrays = dict(zip(asked, np.broadcast_arrays(*places), strict=True))
        shape = next(iter(arrays.values())).shape
        flat = {name: xr.DataArray(array.ravel(), dims="n") for name, array in arrays.items()}
        found = at(**flat, **settings)
        return tuple(found[name].values.reshape(shape) for name in pattern.data_vars)

    parts = xr.apply_ufunc(
        block,
        *asked.values(),
        dask="parallelized",
        output_core_dims=[[]] * len(pattern.data_vars),
        output_dtypes=[pattern[name].dtype for name in pattern.data_vars],
    )
    named = {
        name: part.assign_attrs(pattern[name].attrs)
        for name, part in zip(pattern.data_vars, parts, strict=True)
    }
    rest = {name: c for name, c in pattern.coords.items() if name not in asked}
    return xr.Dataset(named, attrs=pattern.attrs).assign_coords(rest)


def _largest(dataset: xr.Dataset, name: str) -> float:
    """A place where any map answers; 1 where it has lost its coordinate, which `at` says better."""
    return float(dataset[name].max()) if name in dataset.variables else 1.0
