"""Which model is the cheapest that is accurate enough, over velocity and amplitude."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.transforms import Transform
from scipy import ndimage

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.data import require

MOTIONS = ("transverse", "bore")
NONE: dict[str, Any] = {
    "facecolor": "white",
    "edgecolor": look.GREY,
    "linewidth": 0.0,
    "hatch": "/////",
}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw one row of panels a motion, one column a tolerance."""
    parts = ("velocity", "amplitude", "cheapest")
    needed = ["map_tolerance", *(f"{motion}_{part}" for motion in MOTIONS for part in parts)]
    require(name, "accuracy_cost", dataset, needed)
    tolerances = dataset["map_tolerance"].values
    found = {str(n) for motion in MOTIONS for n in dataset[f"{motion}_cheapest"].values.ravel()}
    models = look.in_order(found - {""})

    figure = look.new_figure(look.DOUBLE, 5.9)
    grid = figure.subplots(len(MOTIONS), tolerances.size, squeeze=False, sharex="row", sharey="row")
    letters = iter(look.letters(grid.size))
    for row, motion in zip(grid, MOTIONS, strict=True):
        for index, (axes, tolerance) in enumerate(zip(row, tolerances, strict=True)):
            _panel(axes, dataset.isel(map_tolerance=index), motion, models)
            note = rf"{motion}, error within ${look.power_of_ten(float(tolerance))}$"
            look.letter(axes, next(letters), note)
            axes.set_xlabel(look.axis(VELOCITY[motion]))
        row[0].set_ylabel(look.axis(AMPLITUDE[motion]))
    handles = [Patch(facecolor=_pale(n), edgecolor=look.BLACK, linewidth=0.6) for n in models]
    labels = [rf"$\bf{{{look.model(n)[2]}}}$  {n}" for n in models]
    if "" in found:
        handles.append(Patch(**NONE))
        labels.append("none is that accurate")
    figure.legend(handles, labels, loc="outside lower center", ncols=4, handlelength=2.2)
    return figure


def _panel(axes: Axes, dataset: xr.Dataset, motion: str, models: list[str]) -> None:
    """Colour every cell by its model, outline the regions and write the model into each."""
    velocity, amplitude = f"{motion}_velocity", f"{motion}_amplitude"
    shown = dataset[f"{motion}_cheapest"].transpose(amplitude, velocity)
    x, _ = _edges(dataset[velocity].values, logarithmic=True)
    y, logarithmic = _edges(dataset[amplitude].values)
    number = {name: index for index, name in enumerate(models)}
    codes = np.array([[number.get(str(n), -1) for n in line] for line in shown.values])

    axes.set(xscale="log", yscale="log" if logarithmic else "linear")
    axes.pcolormesh(
        x,
        y,
        np.ma.masked_less(codes, 0),
        cmap=ListedColormap([_pale(name) for name in models] or [to_rgb("white")]),
        vmin=-0.5,
        vmax=max(len(models), 1) - 0.5,
        edgecolors="face",  # no hairlines between the cells in a PDF
        linewidth=0.3,
        gid="cheapest",
    )
    for i, j in np.argwhere(codes < 0):
        axes.fill_between(x[j : j + 2], y[i], y[i + 1], gid="none", **NONE)
    _outline(axes, x, y, codes)
    for code, name in enumerate(models):
        _name_regions(axes, x, y, codes == code, look.model(name)[2])
    axes.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))
    for axis in (axes.xaxis, axes.yaxis) if logarithmic else (axes.xaxis,):
        ticks.logarithmic(axis)
    axes.tick_params(which="both", direction="out", top=False, right=False)


def _outline(axes: Axes, x: np.ndarray, y: np.ndarray, codes: np.ndarray) -> None:
    """Draw a line wherever two cells side by side differ."""
    ink: dict[str, Any] = {
        "color": look.BLACK,
        "linewidth": 0.8,
        "capstyle": "projecting",
        "zorder": 3,
    }
    for i, j in np.argwhere(codes[:, 1:] != codes[:, :-1]):
        axes.vlines(x[j + 1], y[i], y[i + 1], **ink)
    for i, j in np.argwhere(codes[1:] != codes[:-1]):
        axes.hlines(y[i + 1], x[j], x[j + 1], **ink)


def _name_regions(axes: Axes, x: np.ndarray, y: np.ndarray, inside: np.ndarray, text: str) -> None:
    """Write the text once into every connected region, in the cell farthest from its border."""
    regions, count = ndimage.label(inside)
    for region in range(1, count + 1):
        depth = ndimage.distance_transform_cdt(np.pad(regions == region, 1))[1:-1, 1:-1]
        # Of equally deep cells the one nearest the middle of them.
        deepest = np.argwhere(depth == depth.max())
        away = np.hypot(*(deepest - deepest.mean(axis=0)).T)
        i, j = deepest[np.argmin(away)]
        centre = _middle(axes.transData, x[j : j + 2], y[i : i + 2])
        ink: dict[str, Any] = {"fontsize": look.RC["font.size"], "fontweight": "bold", "zorder": 4}
        axes.text(centre[0], centre[1], text, ha="center", va="center", gid="region", **ink)


def _middle(data: Transform, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The middle of a cell as it is seen, whatever the scales are."""
    return data.inverted().transform(data.transform(np.column_stack((x, y))).mean(axis=0))


def _edges(points: np.ndarray, logarithmic: bool | None = None) -> tuple[np.ndarray, bool]:
    """Edges half-way between the points, and whether that is half-way in their logarithms.

    The outer edges are as far from the points as the inner ones. Unless it is told, the points'
    own spacing decides.
    """
    if logarithmic is None:
        logarithmic = bool(points[0] > 0) and _evenness(np.log(points)) < _evenness(points)
    if logarithmic:
        return np.exp(_edges(np.log(points), False)[0]), True
    between = (points[1:] + points[:-1]) / 2 if points.size > 1 else points + 0.5
    first = 2 * points[0] - between[0]
    last = 2 * points[-1] - between[-1] if points.size > 1 else between[-1]
    return np.unique([first, *between, last]), False


def _evenness(points: np.ndarray) -> float:
    """How much the spacing varies; 0 for points at equal distances."""
    steps = np.diff(points)
    return float(np.ptp(steps) / steps.mean()) if steps.size else 0.0


def _pale(model: str) -> tuple[float, float, float]:
    """The colour of a model, pale enough for black letters on it."""
    red, green, blue = (1.0 - 0.5 * (1.0 - part) for part in to_rgb(look.model(model)[0]))
    return red, green, blue
