"""The dataset of a certified map: its points, and the cells that answer between them.

    certified_transverse.nc     dims point, cell and node

A cell is a box in the coordinates of sweeps.map_coordinates, and friction in it the polynomial
through its points, 5 along the velocity and the amplitude and 3 along Poisson's ratio where that is
a direction, too; cell_error is the bound of the error everywhere in it.  A map of drift is over
force and amplitude, in the coordinates of sweeps.drift_coordinates, and what its cells interpolate
is asinh(velocity).  The same answers give the same bytes.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import xarray as xr

from microslip.config.extended import solver_names
from microslip.config.quantities import MU_MACRO
from microslip.config.records import CertifiedMap
from microslip.datasets import netcdf, sweep_dataset
from microslip.datasets.variables import variable
from microslip.foundation.canonical import canonical_json
from microslip.foundation.files import writing_beside
from microslip.sweeps import map_refinement
from microslip.sweeps.batches import lookup
from microslip.sweeps.drift_coordinates import DriftCoordinates, velocity_of
from microslip.sweeps.map_cells import Cell
from microslip.sweeps.map_coordinates import MapCoordinates

COORDINATES = "map_coordinates"
"""Attribute that says how a map is cut, as JSON."""
BORDERS = {
    "velocity": ("cell_left", "cell_right"),
    "force": ("cell_left", "cell_right"),
    "amplitude": ("cell_low", "cell_high"),
    "poisson": ("cell_poisson_low", "cell_poisson_high"),
}
"""Names of the variables that say where a cell begins and ends, by direction."""
SCALED = {
    "velocity": "scaled velocity",
    "force": "scaled force",
    "amplitude": "scaled amplitude",
    "poisson": "scaled Poisson's ratio",
}


def build(map_: CertifiedMap, records: Iterable[dict]) -> xr.Dataset:
    """Dataset of a certified map.

    Parameters
    ----------
    map_ : CertifiedMap
        What was asked for.
    records : iterable of dict
        Those of all its points, in any order.

    Raises
    ------
    KeyError
        If a request is not answered.
    """
    records = list(records)
    record_of = lookup(records)
    known = map_refinement.refine(map_, lambda requests: map(record_of, requests))
    found, coordinates = (
        map_refinement.refinement_of(map_, known),
        map_refinement.coordinates_of(map_),
    )
    nodes = sorted(known)
    index = {node: i for i, node in enumerate(nodes)}
    degrees, places = coordinates.degrees, [coordinates.place(node) for node in nodes]
    values, errors = np.array([known[node] for node in nodes]).T
    picked = np.array([[index[n] for n in cell.nodes(degrees)] for cell in found.cells], np.int32)
    axes: dict[str, tuple] = {
        name: ("point", np.array(values))
        for name, values in zip(coordinates.directions, zip(*places, strict=True), strict=True)
    }
    # what is the same all over the map
    axes = {"poisson": ((), map_.sweep.poisson[0])} | axes
    if map_.force is None:
        axes = {"velocity": ((), 0.0)} | axes
    dataset = xr.Dataset(
        {
            **_at_points(map_, values, errors),
            **_borders(coordinates, found.cells),
            "cell_error": variable("cell", found.errors, _bound_of(map_)),
            "cell_node": (
                ("cell", "node"),
                picked,
                {"long_name": "points of the cell, the last direction fastest"},
            ),
        },
        coords=axes,
    )
    sweep_dataset.describe_axes(dataset, map_.sweep)
    motion, pressure = solver_names(map_.sweep)
    versions = {canonical_json(record["versions"]) for record in records}
    quantity = "friction" if map_.force is None else "drift"
    about = sweep_dataset.provenance(
        f"Certified {quantity} of a vibrated contact, motion {motion}",
        map_.settings,
        versions,
        motion=motion,
        pressure=pressure,
        tolerance=map_.tolerance,
        error=map_.error,
        points=len(set(places)),  # a place where slow and fast cells meet can be two nodes
        directions=" ".join(coordinates.directions),
        degrees=np.array(degrees, np.int32),
    )
    if map_.force is not None:
        about["drive"] = "force"
    return dataset.assign_attrs(about | {COORDINATES: coordinates.to_json()})


def write(path: str | os.PathLike, dataset: xr.Dataset) -> None:
    """Write the dataset to a netCDF-4 file, all of it or nothing; raises CacheError."""
    with writing_beside(path) as beside:
        netcdf.write(beside, dataset, {})


def report(dataset: xr.Dataset, name: str) -> Iterator[str]:
    """Lines of text: how many points there are, what holds everywhere, and where it does not."""
    drifts = is_of_drift(dataset)
    values, errors = dataset["velocity" if drifts else "mu_macro"], dataset["cell_error"].values
    failed, scale = int(values.isnull().sum()), " sqrt(1 + v^2)" if drifts else ""
    converged = f"{failed} not converged" if failed else "all converged"
    yield (
        f"{name}: {dataset.points} points, {converged}; within {errors.max():.1e}{scale} everywhere"
    )
    over = int((errors > dataset.error).sum())
    if over:
        yield f"  {over} of {len(errors)} cells are not within {dataset.error:g}"


def is_of_drift(dataset: xr.Dataset) -> bool:
    """Whether a dataset is a certified map of the velocity under a force."""
    return COORDINATES in dataset.attrs and "force" in dataset.attrs.get("directions", "").split()


def coordinates_in(dataset: xr.Dataset) -> MapCoordinates | DriftCoordinates:
    """How the map of a dataset is cut; raises KeyError and ValueError for one that does not say."""
    kind = DriftCoordinates if is_of_drift(dataset) else MapCoordinates
    return kind.from_json(dataset.attrs[COORDINATES])


def _at_points(map_: CertifiedMap, values: np.ndarray, errors: np.ndarray) -> dict:
    """Variables of what was solved for."""
    if map_.force is None:
        return {
            "mu_macro": variable("point", values, MU_MACRO.description),
            "mu_macro_error": variable("point", errors, "estimated error of mu_macro"),
        }
    velocity, error = velocity_of(values, errors)
    return {
        "velocity": variable("point", velocity, "mean forward velocity"),
        "velocity_error": variable("point", error, "estimated error of velocity"),
    }


def _bound_of(map_: CertifiedMap) -> str:
    if map_.force is None:
        return "bound of the error in the cell"
    return "bound of the error of asinh(velocity) in the cell"


def _borders(coordinates: MapCoordinates | DriftCoordinates, cells: Sequence[Cell]) -> dict:
    """Variables that say where the cells begin and end."""
    found, borders = {}, np.array(cells)  # (cell, beginning or end, direction)
    for i, direction in enumerate(coordinates.directions):
        for name, ends, verb in zip(
            BORDERS[direction], borders[:, :, i].T, ("begins", "ends"), strict=True
        ):
            found[name] = variable("cell", ends, f"{SCALED[direction]} where the cell {verb}")
    return found
