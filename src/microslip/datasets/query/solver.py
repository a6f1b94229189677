"""The drive of a dataset, as arguments of the solver."""

from __future__ import annotations

import xarray as xr

from microslip.foundation.errors import InputError


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
