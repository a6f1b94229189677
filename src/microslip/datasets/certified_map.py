"""Build the dataset of a certified map, with the points and the cells used for interpolation.

    transverse.nc     dims point, cell and node

A cell is a box in the scaled coordinates of sweeps.map_coordinates.  Within a cell, friction is
interpolated by the polynomial through the points of the cell.  A cell has 5 points along the
velocity and 5 along the amplitude.  If the map has an axis for Poisson's ratio, a cell has 3 points
along that axis.  The variable `cell_error` contains the error bound of each cell.  Identical
records give byte-identical files.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from microslip.config.settings import Configuration
from microslip.datasets import sweep_dataset
from microslip.datasets.interpolation import BORDERS, CHECKSUMS, COORDINATES, NUMBERS, parts_of
from microslip.datasets.variables import TABLE, described
from microslip.foundation import named_files
from microslip.foundation.canonical import canonical_json
from microslip.sweeps import map_refinement
from microslip.sweeps.batch import lookup
from microslip.sweeps.request import solver_names


def build(
    configuration: Configuration, name: str, records: Iterable[dict]
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Build the dataset of a certified map.  The second result is the dict of groups, which is
    empty.

    Parameters
    ----------
    configuration : Configuration
        The configuration.
    name : str
        Name of the map.
    records : iterable of dict
        Records of all points, in any order.

    Raises
    ------
    KeyError
        If a point has no record.
    """
    sweep = configuration.sweeps[name]
    record_of = lookup(records := list(records))
    answers, cells = map_refinement.refine(sweep, lambda requests: map(record_of, requests))
    coordinates = map_refinement.coordinates_of(sweep)
    degrees, place = coordinates.degrees, coordinates.place
    # a point between slow and fast cells is a node of both
    at = {place(node): answer for node, answer in answers.items()}
    points = sorted(at)
    index = {point: i for i, point in enumerate(points)}
    values, errors = np.array([at[point] for point in points]).T
    variables: dict[str, ArrayLike] = {"mu_macro": values, "mu_macro_error": errors}
    # If Poisson's ratio or the velocity is constant in the map, it is a scalar coordinate.
    axes: dict = {"velocity": ((), 0.0), "poisson": ((), sweep.poisson[0])}
    ends = np.array(cells.cells)  # (cell, lower or upper, direction)
    for k, direction in enumerate(coordinates.directions):
        axes[direction] = "point", np.array(points)[:, k]
        variables |= zip(BORDERS[direction], ends[:, :, k].T, strict=True)
    nodes = [map_refinement.nodes_of(cell, degrees) for cell in cells.cells]
    variables["cell_error"] = cells.errors
    variables["cell_node"] = [[index[place(node)] for node in own] for own in nodes]
    counts = len(nodes), len(nodes[0]), len(points)
    variables |= zip(NUMBERS, map(np.arange, counts), strict=True)
    dims = {name: TABLE[name]["dims"].split() or "point" for name in variables}
    every = {name: described(TABLE[name], variables[name], dims[name]) for name in variables}
    dataset = xr.Dataset(every, axes)
    sweep_dataset.describe_axes(dataset, sweep)
    motion, pressure = solver_names(sweep)
    file = named_files.base_name(motion)
    about = sweep_dataset.provenance(
        sweep.title or f"Certified friction of a vibrated contact, motion {file or motion}",
        {"sweep": sweep.model_dump(mode="json")},
        {canonical_json(record["versions"]) for record in records},
        motion=motion,
        pressure=pressure,
        tolerance=sweep.tolerance,
        error=sweep.error,
        points=len(points),
        directions=" ".join(coordinates.directions),
        degrees=np.array(degrees, np.int32),
    )
    dataset = dataset.assign_attrs(about | {COORDINATES: coordinates.to_json()})
    checksums = (f"{name}:{checksum}" for name, checksum in parts_of(dataset)[1].items())
    return dataset.assign_attrs({CHECKSUMS: " ".join(checksums)}), {}


def report(dataset: xr.Dataset, name: str) -> Iterator[str]:
    """Yield a line with the number of points and the largest error bound of the map.  If the error
    bound of some cells is too large, yield a second line with the number of these cells."""
    errors = dataset["cell_error"].values
    failed = int(dataset["mu_macro"].isnull().sum())
    converged = f"{failed} not converged" if failed else "all converged"
    yield f"{name}: {dataset.points} points, {converged}; within {errors.max():.1e} everywhere"
    over = int((errors > dataset.error).sum())
    if over:
        yield f"  {over} of {len(errors)} cells are not within {dataset.error:g}"
