"""Figures 2 and 6: maps of mu_macro, with cuts along two edges of the maps."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.datasets.catalogue import FORMS, STATIC
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_each_poisson, columns, curve, limit
from microslip.report.figures.map_panel import fill

LARGE = "mu_large_amplitude"
CURVES: dict[str, dict[str, tuple[str, Any]]] = {
    "transverse": {
        "mu_static_slider": (look.ORANGE, look.DASHDOT),
        "mu_static_stick_zone": (look.GREEN, look.DASHED),
        STATIC: (look.BLUE, look.SOLID),
        LARGE: (look.VERMILLION, look.DASHED),
    },
    "bore": {
        "mu_static_stick_zone_printed": (look.PURPLE, look.DOTTED),
        "mu_static_stick_zone": (look.GREEN, look.DASHED),
        STATIC: (look.BLUE, look.SOLID),
        LARGE: (look.VERMILLION, look.DASHED),
    },
}
"""Colour and line style of the closed forms of each motion."""
LARGER = 1.3
"""Difference in points between the sizes of the markers of two Poisson's ratios."""
MARGIN = 0.04
"""Margin above and below the points of a cut, relative to their range."""
POISSONS = (
    (look.BLACK, "o"),
    (look.PURPLE, "s"),
    (look.GREY, "^"),
    (look.SKY, "D"),
    (look.VERMILLION, "v"),
    (look.ORANGE, "P"),
)
"""Colours and markers of the points, by ascending Poisson's ratio."""
ACROSS = 3
"""Number of maps in a row."""
ROW = {2: 2.9, 3: 2.4}
"""Height of a row in inches, by the number of maps in the row."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the figure `name`: maps, and cuts at the smallest velocity and the largest amplitude.

    There is one map for each Poisson's ratio, and each cut shows all ratios. If the dataset has
    more ratios than `POISSONS` has entries, an evenly spaced selection is drawn, and the title
    states this.
    """
    motion, every = dataset.attrs["motion"], at_each_poisson(dataset)
    indices = np.unique(np.linspace(0, len(every) - 1, len(POISSONS)).round().astype(int))
    parts = [every[k] for k in indices]
    figure, maps, static_cut, large_cut = _page(len(parts))
    if len(parts) < len(every):
        some = f"{len(parts)} of the {len(every)} Poisson's ratios in the dataset"
        figure.suptitle(some, x=0.01, ha="left", fontsize=look.HEADING)
    alone = len(parts) == 1
    quantities = VELOCITY[motion], AMPLITUDE[motion]
    labels = [look.axis(one if alone else replace(one, unit="")) for one in quantities]
    entries: list[Artist] = []
    unconverged = 0
    for index, (axes, part) in enumerate(zip(maps, parts, strict=True)):
        poisson = float(part["poisson"])
        filled, handles, hatched = fill(axes, part)
        unconverged += hatched
        entries += handles
        ratio = rf"$\nu = {look.number(poisson)}$" if len(every) > 1 or poisson else ""
        panels.heading(axes, ratio)
        axes.set_xlabel(labels[0])
        if index % ACROSS == 0:
            axes.set_ylabel(labels[1])
    entries = panels.merged(entries)
    if unconverged:
        size = sum(part["mu_macro"].size for part in parts)
        entries[-1].set_label(f"not converged ({unconverged} of {size})")
    panels.legend_of_figure(maps[0].figure, entries, "lower center", ncols=1 if alone else None)
    friction = look.FRICTION if alone else look.FRICTION_IN_TWO_LINES
    panels.colour_bar(filled, maps, friction, aspect=32, ticks=np.linspace(0, 1, 6))
    _static_cut(static_cut, parts, motion)
    _large_cut(large_cut, parts, motion)
    return figure


def _page(count: int) -> tuple[Figure, list[Axes], Axes, Axes]:
    """Return a new figure, the panels for `count` maps, and the panels for the two cuts."""
    if count == 1:
        figure = look.new_figure(look.DOUBLE, 4.2)
        left, right = figure.subfigures(1, 2, width_ratios=(1.3, 1.0), squeeze=False).flat
        return figure, [left.subplots()], *right.subplots(2, 1)
    across = min(count, ACROSS)
    rows = -(-count // across)
    heights = rows * ROW[across], 2.7
    figure = look.new_figure(look.DOUBLE, sum(heights))
    upper, lower = figure.subfigures(2, 1, height_ratios=heights, squeeze=False).flat
    return figure, panels.grid(upper, count, across), *lower.subplots(1, 2)


def _static_cut(axes: Axes, parts: list[xr.Dataset], motion: str) -> None:
    """Draw mu_macro against the amplitude at the smallest velocity, with the static limits."""
    velocity = float(parts[0]["velocity"][0])
    for name in CURVES[motion]:
        if name != LARGE:
            _curve(axes, parts, motion, name, velocity=velocity)
    _points(axes, [part.sel(velocity=velocity) for part in parts], "amplitude")
    symbol = VELOCITY[motion].latex
    where = rf"limit for ${symbol} \to 0$"
    if velocity > 0:
        at = look.conditions([(symbol, velocity)])
        where = f"left edge, markers: {at},\nlines: {where}"
    panels.legend_above(axes, where)
    axes.set_xlabel(look.axis(AMPLITUDE[motion]))
    axes.margins(x=0.0)


def _large_cut(axes: Axes, parts: list[xr.Dataset], motion: str) -> None:
    """Draw mu_macro against the velocity at the largest amplitude, with the limit from theory."""
    amplitude = float(parts[0]["amplitude"][-1])
    _curve(axes, parts, motion, LARGE, amplitude=amplitude)
    _points(axes, [part.sel(amplitude=amplitude) for part in parts], "velocity")
    at = look.conditions([(AMPLITUDE[motion].latex, amplitude)])
    panels.legend_above(axes, f"top edge, {at}")
    velocity = parts[0]["velocity"].values
    axes.set_xlabel(look.axis(VELOCITY[motion]))
    panels.logarithmic(axes, (velocity[velocity > 0][0], velocity[-1]))


def _curve(axes: Axes, parts: list[xr.Dataset], motion: str, name: str, **at: float) -> None:
    """Draw a closed form from its variable in the dataset."""
    form, (color, ls) = FORMS[motion][name], CURVES[motion][name]
    label = form.label
    if name == STATIC and not form.any_poisson and any(part["poisson"] > 0 for part in parts):
        label = r"limit at $\nu = 0$"  # the closed form is exact for this ratio only
    x, y = curve(limit(parts[0], name), **at)
    axes.plot(x, y, color=color, ls=ls, label=label, gid=name)


def _points(axes: Axes, cut: list[xr.Dataset], dim: str) -> None:
    """Draw the computed points of a cut and set the vertical axis."""
    for index, (line, (color, marker)) in enumerate(zip(cut, POISSONS, strict=False)):
        ratio = rf", $\nu = {look.number(float(line['poisson']))}$" if len(cut) > 1 else ""
        points = columns(line, dim, "mu_macro", "mu_macro_error", "converged")
        ink: look.Ink = {"color": color, "marker": marker, "clip_on": False}
        # Later markers are smaller and in front, so that all markers at one place can be seen.
        ink |= {"ms": look.COMPUTED["ms"] + LARGER * (len(cut) - 1 - index), "zorder": 5 + index}
        panels.computed(axes, *points, label=f"computed{ratio}", **ink)
    values = np.concatenate([line["mu_macro"].values for line in cut])
    low, high = (f(values, initial=end) for f, end in ((np.nanmin, 0.0), (np.nanmax, 1.0)))
    panels.unit_range(axes)
    margin = MARGIN * (high - low)
    axes.set_ylim(low - margin, high + margin)
    axes.set_ylabel(look.FRICTION_IN_TWO_LINES)
