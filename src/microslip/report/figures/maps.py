"""Figures 2 and 6: mu_macro over velocity and amplitude, with cuts along two edges of the map."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import AMPLITUDE, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_each_poisson, columns, curve, limit, require, sweep
from microslip.report.figures.map_panel import LINE_LEVELS, fill
from microslip.theory.catalogue import FORMS, STATIC

NOTHING = 0.02
"""A cut's panel ends where all of its curves are below this."""
POISSONS = (
    (look.BLACK, "o"),
    (look.PURPLE, "s"),
    (look.GREY, "^"),
    (look.SKY, "D"),
    (look.VERMILLION, "v"),
    (look.ORANGE, "P"),
)
"""Colour and marker of the points at each Poisson's ratio, ascending."""
ROW = {2: 2.9, 3: 2.4}
"""Height in inches of a row of so many maps."""


@dataclass(frozen=True)
class Overlay:
    """A theory curve: the variable that holds it, its name in the legend, its look."""

    variable: str
    label: str
    color: str
    linestyle: Any
    linewidth: float = 1.3


def _form(motion: str, name: str, *ink: Any) -> Overlay:
    """The Overlay of a closed form, under the name that the catalogue has for it."""
    return Overlay(name, FORMS[motion][name].label, *ink)


@dataclass(frozen=True)
class Map:
    """Content of one map figure: a motion, its curves over the amplitude and over the velocity."""

    key: str
    static: tuple[Overlay, ...]
    large: Overlay


EXACT = _form("transverse", STATIC, look.BLUE, look.SOLID)
EXACT_AT_0 = replace(EXACT, label=r"limit at $\nu = 0$")
"""The transverse limit where Poisson's ratio is not 0, for which alone it is exact."""

MAPS = {
    "fig2_transverse_map": Map(
        key="transverse",
        static=(
            _form("transverse", "mu_static_slider", look.ORANGE, look.DASHDOT),
            _form("transverse", "mu_static_stick_zone", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=_form("transverse", "mu_large_amplitude", look.VERMILLION, look.DASHED),
    ),
    "fig6_bore_map": Map(
        key="bore",
        static=(
            _form("bore", "mu_static_stick_zone_printed", look.PURPLE, look.DOTTED, 1.0),
            _form("bore", "mu_static_stick_zone", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=_form("bore", "mu_large_amplitude", look.VERMILLION, look.DASHED),
    ),
}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the map `name` with the static and the large-amplitude cut.

    Each Poisson's ratio has a map of its own; the cuts show all of them. If there are more than
    `POISSONS` has looks for, that many are drawn, evenly chosen, and a title says so.
    """
    plan, every = MAPS[name], at_each_poisson(dataset)
    require(name, plan.key, dataset, ("amplitude", "velocity"))
    chosen = np.unique(np.linspace(0, len(every) - 1, len(POISSONS)).round().astype(int))
    shown = [sweep(every[k], ("amplitude", "velocity")) for k in chosen]
    if plan.key == "transverse" and any(poisson > 0 for _, poisson in shown):
        static = (EXACT_AT_0 if overlay is EXACT else overlay for overlay in plan.static)
        plan = replace(plan, static=tuple(static))
    figure, maps, static_cut, large_cut = _page(len(shown))
    if len(shown) < len(every):
        some = f"{len(shown)} of the {len(every)} of Poisson's ratios in the dataset"
        figure.suptitle(some, x=0.01, ha="left", fontsize=look.HEADING)
    letters, alone = look.letters(len(shown) + 2), len(shown) == 1
    quantities = (table[plan.key] for table in (VELOCITY, AMPLITUDE))
    labels = [look.axis(one if alone else replace(one, unit="")) for one in quantities]
    for axes, letter, (part, poisson) in zip(maps, letters, shown, strict=False):
        numbered = LINE_LEVELS if alone else LINE_LEVELS[::2]
        filled, handles, hatched = fill(axes, part, labelled=numbered)
        ratio = rf"$\nu = {look.number(poisson)}$" if len(every) > 1 or poisson else ""
        panels.letter(axes, letter, ratio)
        axes.set_xlabel(labels[0])
        if handles:
            if hatched:
                handles[-1].set_label(f"not converged ({hatched} of {part['mu_macro'].size})")
            above: look.Ink = {"loc": "lower right", "bbox_to_anchor": (1.0, 1.0)}
            above |= {"borderaxespad": 0.2}
            axes.legend(handles=handles, **above)
        if panels.place_of(axes).is_first_col():
            axes.set_ylabel(labels[1])
    friction = look.FRICTION if alone else look.FRICTION_IN_TWO_LINES
    panels.colour_bar(filled, maps, friction, aspect=32, ticks=np.linspace(0, 1, 6))
    _static_cut(static_cut, shown, plan, letters[-2])
    _large_cut(large_cut, shown, plan, letters[-1])
    return figure


def _page(count: int) -> tuple[Figure, list[Axes], Axes, Axes]:
    """A figure, panels for so many maps, and panels for the two cuts."""
    columns_ = min(count, 3)
    rows = -(-count // columns_)
    heights = (4.2,) if count == 1 else (rows * ROW[columns_], 2.7)
    figure = look.new_figure(look.DOUBLE, sum(heights))
    if count == 1:
        first, second = figure.subfigures(1, 2, width_ratios=(1.3, 1.0), squeeze=False).flat
    else:
        first, second = figure.subfigures(2, 1, height_ratios=heights, squeeze=False).flat
    maps = list(first.subplots(rows, columns_, squeeze=False).flat)
    static, large = second.subplots(*((2, 1) if count == 1 else (1, 2)))
    for axes in maps[count:]:
        axes.remove()
    return figure, maps[:count], static, large


def _static_cut(axes: Axes, shown: list[tuple[xr.Dataset, float]], plan: Map, letter: str) -> None:
    """mu_macro against amplitude at the smallest velocity, with the static limits."""
    velocity = float(shown[0][0]["velocity"][0])
    for overlay in plan.static:
        _overlay(axes, shown[0][0], overlay, velocity=velocity)
    _points(axes, [(part.sel(velocity=velocity), nu) for part, nu in shown], "amplitude")
    where = "left edge" if velocity > 0 else "static limit"
    at = look.conditions([(VELOCITY[plan.key].latex, velocity)])
    panels.legend_above(axes, letter, f"{where}, {at}")
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
    at = look.conditions([(AMPLITUDE[plan.key].latex, amplitude)])
    panels.legend_above(axes, letter, f"top edge, {at}")
    velocity = shown[0][0]["velocity"].values
    axes.set(xscale="log", xlim=(velocity[velocity > 0][0], velocity[-1]))
    axes.set_xlabel(look.axis(VELOCITY[plan.key]))
    panels.logarithmic(axes.xaxis)


def _overlay(axes: Axes, dataset: xr.Dataset, overlay: Overlay, **at: float) -> None:
    """Draw a theory curve as the dataset holds it."""
    ink: look.Ink = {"color": overlay.color, "ls": overlay.linestyle, "lw": overlay.linewidth}
    line = curve(limit(dataset, overlay.variable), **at)
    axes.plot(*line, label=overlay.label, gid=overlay.variable, **ink)


def _points(axes: Axes, lines: list[tuple[xr.Dataset, float]], dim: str) -> None:
    """Draw the computed points of a cut and give its panel the common vertical axis."""
    for (line, poisson), (color, marker) in zip(lines, POISSONS, strict=False):
        ratio = rf", $\nu = {look.number(poisson)}$" if len(lines) > 1 else ""
        points = columns(line, dim, "mu_macro", "mu_macro_error", "converged")
        panels.computed(axes, *points, label=f"computed{ratio}", color=color, marker=marker)
    panels.unit_range(axes)
    axes.set_ylabel(look.FRICTION_IN_TWO_LINES)
