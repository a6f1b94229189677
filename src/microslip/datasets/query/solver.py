"""What the solver says where a map is not good enough, kept beside the map if that is possible."""

from __future__ import annotations

import warnings
from functools import cache
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr

from microslip.adaptive.result import Result
from microslip.foundation.errors import InputError
from microslip.sweeps.sealed_files import CacheError
from microslip.sweeps.solve_stored import solve_stored


def solved(folder: str, *point: Any, **settings: Any) -> Result:
    """What solve_stored says, kept in the folder, or for now where that takes nothing."""
    try:
        return solve_stored(*point, results=folder, **settings)
    except CacheError as error:
        warnings.warn(f"answers are not kept: {error}", stacklevel=4)
        return solve_stored(*point, results=_spare_folder().name, **settings)


def pulled_by(dataset: xr.Dataset) -> dict[str, object]:
    """What moves the contacts of a dataset, as microslip.solve takes it; {} for a velocity.

    Raises InputError for what the dataset has lost of it, or has several values of.
    """
    names = [name for name in dataset.attrs.get("drive", "").split(", ") if name]
    for name in names:
        if name not in dataset.coords or dataset[name].ndim:
            allowed = "microslip.at needs one to ask the solver: keep it as a coordinate"
            raise InputError(name, None, allowed)
    contacts = {"contacts": dataset.attrs["contacts"]} if "contacts" in dataset.attrs else {}
    return {name: float(dataset[name]) for name in names} | contacts


@cache
def _spare_folder() -> TemporaryDirectory:
    """A folder that is gone when Python ends."""
    return TemporaryDirectory(prefix="microslip-")
