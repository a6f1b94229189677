"""Datasets to and from netCDF files: one tidy table at the root, the rest in groups.

The root of a file holds variables over its own axes alone, so that a table, a plot or a join of
several files needs nothing else. What has other axes, such as curves, single runs and lists, is in
groups, each again a table of its own, opened by name:

    xr.open_dataset(path)                    # the root
    xr.open_dataset(path, group="history")   # one of its groups
    microslip.datasets.netcdf.whole(path)             # all of it as one dataset, for what draws it
"""

from __future__ import annotations

import os
from collections.abc import Hashable, Mapping
from typing import Any

import netCDF4
import xarray as xr

from microslip.datasets.variables import link_errors
from microslip.foundation.errors import CacheError

Groups = Mapping[str, tuple[str, tuple[str, ...]]]


def divided(dataset: xr.Dataset, groups: Groups) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Divide a dataset into that of the root and those of its groups.

    Parameters
    ----------
    dataset : xarray.Dataset
        All variables.
    groups : mapping of str to (str, tuple of str)
        Title and dims by the name of a group.  A variable goes to the first group that has all of
        its dims.

    Returns
    -------
    root : xarray.Dataset
        What belongs to no group: numbers without dims, too.  It keeps all attributes.
    parts : dict of xarray.Dataset
        Those of `groups` that are not empty.
    """
    place = {}
    for name, variable in dataset.data_vars.items():
        fits = (g for g, (_, dims) in groups.items() if set(variable.dims) <= set(dims))
        place[name] = next(fits, None) if variable.dims else None
    root = dataset[[name for name in place if place[name] is None]]
    scalars = [name for name, variable in dataset.coords.items() if not variable.dims]
    parts = {}
    for group, (title, _) in groups.items():
        names = [name for name in place if place[name] == group]
        if names:
            part = dataset[names].drop_vars(scalars)
            parts[group] = part.drop_attrs(deep=False).assign_attrs(title=title)
    return root, parts


def write(path: str | os.PathLike[str], root: xr.Dataset, parts: Mapping[str, xr.Dataset]) -> None:
    """Write a root and its groups to a new netCDF-4 file; the same ones give the same bytes.

    The file is not written atomically here: see files.writing_beside.
    """
    _append(root, path, mode="w")
    for group, part in parts.items():
        _append(part, path, mode="a", group=group)


def _append(dataset: xr.Dataset, path: str | os.PathLike[str], **how: Any) -> None:
    dataset = link_errors(dataset)
    encoding = {name: _encoding(name, v.dtype.kind) for name, v in dataset.variables.items()}
    dataset.to_netcdf(path, engine="netcdf4", format="NETCDF4", encoding=encoding, **how)


def _encoding(name: Hashable, kind: str) -> dict:
    if kind == "f":
        return {"_FillValue": None}
    if kind in "OUT":
        # Strings of variable length end Python with a segmentation fault when a file is opened
        # again while it is open (HDF5 loses their type), so texts are arrays of characters.
        return {"dtype": "S1", "char_dim_name": characters_of(name)}
    return {}


def characters_of(name: Hashable) -> str:
    """Dimension of the characters of a text variable: its own, so that parts can be saved again."""
    return f"characters_of_{name}"


def refuse_oversized(path: str | os.PathLike[str]) -> None:
    """Raise CacheError for a file that declares more values than it has bytes.

    xarray reads coordinates into memory when it opens a file.  Every dataset of a sweep has numbers
    of several bytes each in it, also where somebody has compressed it.
    """
    size = os.stat(path).st_size
    with netCDF4.Dataset(path) as file:
        groups = [file]
        while groups:
            group = groups.pop()
            groups += group.groups.values()
            lengths = {name: len(dimension) for name, dimension in group.dimensions.items()}
            lengths |= {name: variable.size for name, variable in group.variables.items()}
            for name, length in lengths.items():
                if length > size:
                    raise CacheError(
                        f"{path}: {name} has {length} values in a file of {size} bytes; allowed: a "
                        "dataset as the workflow makes it"
                    )


def group_names(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """Names of the groups of a file, in their order there."""
    with netCDF4.Dataset(path) as file:
        return tuple(file.groups)


def whole(path: str | os.PathLike[str]) -> xr.Dataset:
    """All variables of a file as one dataset in memory, with the attributes of the root.

    A table of it would hold every combination of axes that have nothing to do with each other;
    what draws and what judges picks variables by name.  Raises what xarray raises for a file that
    is none, and CacheError for one that declares too much.
    """
    refuse_oversized(path)
    with xr.open_dataset(path, engine="netcdf4") as file:
        found = file.load()
    for group in group_names(path):
        with xr.open_dataset(path, engine="netcdf4", group=group) as part:
            found = found.merge(part.load(), compat="identical", join="exact")
    return found
