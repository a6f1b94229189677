"""Figures 2 and 6: mu_macro over velocity and amplitude, with cuts along two edges of the map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.cuts import computed
from microslip.report.figures.data import at_each_poisson, curve, limit, require, sweep
from microslip.report.figures.map_panel import (
    LINE_LEVELS,
    computed_points,
    fill,
    shows_points,
    unconverged,
)
from microslip.theory.catalogue import FORMS, STATIC

NOTHING = 0.02
"""A cut's panel ends where all of its curves have fallen below this."""
POISSONS = (
    (look.BLACK, "o"),
    (look.PURPLE, "s"),
    (look.GREY, "^"),
    (look.SKY, "D"),
    (look.VERMILLION, "v"),
    (look.ORANGE, "P"),
)
"""Colour and marker of the points at each of Poisson's ratios, from the first one on."""
COLUMNS, ROW = 3, {2: 2.9, 3: 2.4}
"""Columns of maps, and height in inches of a row of them, where there are several."""


@dataclass(frozen=True)
class Overlay:
    """A theory curve: the variable that holds it, its name in the legend, its look."""

    variable: str
    label: str
    color: str
    linestyle: Any
    linewidth: float = 1.3


def form(motion: str, name: str, color: str, linestyle: Any, linewidth: float = 1.3) -> Overlay:
    """The Overlay of a closed form, under the name that the catalogue has for it."""
    return Overlay(name, FORMS[motion][name].label, color, linestyle, linewidth)


@dataclass(frozen=True)
class Map:
    """Content of one map figure: a motion, its curves over the amplitude and over the velocity."""

    key: str
    static: tuple[Overlay, ...]
    large: Overlay


EXACT = form("transverse", STATIC, look.BLUE, look.SOLID)
EXACT_AT_0 = replace(EXACT, label=r"limit at $\nu = 0$")
"""Exact for Poisson's ratio 0 alone; at any other it is shown as what it is."""

MAPS = {
    "fig2_transverse_map": Map(
        key="transverse",
        static=(
            form("transverse", "mu_static_slider", look.ORANGE, look.DASHDOT),
            form("transverse", "mu_static_stick_zone", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=form("transverse", "mu_large_amplitude", look.VERMILLION, look.DASHED),
    ),
    "fig6_bore_map": Map(
        key="bore",
        static=(
            form("bore", "mu_static_stick_zone_printed", look.PURPLE, look.DOTTED, 1.0),
            form("bore", "mu_static_stick_zone", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=form("bore", "mu_large_amplitude", look.VERMILLION, look.DASHED),
    ),
}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the map `name` with the static and the large-amplitude cut.

    At several of Poisson's ratios there is a map for each, and the cuts show all of them; of more
    than `POISSONS` has looks for, so many from the smallest to the largest, which is said.
    """
    plan = MAPS[name]
    overlays = [overlay.variable for overlay in (*plan.static, plan.large)]
    needed = ["amplitude", "velocity", "mu_macro", "mu_macro_error", "converged", *overlays]
    require(name, plan.key, dataset, needed)
    every = at_each_poisson(dataset)
    chosen = np.unique(np.linspace(0, len(every) - 1, len(POISSONS)).round().astype(int))
    shown = [sweep(every[k], ("amplitude", "velocity")) for k in chosen]
    if plan.key == "transverse" and any(poisson > 0 for _, poisson in shown):
        static = (EXACT_AT_0 if overlay is EXACT else overlay for overlay in plan.static)
        plan = replace(plan, static=tuple(static))
    figure, panels, cuts = _page(len(shown))
    if len(shown) < len(every):
        some = f"{len(shown)} of the {len(every)} of Poisson's ratios in the dataset"
        figure.suptitle(some, x=0.01, ha="left", fontsize=look.HEADING)
    letters = look.letters(len(shown) + 2)
    for axes, letter, (part, poisson) in zip(panels, letters, shown, strict=False):
        note = rf"$\nu = {look.number(poisson)}$" if len(every) > 1 or poisson else ""
        filled = _map(axes, part, plan, letter, note)
    _colour_bar(panels, filled)
    _static_cut(cuts[0], shown, plan, letters[-2])
    _large_cut(cuts[1], shown, plan, letters[-1])
    return figure


def _page(count: int) -> tuple[Figure, list[Axes], list[Axes]]:
    """A figure, panels for so many maps, and panels for the two cuts."""
    if count == 1:
        figure = look.new_figure(look.DOUBLE, 4.2)
        left, right = figure.subfigures(1, 2, width_ratios=(1.3, 1.0), squeeze=False)[0]
        return figure, [left.subplots()], list(right.subplots(2, 1))
    columns = min(count, COLUMNS)
    rows = -(-count // columns)
    heights = rows * ROW[columns], 2.7
    figure = look.new_figure(look.DOUBLE, sum(heights))
    upper, lower = figure.subfigures(2, 1, height_ratios=heights, squeeze=False)[:, 0]
    panels = list(upper.subplots(rows, columns, squeeze=False).ravel())
    for axes in panels[count:]:
        axes.remove()
    return figure, panels[:count], list(lower.subplots(1, 2))


def _map(axes: Axes, dataset: xr.Dataset, plan: Map, letter: str, note: str) -> ContourSet:
    """A map with its letter, and its hatching explained above it; returns its bands."""
    grid = axes.get_subplotspec()
    assert grid is not None  # as of all panels of a grid
    alone = grid.get_gridspec().nrows * grid.get_gridspec().ncols == 1
    filled, hatched = fill(axes, dataset, labelled=LINE_LEVELS if alone else LINE_LEVELS[::2])
    shown = [table[plan.key] for table in (VELOCITY, AMPLITUDE)]
    shown = shown if alone else [replace(quantity, unit="") for quantity in shown]
    axes.set_xlabel(look.axis(shown[0]))
    axes.set_ylabel(look.axis(shown[1]) if grid.is_first_col() else "")
    look.letter(axes, letter, note)
    handles: list[Artist] = [computed_points()] if shows_points(axes) else []
    if hatched:
        text = f"not converged ({hatched} of {dataset['mu_macro'].size})"
        handles.append(unconverged(text))
    if handles:
        axes.legend(
            handles=handles,
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            borderaxespad=0.2,
        )
    return filled


def _colour_bar(panels: list[Axes], filled: ContourSet) -> None:
    """One colour bar beside all maps, which share their colours."""
    ticks = np.linspace(0, 1, 6)
    bar = panels[0].figure.colorbar(filled, ax=panels, pad=0.02, aspect=32, ticks=ticks)
    lines = "  (" if len(panels) == 1 else "\n("  # a row of small maps is not as high as the words
    bar.set_label(look.FRICTION.replace("  (", lines))
    bar.ax.tick_params(direction="out")


def _static_cut(axes: Axes, shown: list[tuple[xr.Dataset, float]], plan: Map, letter: str) -> None:
    """mu_macro against amplitude at the smallest velocity, with the static limits."""
    velocity = float(shown[0][0]["velocity"][0])
    for overlay in plan.static:
        _overlay(axes, shown[0][0], overlay, velocity=velocity)
    _points(axes, [(part.sel(velocity=velocity), nu) for part, nu in shown], "amplitude")
    where = "left edge" if velocity > 0 else "static limit"
    note = f"{where}, {look.conditions([(VELOCITY[plan.key].latex, velocity)])}"
    look.legend_above(axes, letter, note)
    axes.set(xlabel=look.axis(AMPLITUDE[plan.key]), xlim=_where_not_zero(axes))


def _where_not_zero(axes: Axes) -> tuple[float, float]:
    """The horizontal range in which any line drawn is above zero, and half as much again."""
    x, y = np.concatenate([line.get_xydata() for line in axes.get_lines()]).T
    last = x[y > NOTHING].max(initial=x.min())
    following = x[x > last].min(initial=x.max())
    return x.min(), min(max(1.5 * last, following), x.max())


def _large_cut(axes: Axes, shown: list[tuple[xr.Dataset, float]], plan: Map, letter: str) -> None:
    """mu_macro against velocity at the largest amplitude, with the limit for large amplitudes."""
    amplitude = float(shown[0][0]["amplitude"][-1])
    _overlay(axes, shown[0][0], plan.large, amplitude=amplitude)
    _points(axes, [(part.sel(amplitude=amplitude), nu) for part, nu in shown], "velocity")
    note = f"top edge, {look.conditions([(AMPLITUDE[plan.key].latex, amplitude)])}"
    look.legend_above(axes, letter, note)
    velocity = shown[0][0]["velocity"].values
    axes.set_xscale("log")
    axes.set(xlabel=look.axis(VELOCITY[plan.key]), xlim=(velocity[velocity > 0][0], velocity[-1]))
    ticks.logarithmic(axes.xaxis)


def _overlay(axes: Axes, dataset: xr.Dataset, overlay: Overlay, **at: float) -> None:
    """Draw a theory curve as the dataset holds it."""
    x, y = curve(limit(dataset, overlay.variable), **at)
    axes.plot(
        x,
        y,
        label=overlay.label,
        color=overlay.color,
        linestyle=overlay.linestyle,
        linewidth=overlay.linewidth,
        gid=overlay.variable,
    )


def _points(axes: Axes, lines: list[tuple[xr.Dataset, float]], dim: str) -> None:
    """Draw the computed points of a cut and give its panel the common vertical axis."""
    columns = ("mu_macro", "mu_macro_error", "converged")
    for (line, poisson), (color, marker) in zip(lines, POISSONS, strict=False):
        ratio = rf", $\nu = {look.number(poisson)}$" if len(lines) > 1 else ""
        mu, error, good = (line[name].values for name in columns)
        ink: dict[str, Any] = {"color": color, "marker": marker}
        computed(axes, line[dim].values, mu, error, good, f"computed{ratio}", **ink)
    look.unit_range(axes)
    axes.set_ylabel(look.FRICTION.replace("  (", "\n("))
