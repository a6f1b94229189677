"""Figure for a group of sweeps in `extended`, with a map or a line for each sweep."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import panels, poisson
from microslip.report.figures import style as look
from microslip.report.figures.data import (
    at_each_poisson,
    columns,
    finite_or_nan,
    limit,
    spans_a_map,
)
from microslip.report.figures.formulas import axis_label, mathtext
from microslip.report.figures.map_panel import fill

COLUMNS = {1: 1, 2: 2, 4: 2}
"""Number of columns for 1, 2 and 4 maps. Any other number of maps is drawn in 3 columns."""
HEIGHT, AROUND = {1: 3.4, 2: 2.5, 3: 1.75}, 0.45
"""Height of a row for each number of columns, and total height of the margins, in inches."""
CONTOURS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
"""Levels of the contours, fewer than on a large map."""
BEYOND = 0.01
"""Largest excess below 0 or above 1 that is attributed to the errors of the points."""
THEORY = {"amplitude": ("mu_static",), "velocity": ("mu_forward_theory", "mu_closed_form")}
"""Closed forms that are drawn at Poisson's ratio 0, for each horizontal axis."""
JOINING = 0.5
"""Width in points of the lines that join markers."""


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw a map or a line for every Poisson's ratio of each dataset.

    The figure shows maps if every dataset has at least two amplitudes and two velocities above 0.
    It shows lines if no dataset has that many. If there is enough space, `poisson.draw` draws the
    effect of Poisson's ratio instead.
    """
    if all(map(spans_a_map, datasets)) and poisson.has_room(datasets):
        return poisson.draw(name, *datasets)
    shown, titles = [], []
    for dataset in datasets:
        title = dataset.attrs.get("title", "")
        parts = at_each_poisson(dataset)
        for part in parts:
            shown.append(part)
            ratio = rf", $\nu = {look.number(float(part['poisson']))}$"
            titles.append(look.literal(title) + ratio * (len(parts) > 1))
    return (_maps if spans_a_map(shown[0]) else _lines)(shown, titles)


def _maps(datasets: Sequence[xr.Dataset], titles: Sequence[str]) -> Figure:
    """Draw a map of each dataset with its title, on a common colour scale."""
    count = len(datasets)
    columns_ = COLUMNS.get(count, 3)
    rows = -(-count // columns_)
    width = look.DOUBLE if columns_ > 1 else 0.65 * look.DOUBLE
    figure = look.new_figure(width, rows * HEIGHT[columns_] + AROUND)
    fills, contours = levels_of(datasets)
    grid = panels.grid(figure, count, columns_)
    entries: list[Artist] = []
    for axes, dataset, title in zip(grid, datasets, titles, strict=True):
        filled, handles, _ = fill(axes, dataset, fills, contours, look.SMALLEST)
        entries += handles
        axes.set_gid("map")
        panels.heading(axes, title, 0.8 * width / columns_ - 0.1)
    for dim in ("velocity", "amplitude"):
        _label_maps(figure, grid, dim, datasets)
    label = look.FRICTION if rows > 1 or columns_ < 3 else look.FRICTION_IN_TWO_LINES
    ticks = fills[np.isclose(np.round(5 * fills), 5 * fills)]
    panels.colour_bar(filled, grid, label, aspect=20 * rows, ticks=ticks)
    panels.legend_of_figure(figure, panels.merged(entries), "upper right")
    return figure


def levels_of(datasets: Sequence[xr.Dataset]) -> tuple[np.ndarray, np.ndarray]:
    """Return the levels of the bands and the levels of the contours.

    The bands cover 0 to 1, extended to the smallest and the largest value.
    """
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    high = max(float(dataset["mu_macro"].max()) for dataset in datasets)
    low = np.floor(10 * low) if low < -BEYOND else 0.0
    high = np.ceil(10 * high) if high > 1 + BEYOND else 10.0
    fills = np.linspace(low / 10, high / 10, round(2 * (high - low)) + 1)
    if low == 0:
        return fills, CONTOURS
    contours = np.concatenate([-CONTOURS[::-1], [0.0], CONTOURS])
    return fills, contours[contours > fills[0]]


def _label_maps(
    figure: Figure, grid: Sequence[Axes], dim: str, datasets: Sequence[xr.Dataset]
) -> None:
    """Label an axis once if all panels have the same label, else on each panel."""
    texts = [mathtext(dataset[dim].attrs.get("formula", "")) for dataset in datasets]
    if len(set(texts)) == 1:
        write = figure.supxlabel if dim == "velocity" else figure.supylabel
        write(axis_label(datasets[0], dim), fontsize=look.RC["axes.labelsize"])
        return
    width, height = figure.get_size_inches()
    across = COLUMNS.get(len(grid), 3)
    room = width / across - 0.7 if dim == "velocity" else height / -(-len(grid) // across) - 0.5
    for axes, text, dataset in zip(grid, texts, datasets, strict=True):
        axis = axes.xaxis if dim == "velocity" else axes.yaxis
        label = text or axis_label(dataset, dim)
        axis.set_label_text(look.wrapped(label, room, 7.5), fontsize=7.5)


def _lines(datasets: Sequence[xr.Dataset], titles: Sequence[str]) -> Figure:
    """Draw lines of static friction against amplitude, or of friction against velocity."""
    (dim,) = {"amplitude" if d.sizes.get("amplitude", 0) > 1 else "velocity" for d in datasets}
    figure = look.new_figure(5.2, 3.3)
    axes = figure.subplots()
    velocities: set[float] = set()
    handles = []
    for dataset, title, (color, marker, ls) in zip(datasets, titles, look.LINES, strict=False):
        has_limit = _limit(axes, dataset, dim, color=color, ls=ls)
        style: look.Ink = {"ls": ls} if has_limit else {"lw": JOINING}
        label = look.wrapped(title, 1.35, 8.0)
        handles.append(Line2D([], [], color=color, marker=marker, ms=4.0, label=label, **style))
        points = dataset.isel(velocity=dataset["velocity"].values > 0)
        if points.sizes["velocity"]:
            points = points.isel(velocity=0) if dim == "amplitude" else points.squeeze()
            _marks(axes, points, dim, color, marker)
            velocities.update(np.atleast_1d(points["velocity"].values).tolist())
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    panels.unit_range(axes, low=np.floor(5 * low) / 5 if low < -BEYOND else 0.0)
    axes.set(ylabel=look.FRICTION, xlabel=_axis_label(dim, datasets))
    if dim == "velocity":
        panels.logarithmic(axes)
    axes.margins(x=0.02)
    figure.legend(handles=handles, loc="outside right upper", handlelength=3.0)
    if dim == "amplitude" and velocities:
        at = [look.number(velocity) for velocity in sorted(velocities)]
        marks = rf"marks: velocity ${at[0]}$" + (rf" to ${at[-1]}$" if len(at) > 1 else "")
        axes.set_title(f"lines: limit for velocity to 0; {marks}", loc="left", fontsize=8.0)
    return figure


def _limit(axes: Axes, dataset: xr.Dataset, dim: str, **ink: Any) -> bool:
    """Draw a closed form or the computed static limit. Returns False if neither is available."""
    forms = [variable for variable in THEORY[dim] if variable in dataset]
    if forms and float(dataset["poisson"]) == 0.0:
        line = limit(dataset, forms[0])
        if line.ndim == 1:
            axes.plot(line[line.dims[0]], line, gid="limit", **ink)
            return True
    if dim == "amplitude" and float(dataset["velocity"][0]) == 0.0:
        static = dataset["mu_macro"].isel(velocity=0)
        axes.plot(static[dim], finite_or_nan(static.values), gid="limit", **ink)
        return True
    return False


def _marks(axes: Axes, points: xr.Dataset, dim: str, color: str, marker: str) -> None:
    """Draw computed points with errors, joined by a thin line. Unconverged points are hollow."""
    x, y, error = map(finite_or_nan, columns(points, dim, "mu_macro", "mu_macro_error"))
    axes.plot(x, y, color=color, lw=JOINING, alpha=0.6, zorder=1.5)
    converged = points["converged"].values != 0
    for part, face, gid in ((converged, color, "computed"), (~converged, "white", "unconverged")):
        if part.any():
            ink: look.Ink = {"color": color, "mfc": face, "gid": gid, **look.ERROR_BARS}
            axes.errorbar(x[part], y[part], yerr=error[part], fmt=marker, ms=4.0, **ink)


def _axis_label(dim: str, datasets: Iterable[xr.Dataset]) -> str:
    quantity = "forward velocity" if dim == "velocity" else "amplitude"
    formulas = (mathtext(dataset[dim].attrs.get("formula", "")) for dataset in datasets)
    texts = list(dict.fromkeys(filter(None, formulas)))
    if sum(map(len, texts)) > 90 or any(" " in text for text in texts):
        return f"{quantity}, in the units of each motion"
    return f"{quantity}  {', '.join(texts)}"
