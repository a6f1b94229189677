"""Answers of a map as a dataset: friction, a bound of its error, and where each comes from."""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.config.quantities import MU_MACRO

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
    value, error, source = answer

    def variable(values: np.ndarray, long_name: str, **more: object) -> tuple:
        attributes = {"long_name": long_name} | more
        return shape.dims, values.reshape(shape.shape), attributes

    found = xr.Dataset(
        {
            "mu_macro": variable(value, MU_MACRO.description, units="1"),
            "mu_macro_error": variable(error, "bound of its error", units="1"),
            "source": variable(
                source.astype(np.int8),
                "where the answer comes from",
                flag_values=np.arange(len(SOURCES), dtype=np.int8),
                flag_meanings=" ".join(name.replace(" ", "_") for name in SOURCES),
            ),
        },
        coords=shape.coords,
        attrs={"motion": motion},
    )
    if "poisson" in found.dims:
        return found
    about = {"long_name": "Poisson's ratio", "units": "1"}
    return found.assign_coords(poisson=((), poisson, about))
