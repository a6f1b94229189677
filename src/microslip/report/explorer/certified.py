"""Pack certified maps: cells, and parameters of the coordinates."""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.datasets.cells import cells_of
from microslip.sweeps import map_coordinates
from microslip.sweeps.evaluate import plain

EDGE = 97
"""Number of velocities at which friction is evaluated along the largest amplitude."""
RULE = 64
"""Number of Gauss nodes, the same as in theory.paper."""


def packed(dataset: xr.Dataset) -> dict:
    """Pack a certified map for certified.js and beyond.js.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset of datasets.certified_map.

    Returns
    -------
    dict
        JSON values, with flat arrays. `values` is the friction at the points, null if unknown.
        `nodes` is the number of nodes of a cell in each direction, with the velocity first. Three
        arrays describe the cells: `cells` contains the point indices of each cell, `borders` its
        two ends in each direction, and `bounds` its error bound.

    Raises
    ------
    InputError
        If the dataset is incomplete.
    """
    table = cells_of(dataset)
    coordinates = table.coordinates
    assert isinstance(coordinates, map_coordinates.MapCoordinates)  # for maps of friction
    motion, pressure = dataset.attrs["motion"], dataset.attrs.get("pressure", "hertz")
    ratios = coordinates.poisson or (float(dataset["poisson"]),)
    return {
        "motion": motion,
        "pressure": pressure,
        "error": float(dataset.attrs["error"]),
        "velocity": list(coordinates.velocity),
        "amplitude": list(coordinates.amplitude),
        "poisson": [ratios[0], ratios[-1]],
        "kink_amplitudes": list(coordinates.kinks.amplitudes),
        "kink_velocity": list(coordinates.kinks.velocity),
        "gathering": {
            "at_kinks": map_coordinates.AT_KINKS,
            "clear": map_coordinates.CLEAR,
            "slow_power": map_coordinates.SLOW_POWER,
            "faster": map_coordinates.FAST,
            "spread": map_coordinates.SPREAD,
        },
        "nodes": list(table.nodes.shape[1:]),
        "values": plain(dataset["mu_macro"].values),
        "cells": plain(dataset["cell_node"].values.ravel().astype(int)),
        "borders": plain(np.asarray(table.borders).ravel()),
        "bounds": plain(table.bounds),
        "has_limits": pressure == "hertz" and motion in ("transverse", "bore"),
        "edge": plain(np.geomspace(coordinates.velocity[0], coordinates.velocity[-1], EDGE)),
        "rule": gauss_rule(),
    }


def gauss_rule() -> dict:
    """Return the nodes and weights of the Gauss-Legendre rule on 0 to 1."""
    nodes, weights = np.polynomial.legendre.leggauss(RULE)
    return {"nodes": plain((nodes + 1) / 2), "weights": plain(weights / 2)}
