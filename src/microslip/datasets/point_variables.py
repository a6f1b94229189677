"""Build the variables of all points for the dataset of a sweep."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from microslip.config.quantities import MU_MACRO
from microslip.config.quantities import TORQUE as TORQUE_OF
from microslip.config.settings import Sweep
from microslip.datasets.variables import variable
from microslip.foundation.canonical import canonical_json

POINT_VARIABLES = {
    "mu_macro": (float, MU_MACRO.description),
    "mu_macro_error": (float, "estimated error of mu_macro"),
    "error_resolution": (float, "error of mu_macro from the resolution"),
    "error_periodicity": (float, "error of mu_macro from periodicity"),
    "error_solver": (float, "error of mu_macro from the iteration"),
    "error_model": (float, "error of mu_macro from model or data"),
    "converged": (bool, "mu_macro_error is within the tolerance"),
    "cells": (np.int32, "rings, or squares across the contact"),
    "angles": (np.int32, "angular points on half a ring"),
    "steps_per_period": (np.int32, "time steps in a period"),
    "periods": (float, "full periods marched in the longest run"),
    "iterations": (np.int32, "iterations of the step solver"),
    "work": (float, "step solves times unknowns"),
    "effort": (float, "iterations times unknowns"),
    "retried": (np.int32, "runs repeated with tighter steps"),
    "model": (str, "contact model that was used"),
    "reason": (str, "why the point did not converge"),
}
"""Variables with the axes of a sweep: name -> (type, long_name).

A count that does not apply is 0.  A long_name is short enough for the axis of a plot.  Variables
that need a longer explanation have the attribute `description`, see DESCRIPTIONS.
"""
VELOCITY_VARIABLES = {
    "velocity": (float, "mean forward velocity"),
    "velocity_error": (float, "estimated error of velocity"),
}
"""Additional variables of a sweep over forces, in which mu_macro equals the force."""
TORQUE = "torque relative to that at velocity 0"
TORQUE_VARIABLES = {
    "mu_torque": (float, TORQUE),
    "mu_torque_error": (float, "estimated error of mu_torque"),
}
ENERGY_VARIABLES = {
    "dissipated_energy": (float, "energy dissipated in a period"),
    "dissipated_energy_error": (float, "estimated error of dissipated_energy"),
}
"""Additional variables of a sweep over an oscillating motion."""
CHANGES = {
    "mu_macro_change": ("mu_macro", -1.0, "mu_macro less that at the smallest nu"),
    "mu_macro_change_error": ("mu_macro_error", 1.0, "estimated error of mu_macro_change"),
}
"""Changes relative to the smallest Poisson's ratio, in a sweep over Poisson's ratios: name ->
(variable, factor, long_name).  A change is the variable's value plus `factor` times its value at
the smallest ratio."""
DESCRIPTIONS = {
    "error_resolution": "part of mu_macro_error from cells, angles and time steps",
    "error_periodicity": "part of mu_macro_error from the distance to the periodic state",
    "error_solver": "part of mu_macro_error from the iteration in each step",
    "error_model": "part of mu_macro_error from a closed form in place of a run, or a file's "
    "resolution",
    "converged": "whether mu_macro_error is within the tolerance, if there is one",
    "iterations": "iterations of the step solver in all runs",
    "work": "step solves times unknowns, summed over all runs",
    "effort": "iterations of the step solver times unknowns, summed over all runs",
    "retried": "runs repeated with a tighter tolerance of the steps, after they did not converge",
    "reason": "why the point did not converge, empty if it did",
    "mu_torque": TORQUE_OF.description,
    "dissipated_energy": "energy that friction dissipates in a period, divided by mu F_z u_lim, "
    "with the normal load F_z without oscillation",
    "mu_macro_change": "mu_macro less that at the smallest Poisson's ratio",
}
"""Attribute `description` of variables whose long_name is not sufficient."""
MISSING: dict[type, Any] = {float: np.nan, bool: False, np.int32: 0, str: ""}
LONGEST_TEXT = 256
"""Maximum number of characters in a text.  A longer text is truncated and ends with dots."""


def variables(
    sweep: Sweep, axes: dict[str, tuple[float, ...]], points: Iterable[dict]
) -> tuple[dict, set[str]]:
    """Build the variables of all points in a sweep.

    Parameters
    ----------
    sweep : Sweep
        The sweep.
    axes : dict
        Coordinates by dimension, in the order of the dimensions of the variables.
    points : iterable of dict
        Records of the points, in the order of the grid.  One record is in memory at a time.

    Returns
    -------
    variables : dict
        Variables as arguments of xarray.Dataset.
    versions : set of str
        Versions of the libraries that computed the records, as JSON.

    Raises
    ------
    ValueError
        If the number of records differs from the number of points.
    """
    table = POINT_VARIABLES | (TORQUE_VARIABLES if not sweep.amplitude else ENERGY_VARIABLES)
    if not sweep.velocity:
        table = VELOCITY_VARIABLES | table
    shape = tuple(len(values) for values in axes.values())
    columns = {
        name: np.full(shape, MISSING[kind], object if kind is str else kind)
        for name, (kind, _) in table.items()
    }
    versions, count, size = set(), 0, math.prod(shape)
    for count, record in enumerate(points, 1):
        if count > size:
            break
        versions.add(canonical_json(record["versions"]))
        for name, column in columns.items():
            if (value := record["result"].get(name)) is not None:
                column.flat[count - 1] = _shortened(value) if isinstance(value, str) else value
    if count != size:
        raise ValueError(f"{count} results for {size} points")
    if len(axes.get("poisson", ())) > 1:
        for name, (source, sign, long_name) in CHANGES.items():
            table[name] = float, long_name
            columns[name] = columns[source] + sign * columns[source][0]
    return {
        name: variable(tuple(axes), columns[name], long_name, kind, **_more(name))
        for name, (kind, long_name) in table.items()
    }, versions


def _shortened(text: str) -> str:
    return text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 3]}..."


def _more(name: str) -> dict[str, str]:
    """Attributes of a variable besides its long_name and units."""
    flags = {"flag_meanings": "not_converged converged"} if name == "converged" else {}
    return flags | ({"description": DESCRIPTIONS[name]} if name in DESCRIPTIONS else {})
