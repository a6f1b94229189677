"""A certified map: friction with the cells that answer and their points, and their errors.

Or the velocity under a force in the place of friction.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

from microslip.datasets import certified_map
from microslip.datasets.query.accessor import Friction
from microslip.datasets.query.cells import is_static
from microslip.datasets.query.drift import Drift
from microslip.report.figures import style as look
from microslip.report.figures.data import require
from microslip.report.figures.formulas import mathtext
from microslip.report.figures.map_panel import fill
from microslip.report.figures.small_maps import CONTOURS, LABELLED
from microslip.sweeps.drift_coordinates import DriftCoordinates

BOUND = "bound of the error,\nthousandths  (dimensionless)"
INKS = look.BLUE, look.VERMILLION
NODES, LINE = 97, 201
"""Velocities and amplitudes at which the map is asked for the picture of it, a map or a line."""
SIDE = np.linspace(0.0, 1.0, 17)
"""Places along a side of a cell, which is no straight line on the map."""
VARIABLES = ("mu_macro", "cell_error", "cell_node", "velocity", "amplitude", "poisson")
OF_DRIFT = ("velocity", "cell_error", "cell_node", "force", "amplitude", "poisson")
DECADES = np.linspace(-3.0, 1.0, 17)
"""Decimal logarithms of the velocities of drift that bands begin at."""
STAYS: dict[str, Any] = {"facecolor": look.PALE, "edgecolor": "none"}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the map with its cells and points, and beside it the bound of the error in each cell.

    A map that also covers Poisson's ratios is shown at the smallest one.  A map of the static limit
    is a line.
    """
    if certified_map.is_of_drift(dataset):
        require(name, name, dataset, OF_DRIFT)
        return _drift(dataset)
    require(name, name, dataset, VARIABLES)
    if is_static(dataset):
        return _lines(dataset)
    poisson = float(dataset["poisson"].min())
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    grid = Friction(dataset).on_grid(NODES, NODES, poisson=poisson)
    known = np.isfinite(grid["mu_macro"])
    filled, _ = fill(left, grid.assign(converged=known), lines=CONTOURS, labelled=LABELLED)
    at = dataset.isel(point=dataset["poisson"].values == poisson) if _is_deep(dataset) else dataset
    shares = _show_cells(left, right, dataset, at, "velocity")
    ratio = rf" at $\nu = {look.number(poisson)}$" if poisson or _is_deep(dataset) else ""
    look.letter(left, "a", f"{dataset.attrs['points']} points, {len(dataset['cell_error'])} cells")
    look.letter(right, "b", f"bound of the error{ratio}")
    right.tick_params(which="both", direction="out", top=False, right=False)
    left.set(xlabel=_axis(dataset, "velocity"), ylabel=_axis(dataset, "amplitude"))
    right.set_xlabel(_axis(dataset, "velocity"))
    bar = figure.colorbar(filled, ax=left, pad=0.02, ticks=np.linspace(0, 1, 6))
    bar.set_label(look.FRICTION)
    bar.ax.tick_params(direction="out")
    _bar_of_errors(figure, right, shares)
    return figure


def _drift(dataset: xr.Dataset) -> Figure:
    """The velocity over force and amplitude, grey where the contact stays, and the bounds."""
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    coordinates = certified_map.coordinates_in(dataset)
    assert isinstance(coordinates, DriftCoordinates)  # as of all maps of drift
    force = np.linspace(0.0, coordinates.force, NODES)
    grid = Drift(dataset).on_grid(force, NODES)
    slowest, fastest = 10.0 ** DECADES[[0, -1]]
    shown = np.log10(np.clip(grid["velocity"].values, slowest, fastest))
    amplitude = grid["amplitude"].values
    filled = left.contourf(
        force, amplitude, shown, levels=DECADES, cmap=look.COLOURMAP, extend="both"
    )
    filled.set_edgecolor("face")
    held = np.minimum(grid["threshold"].values[:, 0], coordinates.force)
    for axes in (left, right):
        axes.fill_betweenx(amplitude, 0.0, held, gid="stays", **STAYS)
    left.plot(held, amplitude, color=look.BLACK, linewidth=1.3, gid="threshold")
    shares = _show_cells(left, right, dataset, dataset, "force")
    poisson = float(dataset["poisson"])
    ratio = rf" at $\nu = {look.number(poisson)}$" if poisson else ""
    look.letter(left, "a", f"{dataset.attrs['points']} points, {len(dataset['cell_error'])} cells")
    look.letter(right, "b", rf"bound of the error over $\sqrt{{1 + v^2}}${ratio}")
    for axes in (left, right):
        axes.tick_params(which="both", direction="out", top=False, right=False)
        axes.set_xlabel(_axis(dataset, "force"))
    left.set(ylabel=_axis(dataset, "amplitude"), xlim=(0.0, coordinates.force))
    left.set_ylim(*coordinates.amplitude)
    bar = figure.colorbar(filled, ax=left, pad=0.02, ticks=np.arange(-3.0, 2.0))
    bar.ax.set_yticklabels([f"${look.number(10.0**power)}$" for power in np.arange(-3.0, 2.0)])
    bar.set_label("mean velocity  (dimensionless)")
    bar.ax.tick_params(direction="out")
    _bar_of_errors(figure, right, shares)
    return figure


def _show_cells(
    left: Axes, right: Axes, dataset: xr.Dataset, at: xr.Dataset, across: str
) -> PolyCollection:
    """Outlines and points on one panel, bounds on the other, which are returned; at: the part of
    the dataset whose points are shown, across: the name of what runs along the abscissa."""
    outlines, errors = _cells(dataset)
    left.add_collection(
        LineCollection(outlines, colors=look.VERMILLION, linewidths=0.7, gid="cells")
    )
    points = left.plot(
        *(at[across], at["amplitude"], "."),
        color=look.BLACK,
        markersize=2.2,
        gid="points",
    )
    points[0].set_clip_on(False)
    shares = PolyCollection(outlines, array=1e3 * errors, cmap=look.COLOURMAP, gid="errors")
    shares.set(edgecolors="white", linewidths=0.6, clim=(0.0, 1e3 * float(dataset.attrs["error"])))
    right.add_collection(shares)
    return shares


def _bar_of_errors(figure: Figure, axes: Axes, shares: PolyCollection) -> None:
    bar = figure.colorbar(shares, ax=axes, pad=0.02)
    bar.set_label(BOUND)
    bar.ax.tick_params(direction="out")


def _lines(dataset: xr.Dataset) -> Figure:
    """The static limit over the amplitude, at the smallest and the largest Poisson's ratio, and the
    bound of its error there."""
    figure = look.new_figure(look.DOUBLE, 2.6)
    left, right = figure.subplots(1, 2, sharex=True)
    ends = np.unique([float(dataset["poisson"].min()), float(dataset["poisson"].max())])
    for poisson, color, linestyle in zip(ends, INKS, (look.SOLID, look.DASHED), strict=False):
        grid = Friction(dataset).on_grid(amplitude=LINE, poisson=float(poisson)).isel(velocity=0)
        ink: dict[str, Any] = {"color": color, "linestyle": linestyle, "linewidth": 1.2}
        ink["label"] = rf"$\nu = {look.number(poisson)}$"
        left.plot(grid["amplitude"], grid["mu_macro"], **ink)
        right.plot(grid["amplitude"], 1e3 * grid["mu_macro_error"], **ink)
        at = dataset.isel(point=dataset["poisson"] == poisson) if _is_deep(dataset) else dataset
        left.plot(at["amplitude"], at["mu_macro"], ".", color=color, markersize=3.5, gid="points")
    look.unit_range(left)
    look.legend_above(left, "a", f"{dataset.attrs['points']} points")
    look.letter(right, "b", f"{len(dataset['cell_error'])} cells")
    right.set_ylim(0.0, 1e3 * float(dataset.attrs["error"]))
    for axes, label in ((left, look.FRICTION), (right, BOUND)):
        axes.set(xlabel=_axis(dataset, "amplitude"), ylabel=label)
    return figure


def _is_deep(dataset: xr.Dataset) -> bool:
    """Whether Poisson's ratio is a direction of the map."""
    return dataset["poisson"].ndim > 0


def _cells(dataset: xr.Dataset) -> tuple[list[np.ndarray], np.ndarray]:
    """Outlines on the map, shape (n, 2) each, and bounds of the cells at the smallest ratio."""
    coordinates = certified_map.coordinates_in(dataset)
    ends = [
        [dataset[name].values for name in certified_map.BORDERS[direction]]
        for direction in coordinates.directions
    ]
    shown = np.flatnonzero(ends[2][0] == 0.0) if _is_deep(dataset) else range(len(ends[0][0]))
    deep = (0.0,) * (len(ends) - 2)
    outlines = []
    for cell in shown:
        (left, right), (low, high) = ([end[cell] for end in pair] for pair in ends[:2])
        x, y = left + (right - left) * SIDE, low + (high - low) * SIDE
        around = [(one, low) for one in x] + [(right, one) for one in y]
        around += [(one, high) for one in x[::-1]] + [(left, one) for one in y[::-1]]
        outlines.append(np.array([coordinates.place((*node, *deep))[:2] for node in around]))
    return outlines, dataset["cell_error"].values[np.asarray(shown)]


def _axis(dataset: xr.Dataset, dim: str) -> str:
    """Label of an axis."""
    quantity = {"velocity": "forward velocity"}.get(dim, dim)
    return f"{quantity}  {mathtext(dataset[dim].attrs.get('formula', '(dimensionless)'))}"
