"""Variables of a result from a map, and the sources of friction."""

from __future__ import annotations

import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.datasets.variables import attributes, flag_attributes, link_errors

NEEDS = "microslip.at needs"
LOST = f"{NEEDS} it, and the dataset has lost it: keep it"
"""Message if the dataset of a map lacks a variable."""
SOURCES = (
    "map",
    "no vibration",
    "static limit",
    "between static limit and map",
    "between map and fast sliding",
    "between map and large amplitude",
    "between map and no vibration",
    "closed form",
    "solver",
)
"""Sources of friction.  The variable `source` contains their indices."""
(MAP, STILL, STATIC, SLOWER, FASTER, WIDER, NARROWER, EXACT, SOLVER) = range(len(SOURCES))
FRICTION = {
    "mu_macro": attributes(float, MU_MACRO.description),
    "mu_macro_error": attributes(float, "bound of its error"),
    "source": flag_attributes("where the answer comes from", SOURCES),
}
"""Attributes of the variables of a result."""
OUTSIDE = (STATIC, SLOWER, FASTER, WIDER, NARROWER)
"""Sources of friction outside the tabulated range."""


def dataset_of(
    parts: tuple[xr.DataArray, ...], about: dict[str, dict], motion: str, poisson: object
) -> xr.Dataset:
    """Combine the variables of a result into a dataset.

    Parameters
    ----------
    parts : tuple of xarray.DataArray
        Values of the variables.
    about : dict of dict
        Attributes of each variable, by name and in the order of `parts`.
    motion : str
        Name of the motion, stored as an attribute of the dataset.
    poisson : tuple or xarray.DataArray
        Poisson's ratio.  It becomes a coordinate unless it is already a dimension of `parts`.
    """
    for part, attrs in zip(parts, about.values(), strict=True):
        part.attrs = dict(attrs)
    dataset = xr.Dataset(dict(zip(about, parts, strict=True)), attrs={"motion": motion})
    if "poisson" not in dataset.dims:
        dataset = dataset.assign_coords(poisson=poisson)
    return link_errors(dataset)
