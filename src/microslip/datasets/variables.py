"""Dataset variables with the attributes of the CF conventions."""

from __future__ import annotations

from collections.abc import Hashable, Sequence

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

ANCILLARY = "ancillary_variables"
"""Attribute of a variable.  It contains the name of a second variable, which is the error of the
first."""


def attributes(kind: type, long_name: str, units: str = "1") -> dict:
    """Return the attributes of a variable of type `kind`."""
    if kind is str:
        return {"long_name": long_name}
    if kind is bool:
        # Booleans are stored as bytes, which xarray reads as bool.
        values = np.array([0, 1], np.int8)
        return {"long_name": long_name, "flag_values": values, "flag_meanings": "no yes"}
    return {"long_name": long_name, "units": units}


def variable(
    dims: str | Sequence[Hashable],
    values: ArrayLike,
    long_name: str,
    kind: type = float,
    units: str = "1",
    **more: str,
) -> tuple:
    """Return a variable as a tuple for xarray.Dataset.

    kind: type of the values; more: additional attributes.
    """
    values = np.array(values).astype(object if kind is str else kind)
    return dims, values, attributes(kind, long_name, units) | more


def flags(
    dims: str | Sequence[Hashable], codes: ArrayLike, long_name: str, meanings: Sequence[str]
) -> tuple:
    """Return a variable for xarray.Dataset, as a tuple.  Its values are codes, which are indices of
    `meanings`."""
    return dims, np.asarray(codes).astype(np.int8), flag_attributes(long_name, meanings)


def flag_attributes(long_name: str, meanings: Sequence[str]) -> dict:
    """Return the attributes of a variable that contains codes.  Codes are indices of `meanings`."""
    numbers = np.arange(len(meanings), dtype=np.int8)
    words = " ".join(name.replace(" ", "_") for name in meanings)
    return {"long_name": long_name, "flag_values": numbers, "flag_meanings": words}


def link_errors(dataset: xr.Dataset) -> xr.Dataset:
    """Return a copy of a dataset in which every variable is linked to its error."""
    linked = dataset.copy()
    for name in linked.variables:
        if f"{name}_error" in linked.variables:
            linked[name].attrs[ANCILLARY] = f"{name}_error"
    return linked
