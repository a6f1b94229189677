"""Effect of Poisson's ratio: contours of friction at several ratios, and differences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.config.quantities import MU_MACRO
from microslip.datasets.surface import Surface
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns
from microslip.report.figures.formulas import axis_label
from microslip.report.figures.map_panel import (
    FEW,
    FILL_LEVELS,
    bands,
    draw_bare_points,
    draw_contours,
    draw_points,
    fill,
)

LEVELS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
STYLES = (look.SOLID, look.DASHED, look.DOTTED, look.DASHDOT)
"""Line styles, by ascending Poisson's ratio."""
MOST = 3
"""Maximum number of datasets in a figure."""
MOST_LEVELS = 12
"""With this many levels on each side of 0, the labels of the two levels next to 0 would overlap."""
DIVERGING = "PuOr"
"""Colour map of differences. It is pale in the middle."""


def has_room(datasets: Sequence[xr.Dataset]) -> bool:
    """Return whether all datasets have several Poisson's ratios and fit into one figure."""
    ratios = [d.sizes.get("poisson", 1) if "mu_macro_change" in d else 1 for d in datasets]
    return len(datasets) <= MOST and min(ratios) > 1 and max(ratios) <= len(STYLES)


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw two panels for each dataset: contours at every ratio, and the change over all ratios.

    The datasets must satisfy `has_room`.
    """
    figure = look.new_figure(look.DOUBLE, 2.8 * len(datasets))
    grid = figure.subplots(len(datasets), 2, squeeze=False)
    notes: list[Artist] = []
    for (left, right), dataset in zip(grid, datasets, strict=True):
        shown = dataset.isel(velocity=dataset["velocity"].values > 0)
        shown = shown.sortby("poisson").transpose("poisson", "amplitude", "velocity", ...)
        notes += _contours(left, shown)
        _change(right, shown)
        for axes in (left, right):
            _axes(axes, shown)
    panels.legend_of_figure(figure, panels.merged(notes), "lower right")
    return figure


def _contours(axes: Axes, shown: xr.Dataset) -> list[Artist]:
    """Draw the map at the smallest Poisson's ratio, and the contours at every ratio.

    Contours at the smallest ratio have numbers. Returns the legend entries of the map.
    """
    first = shown.isel(poisson=0)
    filled, notes, _ = fill(axes, first, lines=LEVELS, size=look.SMALLEST)
    panels.colour_bar(filled, axes, MU_MACRO.math, aspect=24, ticks=np.linspace(0, 1, 6))
    handles: list[Artist] = []
    for ls, index in zip(STYLES, range(shown.sizes["poisson"]), strict=False):
        one = shown.isel(poisson=index)
        if index:
            surface = Surface(*columns(one, "velocity", "amplitude", "mu_macro"))
            draw_contours(axes, surface, FILL_LEVELS, LEVELS, linestyles=[ls], linewidths=1.1)
        label = rf"$\nu = {look.number(float(one['poisson']))}$" + ", colour" * (not index)
        handles.append(Line2D([], [], color=look.BLACK, ls=ls, label=label))
    key = "title" if "group" in shown.attrs else "motion"
    note = look.literal(shown.attrs.get(key, ""))
    panels.legend_above(axes, note, handles=handles)
    return notes


def _change(axes: Axes, shown: xr.Dataset) -> None:
    """Draw the difference between the largest and the smallest Poisson's ratio.

    Differences within twice the tolerance are not significant and have the palest colour.
    """
    last = shown.isel(poisson=-1)
    velocity, amplitude, change = columns(last, "velocity", "amplitude", "mu_macro_change")
    surface = Surface(velocity, amplitude, change)
    if min(change.shape) < FEW or not np.isfinite(change).all():
        draw_points(axes, velocity, amplitude, change)
    grid = surface.velocity, surface.amplitude
    step = 2.0 * float(shown.attrs["tolerance"])
    if not step > 0.0:  # without a tolerance: the largest error estimate
        step = 2.0 * max(float(shown["mu_macro_error"].max()), 1e-3)
    count = max(2, int(np.ceil(np.abs(surface.values).max() / step)))
    levels = step * np.array([k for k in range(-count, count + 1) if k])
    filled = bands(axes, *grid, surface.values, levels=levels, cmap=DIVERGING)
    draw_bare_points(axes, velocity, amplitude, change, filled)
    inner = (-step, step) if count < MOST_LEVELS else (0.0,)  # else the labels would overlap
    ends = (levels[0], *inner, levels[-1])
    first, at = (look.number(float(shown["poisson"][k])) for k in (0, -1))
    label = rf"{MU_MACRO.math} at $\nu = {at}$ less that at ${first}$"
    panels.colour_bar(filled, axes, label, aspect=24, ticks=ends)
    panels.heading(axes)


def _axes(axes: Axes, shown: xr.Dataset) -> None:
    velocity, amplitude = columns(shown, "velocity", "amplitude")
    axes.set(xlabel=axis_label(shown, "velocity"), ylabel=axis_label(shown, "amplitude"))
    axes.set_ylim(*amplitude[[0, -1]])
    panels.logarithmic(axes, velocity[[0, -1]])
    panels.ticks_outside(axes)
