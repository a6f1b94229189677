"""Select the parts of a sweep's dataset that figures and the explorer show."""

from __future__ import annotations

from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from microslip.datasets.catalogue import FORMS, ClosedForm

PLANE = "velocity", "amplitude"
WIDE = 10.0
"""Ratio of the largest to the smallest value above which an axis is logarithmic."""


def columns(dataset: xr.Dataset, *names: str) -> tuple[np.ndarray, ...]:
    """Return the values of several variables as arrays."""
    return tuple(dataset[name].values for name in names)


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Return the part of a dataset at each Poisson's ratio, in ascending order of the ratio."""
    if "poisson" not in dataset.dims:
        return [dataset]
    return [dataset.sel(poisson=nu) for nu in np.sort(dataset["poisson"].values)]


def moving(dataset: xr.Dataset) -> xr.Dataset:
    """Select the part of a dataset with velocities above 0."""
    if "velocity" not in dataset.dims:
        return dataset
    return dataset.isel(velocity=dataset["velocity"].values > 0)


def lines(
    dataset: xr.Dataset, variable: str, along: str = ""
) -> tuple[str, list[tuple[dict[str, float], xr.Dataset]]]:
    """Split a dataset into lines.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of a sweep.
    variable : str
        Variable of the ordinate.
    along : str
        Axis along the lines. The default is the force if it is an axis, or else the longest axis.

    Returns
    -------
    tuple
        The axis along the lines, and a list with the other coordinates and the dataset of each
        line.
    """
    sizes = {str(dim): size for dim, size in dataset[variable].sizes.items()}
    along = along or ("force" if "force" in sizes else max(sizes, key=sizes.__getitem__))
    others = [dim for dim in sizes if dim != along]
    places = product(*(range(sizes[dim]) for dim in others))
    parts = [dataset.isel(dict(zip(others, place, strict=True))) for place in places]
    return along, [({dim: float(part[dim]) for dim in others}, part) for part in parts]


def resampled(dataset: xr.Dataset, **coordinates: Any) -> xr.Dataset:
    """Return a certified map at the given coordinates. Values outside unsolved cells count as
    converged."""
    fine = dataset.microslip.at(**coordinates).squeeze().assign_attrs(dataset.attrs)
    for name in PLANE:
        fine[name].attrs = dataset[name].attrs
    return fine.assign(converged=np.isfinite(fine["mu_macro"]))


def closed_forms(dataset: xr.Dataset) -> list[ClosedForm]:
    """Return the closed forms that a dataset contains. The forms of the dataset's motion come
    first.

    If a form is exact only for Poisson's ratio 0 and the dataset has other ratios, the label of the
    form states "for ν = 0".
    """
    own = FORMS.get(dataset.attrs.get("motion", "").partition(":")[0], {})
    every = {name: form for forms in FORMS.values() for name, form in forms.items()}
    forms = [form for name, form in (own | every | own).items() if name in dataset]
    for index, form in enumerate(forms):
        if form.exact and not form.any_poisson and np.any(dataset["poisson"] > 0.0):
            forms[index] = replace(form, label=f"{form.label} for ν = 0", exact=False)
    return forms


def limit(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Return a theoretical limit, on a fine axis if the dataset has one."""
    return dataset[f"{name}_curve"] if f"{name}_curve" in dataset else dataset[name]


def is_wide(values: np.ndarray) -> bool:
    """Return True if an axis with these values is logarithmic."""
    values = values[np.isfinite(values)]
    return bool(values.size and values.min() > 0.0 and values.max() > WIDE * values.min())
