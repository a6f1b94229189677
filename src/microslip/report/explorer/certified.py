"""Data of a certified map on the page: its cells, and the formulas of its coordinates."""

from __future__ import annotations

import numpy as np
import xarray as xr

from microslip.datasets.query import beyond
from microslip.datasets.query.cells import cells_of
from microslip.sweeps import map_coordinates
from microslip.sweeps.evaluate import plain

RULE = 64
"""Nodes of Gauss's rule, as many as in theory.paper."""


def packed(dataset: xr.Dataset) -> dict:
    """A certified map as one value that JSON can hold, for certified.js and beyond.js.

    Parameters
    ----------
    dataset : xarray.Dataset
        As datasets.certified_map makes it.

    Returns
    -------
    dict
        `values` of friction at its points, null where it is not known; by cell `cells`, indices of
        its points, `borders`, two for each direction, and `bounds` of the error; `nodes`, how many
        there are in each direction, velocity first; all flat.

    Raises
    ------
    InputError
        For what the dataset has lost.
    """
    found = cells_of(dataset)
    table, coordinates = found.cells, found.cells.coordinates
    assert isinstance(coordinates, map_coordinates.MapCoordinates)  # as of all maps of friction
    motion, pressure = dataset.attrs["motion"], dataset.attrs.get("pressure", "hertz")
    return {
        "motion": motion,
        "pressure": pressure,
        "error": float(dataset.attrs["error"]),
        "velocity": list(coordinates.velocity),
        "amplitude": list(coordinates.amplitude),
        "poisson": [float(found.poisson[0]), float(found.poisson[-1])],
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
        "has_limits": beyond.has_limits(dataset),
        "edge": plain(table.columns.values),
        "rule": gauss_rule(),
    }


def gauss_rule() -> dict:
    """Nodes and weights of Gauss's rule on 0 to 1, for the limits that are integrals."""
    nodes, weights = np.polynomial.legendre.leggauss(RULE)
    return {"nodes": plain((nodes + 1) / 2), "weights": plain(weights / 2)}
