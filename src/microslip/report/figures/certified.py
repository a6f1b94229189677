"""Figure of a certified map: friction, cells and points, and error bounds of the cells."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure

from microslip.datasets import certified_map
from microslip.datasets.accessor import Map
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.formulas import axis_label
from microslip.report.figures.groups import CONTOURS
from microslip.report.figures.map_panel import fill

BOUND = "error estimate,\nthousandths  (dimensionless)"
DIMENSIONLESS = "(dimensionless)"
INKS = look.BLUE, look.VERMILLION
NODES, LINE = 97, 201
"""Number of coordinates along an axis, for a map and for a line."""
SIDE = np.linspace(0.0, 1.0, 17)
"""Relative positions of points along a side of a cell. A side is curved in the figure."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the map, and its cells with their error bounds and the computed points.

    A map with several Poisson's ratios is drawn at the smallest ratio. A map of the static limit is
    drawn as a line.
    """
    if "velocity" not in dataset.attrs["directions"].split():
        return _lines(dataset)
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    poisson = float(dataset["poisson"].min())
    ends = [(float(dataset[n].min()), float(dataset[n].max())) for n in ("velocity", "amplitude")]
    velocity, amplitude = np.geomspace(*ends[0], NODES), np.linspace(*ends[1], NODES)
    grid = Map(dataset).at(velocity, amplitude, poisson=poisson)
    grid = grid.assign(converged=np.isfinite(grid["mu_macro"]))
    filled, *_ = fill(left, grid, lines=CONTOURS)
    panels.colour_bar(filled, left, look.FRICTION, aspect=20, ticks=np.linspace(0, 1, 6))
    errors = _show_cells(right, dataset, _points(dataset, poisson))
    panels.colour_bar(errors, right, BOUND, aspect=20)
    ratio = rf" at $\nu = {look.number(poisson)}$" if poisson or _is_deep(dataset) else ""
    panels.heading(left, f"{_points_of(dataset)}, {len(dataset['cell_error'])} cells")
    panels.heading(right, "error estimate" + ratio)
    left.set_ylabel(axis_label(dataset, "amplitude", DIMENSIONLESS))
    for axes in (left, right):
        axes.set_xlabel(axis_label(dataset, "velocity", DIMENSIONLESS))
        panels.ticks_outside(axes)
    return figure


def _show_cells(axes: Axes, dataset: xr.Dataset, at: xr.Dataset) -> PolyCollection:
    """Draw cells in the colours of their error bounds, and the computed points.

    at: dataset of the points. Returns the artist of the cells.
    """
    outlines, errors = _cells(dataset)
    ink: look.Ink = {"color": look.VERMILLION, "ms": 2.2, "clip_on": False, "gid": "points"}
    axes.plot(at["velocity"], at["amplitude"], ".", **ink)
    shades = PolyCollection(outlines, array=1e3 * errors, cmap=look.COLOURMAP, gid="errors")
    shades.set(edgecolors="white", linewidths=0.6, clim=(0.0, 1e3 * float(dataset.attrs["error"])))
    axes.add_collection(shades)
    return shades


def _lines(dataset: xr.Dataset) -> Figure:
    """Draw the static limit and its error bound as functions of the amplitude.

    There are lines for the smallest and the largest Poisson's ratio.
    """
    figure = look.new_figure(look.DOUBLE, 2.6)
    left, right = figure.subplots(1, 2, sharex=True)
    ends = np.unique([float(dataset["poisson"].min()), float(dataset["poisson"].max())])
    for poisson, color, ls in zip(ends.tolist(), INKS, (look.SOLID, look.DASHED), strict=False):
        ends_of = float(dataset["amplitude"].min()), float(dataset["amplitude"].max())
        grid = Map(dataset).at(amplitude=np.linspace(*ends_of, LINE), poisson=poisson)
        ink: look.Ink = {"color": color, "ls": ls, "lw": 1.2}
        ink |= {"label": rf"$\nu = {look.number(poisson)}$"}
        left.plot(grid["amplitude"], grid["mu_macro"], **ink)
        right.plot(grid["amplitude"], 1e3 * grid["mu_macro_error"], **ink)
        at = _points(dataset, poisson)
        left.plot(at["amplitude"], at["mu_macro"], ".", color=color, ms=3.5, gid="points")
    panels.unit_range(left)
    panels.legend_above(left, _points_of(dataset))
    panels.heading(right, f"{len(dataset['cell_error'])} cells")
    right.set_ylim(0.0, 1e3 * float(dataset.attrs["error"]))
    for axes, label in ((left, look.FRICTION), (right, BOUND)):
        axes.set(xlabel=axis_label(dataset, "amplitude", DIMENSIONLESS), ylabel=label)
    return figure


def _points_of(dataset: xr.Dataset) -> str:
    return f"{dataset.attrs['points']} points"


def _is_deep(dataset: xr.Dataset) -> bool:
    """Return whether the map has several Poisson's ratios."""
    return dataset["poisson"].ndim > 0


def _points(dataset: xr.Dataset, poisson: float) -> xr.Dataset:
    """Select the points of the map at a Poisson's ratio."""
    here = dataset["poisson"].values == poisson
    return dataset.isel(point=here) if _is_deep(dataset) else dataset


def _cells(dataset: xr.Dataset) -> tuple[list[np.ndarray], np.ndarray]:
    """Return outlines, shape (n, 2), and error bounds of the cells at the smallest ratio."""
    coordinates = certified_map.coordinates_in(dataset)
    ends = [
        [dataset[name].values for name in certified_map.BORDERS[direction]]
        for direction in coordinates.directions
    ]
    cells = np.flatnonzero(ends[2][0] == 0.0) if _is_deep(dataset) else np.arange(len(ends[0][0]))
    deep = (0.0,) * (len(ends) - 2)
    outlines = []
    for cell in cells:
        (left, right), (low, high) = ([end[cell] for end in pair] for pair in ends[:2])
        x, y = left + (right - left) * SIDE, low + (high - low) * SIDE
        around = [(one, low) for one in x] + [(right, one) for one in y]
        around += [(one, high) for one in x[::-1]] + [(left, one) for one in y[::-1]]
        outlines.append(np.array([coordinates.place((*node, *deep))[:2] for node in around]))
    return outlines, dataset["cell_error"].values[cells]
