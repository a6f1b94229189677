"""Open the datasets of sweeps.

friction = microslip.open_map("transverse")
friction.mu_macro.sel(velocity=0.1, method="nearest")     # plain xarray
friction.microslip.at(velocity=0.05, amplitude=0.8)       # interpolated, with an error bound
microslip.open_map("transverse", group="history")         # a group with axes of its own

The error bound is explained in the module `interpolation`.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import xarray as xr

from microslip.datasets.interpolation import CHECKSUM, CHECKSUMS
from microslip.datasets.netcdf import group_names, refuse_oversized
from microslip.foundation.errors import CacheError, InputError
from microslip.foundation.spec import near_miss
from microslip.sweeps.content import is_whole

PAPER = ("transverse", "bore", "continuous_bore")
"""Names of the sweeps of the paper."""


def open_map(
    name: str | os.PathLike[str],
    results: str | os.PathLike[str] = "results",
    chunks: object = None,
    *,
    group: str | None = None,
) -> xr.Dataset:
    """Open the dataset of a sweep.  The dataset has the accessor `microslip`.

    Parameters
    ----------
    name : str or path
        Name of a sweep in the configuration, such as transverse, bore or continuous_bore, or the
        path of a dataset.
    results : str or path
        Folder with the results of the workflow.
    chunks : optional
        Argument `chunks` of xarray.open_dataset.  Use {} for dask arrays.
    group : str, optional
        Group of the file to open instead of the map: velocity_curves or amplitude_curves
        (theoretical limits on fine axes), history (Figure 1), field (Figure 3) or transients
        (Figure 5). Each file has only some of these groups.

    Returns
    -------
    xarray.Dataset
        The map or the group, with dimensionless variables.  A group has the attributes of the map,
        except for the title.

    Raises
    ------
    InputError
        If the name or the group is unknown, or `results` is not the name of a folder.
    CacheError
        If the file is missing, is damaged or is not the dataset of a sweep.  The message is one
        line.
    """
    if not (isinstance(name, str | os.PathLike) and isinstance(os.fspath(name), str)):
        raise InputError("name", name, "allowed is the name of a sweep, or a path")
    folder = os.fspath(results) if isinstance(results, str | os.PathLike) else ""
    is_name = isinstance(folder, str) and folder.strip() and "\0" not in folder
    # only a shell replaces ~ by the home folder
    if not is_name or Path(folder).parts[:1] == ("~",) or os.path.isfile(folder):
        allowed = "allowed is the name of a folder, with that of the home folder in place of ~"
        raise InputError("results", results, allowed)
    path = Path(name)
    try:
        if path.suffix != ".nc":
            path = Path(results, f"{name}.nc")
            if not os.path.lexists(path) and str(name) not in PAPER:
                names = sorted(file.stem for file in Path(results).glob("*.nc"))
                there = ", ".join(names) or f"nothing in {results} yet"
                allowed = f"allowed is {there}, or a path that ends in .nc"
                raise InputError("name", name, f"{near_miss(name, names)}{allowed}")
        if not path.is_file():
            advice = "run the workflow first, or name its results folder"
            link = f" is a link to {os.path.realpath(path)}, which" if os.path.islink(path) else ""
            raise CacheError(f"{path}{link} is not there: {advice}")
        if not is_whole(path):
            raise OSError("it is truncated or not a netCDF-4 file")
        refuse_oversized(path)
        dataset = _opened(path, chunks=chunks)
        if CHECKSUM not in dataset.variables and CHECKSUMS not in dataset.attrs:
            dataset.close()
            old = "or of an older version: run the sweep again"
            raise CacheError(f"{path} is not the dataset of a sweep, {old}")
        if group is None:
            return dataset
        if group not in (groups := group_names(path)):
            raise InputError("group", group, f"allowed is one of {', '.join(groups) or 'none'}")
        part = _opened(path, chunks=chunks, group=group)
        return part.assign_attrs(dataset.attrs | part.attrs)
    except OSError as error:  # a damaged file, or an invalid file name
        why = " ".join((error.strerror or str(error)).split())[:120]
        remedy = f"if it is damaged, delete {os.path.realpath(path)} and run the sweep again"
        raise CacheError(f"cannot read the dataset {path}: {why}; {remedy}") from None


def _opened(path: Path, **how: Any) -> xr.Dataset:
    try:
        dataset = xr.open_dataset(path, engine="netcdf4", **how)
    except (AttributeError, RuntimeError) as error:  # from netCDF4, if attributes are damaged
        raise OSError(str(error)) from None
    for variable in dataset.variables.values():
        variable.encoding.pop("original_shape", None)  # avoids a warning when a selection is saved
    return dataset
