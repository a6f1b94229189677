"""Answers of a map as a dataset: friction, a bound of its error, and where each comes from."""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO
from microslip.datasets.variables import flags, link_errors, variable

NEEDS = "microslip.at needs"
LOST = f"{NEEDS} it, and the dataset has lost it: keep it"
"""Words for a dataset without a variable of a map."""
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
"""Sources of an answer, by their code in the variable `source`."""
(MAP, STILL, STATIC, SLOWER, FASTER, WIDER, NARROWER, EXACT, SOLVER) = range(len(SOURCES))
OUTSIDE = (STATIC, SLOWER, FASTER, WIDER, NARROWER)
"""Sources of answers outside the tabulated range."""


def answered(
    motion: str,
    shape: xr.DataArray,
    answer: tuple[np.ndarray, np.ndarray, np.ndarray],
    poisson: float,
) -> xr.Dataset:
    """Dataset of an answer.

    Parameters
    ----------
    motion : str
        What was asked about.
    shape : xarray.DataArray
        Its dimensions and coordinates.
    answer : tuple of numpy.ndarray, shape (n,) each
        Friction, bounds of its error, and codes of SOURCES.
    poisson : float
        Poisson's ratio of all.

    Returns
    -------
    xarray.Dataset
        mu_macro, mu_macro_error and source.
    """
    value, error, source = (part.reshape(shape.shape) for part in answer)
    about = "where the answer comes from"
    found = xr.Dataset(
        {
            "mu_macro": variable(shape.dims, value, MU_MACRO.description),
            "mu_macro_error": variable(shape.dims, error, "bound of its error"),
            "source": flags(shape.dims, source, about, SOURCES),
        },
        coords=shape.coords,
        attrs={"motion": motion},
    )
    if "poisson" not in found.dims:
        found = found.assign_coords(poisson=variable((), poisson, "Poisson's ratio"))
    return link_errors(found)
