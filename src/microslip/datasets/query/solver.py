"""Call the solver for points at which a map is not accurate enough."""

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


def solve_and_store(folder: str, *point: Any, **settings: Any) -> Result:
    """Call solve_stored with a folder of results.  If this folder is read-only, use a temporary
    folder."""
    try:
        return solve_stored(*point, results=folder, **settings)
    except CacheError as error:
        warnings.warn(f"results are not stored: {error}", stacklevel=4)
        return solve_stored(*point, results=_spare_folder().name, **settings)


def drive_of(dataset: xr.Dataset) -> dict[str, object]:
    """Return the drive of a dataset as arguments of microslip.solve.

    The result is {} at a prescribed velocity.  Raises InputError unless the dataset
    has exactly one value of each argument.
    """
    names = [name for name in dataset.attrs.get("drive", "").split(", ") if name]
    for name in names:
        if name not in dataset.coords or dataset[name].ndim:
            allowed = "microslip.at needs one value to call the solver: keep it as a coordinate"
            raise InputError(name, None, allowed)
    return {name: float(dataset[name]) for name in names}


@cache
def _spare_folder() -> TemporaryDirectory:
    """Create a temporary folder that exists until Python ends."""
    return TemporaryDirectory(prefix="microslip-")
