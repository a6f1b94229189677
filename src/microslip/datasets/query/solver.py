"""Solver results where a map is not accurate enough, stored next to the map if possible."""

from __future__ import annotations

import warnings
from functools import cache
from tempfile import TemporaryDirectory
from typing import Any

import xarray as xr

from microslip.adaptive.result import Result
from microslip.foundation.errors import InputError
from microslip.foundation.files import CacheError
from microslip.sweeps.solve_stored import solve_stored


def solved(folder: str, *point: Any, **settings: Any) -> Result:
    """The result of solve_stored, kept in the folder, or in a temporary one if that fails."""
    try:
        return solve_stored(*point, results=folder, **settings)
    except CacheError as error:
        warnings.warn(f"answers are not kept: {error}", stacklevel=4)
        return solve_stored(*point, results=_spare_folder().name, **settings)


def pulled_by(dataset: xr.Dataset) -> dict[str, object]:
    """The drive and the contacts of a dataset, as for microslip.solve; {} for a velocity.

    Raises InputError if the dataset has none or several values of an argument of its drive.
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
