"""Write the variables of all points to the dataset of a sweep, block by block.

At most BLOCK points are in memory at a time.
"""

from collections.abc import Iterable, Iterator
from itertools import islice
from typing import Any

import netCDF4
import numpy as np

from microslip.config.quantities import MU_MACRO
from microslip.config.quantities import TORQUE as TORQUE_OF
from microslip.config.records import Sweep
from microslip.datasets.netcdf import characters_of
from microslip.datasets.variables import attributes, error_of
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
    "work": (np.int64, "step solves times unknowns"),
    "effort": (np.int64, "iterations times unknowns"),
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
MISSING: dict[type, Any] = {float: np.nan, bool: False, np.int32: 0, np.int64: 0, str: ""}

WIDTHS = {"model": 32, "reason": 256}
"""Maximum number of bytes in a text variable.  Longer texts are truncated (see `_text`)."""
BLOCK = 4096
"""Number of points written at once, and number of points per chunk in a large dataset."""
Box = tuple[slice, ...]
"""A block of a grid: a slice for each axis."""


def append(file: netCDF4.Dataset, sweep: Sweep, axes: dict, points: Iterable) -> set[str]:
    """Write the variables of all points in a sweep to an open file.

    Parameters
    ----------
    file : netCDF4.Dataset
        File with the dimensions and coordinates of the sweep.
    sweep : records.Sweep
        The sweep.
    axes : dict
        Coordinates by dimension, in the order of the dimensions of the variables.
    points : iterable of dict
        Records of the points, in the order of the grid.

    Returns
    -------
    set of str
        Versions of the libraries that computed the records, as JSON.

    Raises
    ------
    ValueError
        If the number of records differs from the number of points.
    """
    table = POINT_VARIABLES | (TORQUE_VARIABLES if sweep.amplitude is None else ENERGY_VARIABLES)
    if not sweep.velocity:
        table = VELOCITY_VARIABLES | table
    shape = tuple(len(values) for values in axes.values())
    boxes = list(_boxes(shape))
    for name, (kind, long_name) in table.items():
        _create(file, name, kind, long_name, tuple(axes), boxes[0] if len(boxes) > 1 else None)
        file[name].setncatts(error_of(name, table))
    records, count = iter(points), 0
    versions: set[str] = set()
    for box in boxes:
        extent = tuple(part.stop - part.start for part in box)
        block = list(islice(records, int(np.prod(extent))))
        count += len(block)
        if len(block) < np.prod(extent):
            break
        versions.update(canonical_json(record["versions"]) for record in block)
        for name, (kind, _) in table.items():
            column = _column(block, name, kind)
            file[name][box] = column.reshape(*extent, *column.shape[1:])
    if len(axes.get("poisson", ())) > 1:
        _add_changes(file, tuple(axes), boxes[0] if len(boxes) > 1 else None)
    count += sum(1 for _ in islice(records, 1))
    size = int(np.prod(shape))
    if count != size:
        raise ValueError(f"{sweep.name}: {min(count, size + 1)} results for {size} points")
    return versions


def _add_changes(file: netCDF4.Dataset, dims: tuple[str, ...], box: Box | None) -> None:
    """Write CHANGES: the change of mu_macro relative to the smallest Poisson's ratio, and its
    error.

    box: see `_create`.
    """
    file.set_auto_mask(False)
    for name, (source, sign, long_name) in CHANGES.items():
        _create(file, name, float, long_name, dims, box)
        file[name].setncatts(error_of(name, CHANGES))
        first = file[source][0]
        for i in range(file[source].shape[0]):
            file[name][i] = file[source][i] + sign * first


def _boxes(shape: tuple[int, ...]) -> Iterator[Box]:
    """Yield blocks of at most BLOCK points that fill a grid in C order."""
    whole = len(shape)
    while whole and np.prod(shape[whole - 1 :]) <= BLOCK:
        whole -= 1  # the axes from `whole` on are not cut
    if whole == 0:
        yield tuple(slice(0, n) for n in shape)
        return
    trailing = shape[whole:]
    step = max(1, BLOCK // int(np.prod(trailing)))
    for leading in np.ndindex(shape[: whole - 1]):
        for start in range(0, shape[whole - 1], step):
            cut = slice(start, min(start + step, shape[whole - 1]))
            before = (slice(index, index + 1) for index in leading)
            yield (*before, cut, *(slice(0, n) for n in trailing))


def _create(
    file: netCDF4.Dataset,
    name: str,
    kind: type,
    long_name: str,
    dims: tuple[str, ...],
    box: Box | None,
) -> None:
    """Create an empty variable.  box: a block of the chunk size, or None for no chunks."""
    stored: Any = {bool: np.int8, str: "S1"}.get(kind, kind)
    chunks = None if box is None else tuple(part.stop - part.start for part in box)
    more: dict[str, Any] = {}
    if kind is str:
        width = WIDTHS[name]
        file.createDimension(characters_of(name), width)
        dims = (*dims, characters_of(name))
        if chunks is not None:  # large datasets are compressed
            chunks, more = (*chunks, width), {"compression": "zlib", "complevel": 1}
    variable = file.createVariable(name, stored, dims, chunksizes=chunks, fill_value=False, **more)
    flags = "not_converged converged" if name == "converged" else "no yes"
    variable.setncatts(attributes(kind, long_name, flags=flags))
    if name in DESCRIPTIONS:
        variable.setncattr("description", DESCRIPTIONS[name])
    if kind is bool:
        variable.setncattr("dtype", "bool")  # as xarray does
    if kind is str:
        variable.setncattr("_Encoding", "utf-8")  # readers join the characters to texts
        variable.set_auto_chartostring(False)


def _column(block: list[dict], name: str, kind: type) -> np.ndarray:
    """Return a variable's values from some records.  Texts become bytes along an additional
    axis."""
    values = [record["result"].get(name) for record in block]
    filled = [MISSING[kind] if value is None else value for value in values]
    if kind is str:
        texts = np.array([_text(value, WIDTHS[name]) for value in filled], f"S{WIDTHS[name]}")
        return texts.view("S1").reshape(len(filled), WIDTHS[name])
    return np.array(filled, np.int8 if kind is bool else kind)


def _text(value: str, width: int) -> bytes:
    """Encode a text in at most `width` bytes.  A longer text is truncated and ends with dots."""
    coded = value.encode()
    if len(coded) <= width:
        return coded
    return coded[: width - 3].decode(errors="ignore").encode() + b"..."
