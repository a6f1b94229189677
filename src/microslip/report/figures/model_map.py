"""Map that shows the cheapest accurate model at each velocity and amplitude."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from scipy import ndimage

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.datasets.interpolation import Axis
from microslip.report.figures import panels
from microslip.report.figures import style as look

MOTIONS = ("transverse", "bore")
NONE: look.Ink = {"fc": "white", "ec": look.GREY, "lw": 0.0, "hatch": 5 * "/"}
BORDER: look.Ink = {"color": look.BLACK, "lw": 0.8, "capstyle": "projecting", "zorder": 3}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw a row of panels for each motion and a column for each tolerance."""
    tolerances = dataset["map_tolerance"].values
    names = {str(n) for motion in MOTIONS for n in dataset[f"{motion}_cheapest"].values.ravel()}
    models = look.in_order(names - {""})
    figure = look.new_figure(look.DOUBLE, 5.9)
    grid = figure.subplots(len(MOTIONS), tolerances.size, squeeze=False, sharex="row", sharey="row")
    for row, motion in zip(grid, MOTIONS, strict=True):
        for index, axes in enumerate(row):
            _panel(axes, dataset.isel(map_tolerance=index), motion, models)
            tolerance = look.power_of_ten(float(tolerances[index]))
            panels.heading(axes, rf"{motion}, error within ${tolerance}$")
            axes.set_xlabel(look.axis(VELOCITY[motion]))
        row[0].set_ylabel(look.axis(AMPLITUDE[motion]))
    handles = [
        Patch(fc=_pale(n), ec=look.BLACK, lw=0.6, label=rf"$\bf{{{look.model(n)[2]}}}$  {n}")
        for n in models
    ]
    handles += [Patch(label="no model within the tolerance", **NONE)] if "" in names else []
    panels.legend_of_figure(figure, handles, "lower center", ncols=4)
    return figure


def _panel(axes: Axes, dataset: xr.Dataset, motion: str, models: list[str]) -> None:
    """Colour every cell by its model, outline the regions and label them."""
    velocity, amplitude = (dataset[f"{motion}_{n}"] for n in ("velocity", "amplitude"))
    names = dataset[f"{motion}_cheapest"].transpose(amplitude.name, velocity.name).values
    codes = np.array([[models.index(str(n)) if str(n) else -1 for n in line] for line in names])
    logarithmic = Axis(amplitude.values).logarithmic
    x, y = panels.edges(velocity.values, True), panels.edges(amplitude.values, logarithmic)
    axes.set(xscale="log", yscale="log" if logarithmic else "linear")
    colours = ListedColormap([_pale(name) for name in models] or [(1.0, 1.0, 1.0)])
    # Coloured edges prevent hairlines between the cells in a PDF.
    ink: look.Ink = {"cmap": colours, "vmin": -0.5, "vmax": max(len(models), 1) - 0.5}
    ink |= {"edgecolors": "face"}
    axes.pcolormesh(x, y, np.ma.masked_less(codes, 0), lw=0.3, gid="cheapest", **ink)
    for i, j in np.argwhere(codes < 0):
        axes.fill_between(x[j : j + 2], y[i], y[i + 1], gid="none", **NONE)
    for i, j in np.argwhere(codes[:, 1:] != codes[:, :-1]):
        axes.vlines(x[j + 1], y[i], y[i + 1], **BORDER)
    for i, j in np.argwhere(codes[1:] != codes[:-1]):
        axes.hlines(y[i + 1], x[j], x[j + 1], **BORDER)
    for code, name in enumerate(models):
        for i, j in _centres(codes == code):
            centre = velocity.values[j], amplitude.values[i]
            text: look.Ink = {"ha": "center", "va": "center", "fontweight": "bold", "zorder": 4}
            axes.text(*centre, look.model(name)[2], gid="region", **text)
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    for axis in (axes.xaxis, axes.yaxis) if logarithmic else (axes.xaxis,):
        panels.logarithmic_ticks(axis)
    panels.ticks_outside(axes)


def _centres(inside: np.ndarray) -> list[np.ndarray]:
    """For every connected region, return the indices of the cell farthest from the border."""
    regions, count = ndimage.label(inside)
    centres = []
    for region in range(1, count + 1):
        depth = ndimage.distance_transform_cdt(np.pad(regions == region, 1))[1:-1, 1:-1]
        # Among cells at equal distances from the border, choose the cell nearest their centroid.
        deepest = np.argwhere(depth == depth.max())
        away = np.hypot(*(deepest - deepest.mean(axis=0)).T)
        centres.append(deepest[np.argmin(away)])
    return centres


def _pale(model: str) -> tuple[float, float, float]:
    """Return the colour of a model, lightened so that black letters are readable on it."""
    red, green, blue = (1.0 - 0.5 * (1.0 - part) for part in to_rgb(look.model(model)[0]))
    return red, green, blue
