"""Figures 2 and 6: mu_macro over velocity and amplitude, with cuts along two edges of the map."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter

from microslip.plot import style as look
from microslip.plot.cuts import computed
from microslip.plot.data import curve, limit, require, sweep

FILL_LEVELS = np.linspace(0.0, 1.0, 21)
#: A cut's panel ends where all of its curves have fallen below this.
NOTHING = 0.02
LINE_LEVELS = np.linspace(0.1, 0.9, 9)


@dataclass(frozen=True)
class Overlay:
    """A theory curve: the variable that holds it, its name in the legend, its look."""

    variable: str
    label: str
    color: str
    linestyle: object
    linewidth: float = 1.3


@dataclass(frozen=True)
class Map:
    """What one map figure shows."""

    key: str
    velocity_symbol: str
    velocity_label: str
    amplitude_symbol: str
    amplitude_label: str
    static: tuple[Overlay, ...]
    large: Overlay


EXACT = Overlay("mu_static", "exact limit", look.BLUE, look.SOLID)
#: Exact for Poisson's ratio 0 alone; at any other it is shown as what it is.
EXACT_AT_0 = replace(EXACT, label=r"limit at $\nu = 0$")

MAPS = {
    "fig2_transverse_map": Map(
        key="transverse",
        velocity_symbol=r"\tilde{v}_0",
        velocity_label=r"forward velocity  $\tilde{v}_0 = v_0/(\omega\,u_\mathrm{lim})$",
        amplitude_symbol=r"\tilde{y}_0",
        amplitude_label=r"amplitude  $\tilde{y}_0 = y_0/u_\mathrm{lim}$",
        static=(
            Overlay("mu_static_slider", "Eq 7, slider", look.ORANGE, look.DASHDOT),
            Overlay("mu_static_stick_zone", "Eq 11, stick zone", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=Overlay("mu_large_amplitude", "Eq 6", look.VERMILLION, look.DASHED),
    ),
    "fig6_bore_map": Map(
        key="bore",
        velocity_symbol=r"\tilde{v}",
        velocity_label=r"forward velocity  $\tilde{v} = v_0/(\Omega\,\varphi_0\,a)$",
        amplitude_symbol=r"\tilde{\varphi}_0",
        amplitude_label=r"amplitude  $\tilde{\varphi}_0 = \varphi_0/\varphi_\mathrm{lk}(a/2)$",
        static=(
            Overlay(
                "mu_static_stick_zone_printed", "Eq 33 as printed", look.PURPLE, look.DOTTED, 1.0
            ),
            Overlay("mu_static_stick_zone", "Eq 33, corrected", look.GREEN, look.DASHED),
            EXACT,
        ),
        large=Overlay("mu_large_amplitude", "Eq 29", look.VERMILLION, look.DASHED),
    ),
}


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the map `name`: the map at the left, the static and the large-amplitude cut beside."""
    plan = MAPS[name]
    overlays = [overlay.variable for overlay in (*plan.static, plan.large)]
    needed = ["amplitude", "velocity", "mu_macro", "mu_macro_error", "converged", *overlays]
    require(name, plan.key, dataset, needed)
    dataset, poisson = sweep(dataset, ("amplitude", "velocity"))
    if poisson > 0 and plan.key == "transverse":
        static = (EXACT_AT_0 if overlay is EXACT else overlay for overlay in plan.static)
        plan = replace(plan, static=tuple(static))

    figure = look.new_figure(look.DOUBLE, 4.2)
    left, right = figure.subfigures(1, 2, width_ratios=(1.3, 1.0))
    upper, lower = right.subplots(2, 1)
    note = "" if poisson == 0 else rf"$\nu = {look.number(poisson)}$"
    _map(left.subplots(), dataset, plan, note)
    _static_cut(upper, dataset, plan)
    _large_cut(lower, dataset, plan)
    return figure


def _map(axes: Axes, dataset: xr.Dataset, plan: Map, note: str) -> None:
    """The map with its colours, its letter, and its hatching explained under it."""
    filled, hatched = fill(axes, dataset)
    axes.set(xlabel=plan.velocity_label, ylabel=plan.amplitude_label)
    bar = axes.figure.colorbar(filled, ax=axes, pad=0.02, aspect=32, ticks=np.linspace(0, 1, 6))
    bar.set_label(look.MU_MACRO)
    bar.ax.tick_params(direction="out")
    look.letter(axes, "a", note)
    if hatched:
        axes.legend(
            handles=[unconverged(f"not converged ({hatched} of {dataset['mu_macro'].size})")],
            loc="lower right",
            bbox_to_anchor=(1.0, 1.0),
            borderaxespad=0.2,
        )


def fill(
    axes: Axes,
    dataset: xr.Dataset,
    fills: np.ndarray = FILL_LEVELS,
    lines: np.ndarray = LINE_LEVELS,
    labelled: np.ndarray = LINE_LEVELS,
    size: float = 7.5,
) -> tuple[ContourSet, int]:
    """Fill a panel with `mu_macro` over velocity and amplitude: bands, contours, and hatched cells
    where a point is not converged.

    fills, lines, labelled: levels of bands, of contours and of those that have a number, ascending;
    size: of the numbers. Returns the bands, for a colour bar, and the number of hatched cells.
    """
    shown = dataset.isel(velocity=dataset["velocity"].values > 0)
    if min(shown.sizes["amplitude"], shown.sizes["velocity"]) < 2:
        raise ValueError("a map needs two amplitudes and two positive velocities at least")
    shown = shown.transpose("amplitude", "velocity", ...)
    velocity, amplitude = shown["velocity"].values, shown["amplitude"].values
    values = np.ma.masked_invalid(shown["mu_macro"].values)

    filled = axes.contourf(
        velocity,
        amplitude,
        np.clip(values, fills[0], fills[-1]),  # rounding beyond the ends must leave no white holes
        levels=fills,
        cmap=look.COLOURMAP,
    )
    filled.set_edgecolor("face")  # no hairlines between the bands in a PDF
    filled.set_linewidth(0.3)
    dark = fills[0] + 0.55 * (fills[-1] - fills[0])
    ink = ["white" if level < dark else "black" for level in lines]
    contours = axes.contour(velocity, amplitude, values, levels=lines, colors=ink, linewidths=0.7)
    axes.set_xscale("log")
    axes.set(xlim=(velocity[0], velocity[-1]), ylim=(amplitude[0], amplitude[-1]))
    axes.xaxis.set_major_locator(LogLocator(numticks=12))
    axes.tick_params(which="both", direction="out", top=False, right=False)
    axes.clabel(contours, labelled, fmt="%.1f", fontsize=size, inline_spacing=3)
    return filled, _hatch(axes, velocity, amplitude, shown["converged"].values != 0)


_HATCHED = {
    "facecolor": (1.0, 1.0, 1.0, 0.45),
    "edgecolor": look.BLACK,
    "linewidth": 0.0,
    "hatch": "//////",
}


def unconverged(label: str) -> Patch:
    """What a legend shows for hatched cells."""
    return Patch(label=label, **_HATCHED)


def _hatch(axes: Axes, velocity: np.ndarray, amplitude: np.ndarray, done: np.ndarray) -> int:
    """Hatch the cell around every point that is not converged, and count them."""
    x = np.exp(_cell_edges(np.log(velocity)))
    y = _cell_edges(amplitude)
    cells = [
        [(x[j], y[i]), (x[j + 1], y[i]), (x[j + 1], y[i + 1]), (x[j], y[i + 1])]
        for i, j in np.argwhere(~done)
    ]
    if cells:
        hatched = PolyCollection(cells, gid="unconverged", zorder=4, **_HATCHED)
        axes.add_collection(hatched, autolim=False)
    return len(cells)


def _cell_edges(points: np.ndarray) -> np.ndarray:
    """Edges half-way between the points; the outer ones at the outermost points."""
    return np.concatenate(([points[0]], (points[1:] + points[:-1]) / 2, [points[-1]]))


def _static_cut(axes: Axes, dataset: xr.Dataset, plan: Map) -> None:
    """mu_macro against amplitude at the smallest velocity, with the static limits."""
    velocity = float(dataset["velocity"][0])
    for overlay in plan.static:
        _overlay(axes, dataset, overlay, velocity=velocity)
    _points(axes, dataset.sel(velocity=velocity), "amplitude")
    symbol = plan.velocity_symbol
    where = "left edge" if velocity > 0 else "static limit"
    look.legend_above(axes, "b", rf"{where}, ${symbol} = {look.number(velocity)}$")
    axes.set(xlabel=plan.amplitude_label, xlim=_where_not_zero(axes))


def _where_not_zero(axes: Axes) -> tuple[float, float]:
    """The horizontal range in which any line drawn is above zero, and half as much again."""
    x, y = np.concatenate([line.get_xydata() for line in axes.get_lines()]).T
    last = x[y > NOTHING].max(initial=x.min())
    following = x[x > last].min(initial=x.max())
    return x.min(), min(max(1.5 * last, following), x.max())


def _large_cut(axes: Axes, dataset: xr.Dataset, plan: Map) -> None:
    """mu_macro against velocity at the largest amplitude, with the limit for large amplitudes."""
    amplitude = float(dataset["amplitude"][-1])
    _overlay(axes, dataset, plan.large, amplitude=amplitude)
    _points(axes, dataset.sel(amplitude=amplitude), "velocity")
    symbol = plan.amplitude_symbol
    look.legend_above(axes, "c", rf"top edge, ${symbol} = {look.number(amplitude)}$")
    velocity = dataset["velocity"].values
    axes.set_xscale("log")
    axes.set(xlabel=plan.velocity_label, xlim=(velocity[velocity > 0][0], velocity[-1]))
    axes.xaxis.set_major_locator(LogLocator(numticks=12))
    axes.xaxis.set_minor_formatter(NullFormatter())


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


def _points(axes: Axes, line: xr.Dataset, dim: str) -> None:
    """Draw the computed points of a cut and give its panel the common vertical axis."""
    columns = ("mu_macro", "mu_macro_error", "converged")
    computed(axes, line[dim].values, *(line[name].values for name in columns), "computed")
    look.unit_range(axes)
    axes.set_ylabel(look.MU_MACRO)
