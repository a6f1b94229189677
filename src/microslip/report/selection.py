"""Select the parts of a sweep's dataset that figures and the explorer show."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from microslip.datasets.catalogue import FORMS, ClosedForm

PLANE = "velocity", "amplitude"
RANKS = {"velocity": -2, "amplitude": -1, "poisson": 1}
"""Ranks of axes. Among equally long axes, the axis with the lowest rank is the abscissa. The rank
of any other axis is 0."""
WIDE = 10.0
"""An axis is logarithmic if the ratio of the largest to the smallest value is above this number."""


def columns(dataset: xr.Dataset, *names: str) -> tuple[np.ndarray, ...]:
    """Return the values of several variables as arrays."""
    return tuple(dataset[name].values for name in names)


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Return the part of a dataset at each Poisson's ratio, in ascending order of the ratio."""
    if "poisson" not in dataset.dims:
        return [dataset]
    return [dataset.sel(poisson=nu) for nu in np.sort(dataset["poisson"].values)]


def own_title(dataset: xr.Dataset) -> str:
    """Return the title from the configuration of a sweep, or "" if the dataset has a default
    title."""
    settings = json.loads(dataset.attrs.get("configuration", "{}"))
    return settings.get("sweep", {}).get("title") or ""


def short_title(dataset: xr.Dataset) -> str:
    """Return the title from the configuration of a sweep, or the motion and the pressure.  The
    pressure of a sphere is omitted."""
    motion = dataset.attrs.get("title", "").rpartition(", motion ")[2]
    shape = dataset.attrs.get("pressure", "hertz").partition(":sha256")[0]
    return own_title(dataset) or ", ".join([motion, shape] if shape != "hertz" else [motion])


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
        Axis along the lines. The default is the force if it is an axis. Otherwise, the default is
        the axis with the most values, without the velocity 0. Among axes of equal length, the
        velocity comes first, then the amplitude, and Poisson's ratio last.

    Returns
    -------
    tuple
        The axis along the lines, and a list with the other coordinates and the dataset of each
        line. Lines that differ only in Poisson's ratio are neighbours.
    """
    sizes = {str(dim): size for dim, size in dataset[variable].sizes.items()}
    order = sorted(sizes, key=lambda dim: RANKS.get(dim, 0))
    along = along or ("force" if "force" in sizes else max(order, key=moving(dataset).sizes.get))
    others = sorted((dim for dim in sizes if dim != along), key=lambda dim: dim == "poisson")
    places = product(*(dataset[dim].values.tolist() for dim in others))
    labels = [dict(zip(others, place, strict=True)) for place in places]
    return along, [(place, dataset.sel(place)) for place in labels]


def resampled(dataset: xr.Dataset, fine: int, coarse: int = 0, **others: Any) -> xr.Dataset:
    """Return a certified map on a grid with `fine` velocities and `coarse` amplitudes.

    There are `fine` amplitudes if `coarse` is 0, or if the map contains static friction only.
    Values outside unsolved cells count as converged.

    others: further coordinates.
    """
    ends = [(float(dataset[dim].min()), float(dataset[dim].max())) for dim in PLANE]
    still = ends[0][1] == 0.0
    others["velocity"] = 0.0 if still else np.geomspace(*ends[0], fine).clip(*ends[0])
    others["amplitude"] = np.linspace(*ends[1], fine if still else coarse or fine)
    grid = dataset.microslip.at(**others).squeeze().assign_attrs(dataset.attrs)
    for name in PLANE:
        grid[name].attrs = dataset[name].attrs
    return grid.assign(converged=np.isfinite(grid["mu_macro"]))


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
