"""Figures of the accuracy study: performance profiles, error against cost, and cheapest models."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullLocator
from scipy import ndimage

from microslip.config.quantities import AMPLITUDE, MU_MACRO, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

NAMES = {"auto": "chosen by tolerance", "paper": "paper's run"}
"""Labels of competitors whose names need an explanation."""
LEAST_RANGE = 10.0
"""The axis of a profile extends at least to this ratio."""
COSTS = {
    "seconds": "CPU time of a run  $t$ (s)",
    "effort": "effort: iterations $\\times$ unknowns\n(dimensionless)",
}
"""Label of each cost."""
ACROSS, WIDTH, ROW, LINE = 3, 1.95, 1.95, 0.15
"""Number of panels in a row; width of a panel, height of a row and of a legend line, in inches."""
MOST = 1e6
"""Largest ratio of the upper to the lower end of the axis of errors."""
EDGE = 0.06
"""Distance between the range of the values and a value outside this range, divided by the range."""
MOTIONS = ("transverse", "bore")

FRONT: look.Ink = {"color": "#EBD9A0", "lw": 5.0, "solid_capstyle": "round", "zorder": 1}
UNKNOWN: look.Ink = {"fc": "none", "ec": "#A8A8A8", "lw": 0.0, "hatch": "/////"}
SHIPPED: look.Ink = {"lw": 1.1, "ms": 4.2, "mew": 0.8, "zorder": 5}
OTHER: look.Ink = {"color": "#8C8C8C", "marker": "o", "ls": "none", "ms": 2.0, "zorder": 3}
AUTO: look.Ink = {"color": look.BLACK, "marker": "D", "lw": 0.8, "ms": 4.2, "zorder": 7}
PAPER: look.Ink = {"color": look.BLACK, "marker": "*", "ls": "none", "ms": 9.0, "zorder": 8}
CROSS: look.Ink = {"color": look.BLACK, "marker": "x", "ls": "none", "ms": 5.0, "mew": 0.7}
BEYOND: look.Ink = {"mfc": "none", "mec": look.BLACK, "marker": "o", "ls": "none", "ms": 7.5}
BEYOND |= {"mew": 0.6, "zorder": 9}
NONE: look.Ink = {"fc": "white", "ec": look.GREY, "lw": 0.0, "hatch": 5 * "/"}


def profile(dataset: xr.Dataset) -> Figure:
    """Draw performance profiles at the tightest tolerance, with a panel for each contest.

    A profile is the fraction of points that a competitor solves within a cost.
    """
    dataset = dataset.isel(map_tolerance=int(np.argmin(dataset["map_tolerance"].values)))
    of_contest = dataset["competitor_contest"].values.astype(str)
    contests = list(dict.fromkeys(of_contest))
    figure = look.new_figure(look.DOUBLE, 3.1 * -(-len(contests) // 2))
    grid = panels.grid(figure, len(contests), 2)
    tolerance = look.power_of_ten(float(dataset["map_tolerance"]))
    for axes, contest in zip(grid, contests, strict=True):
        own = dataset.isel(competitor=of_contest == contest)
        ratios = own["profile_ratio"].transpose("competitor", "point").values
        high = 1.3 * max(ratios[np.isfinite(ratios)].max(initial=1.0), LEAST_RANGE)
        names = own["competitor"].values.astype(str)
        # The default method is first and black; the others follow in the order of the dataset.
        for place, index in enumerate(np.argsort(names != "shipped", kind="stable")):
            name, at = names[index], np.sort(ratios[index][np.isfinite(ratios[index])])
            color, _, ls = look.LINES[place % len(look.LINES)]
            if contest == contests[0]:
                color = look.MODELS.get(name, (color,))[0]
                ls = look.DOTTED if color == look.BLACK else ls  # solid black is the line of "auto"
            if name == "auto":
                color, ls = look.BLACK, look.SOLID
            shares = np.array([0, *range(1, at.size + 1), at.size]) / ratios.shape[1]
            label = NAMES.get(name, name) + ("" if at.size else ": never")
            ink: look.Ink = {"color": color, "ls": ls, "drawstyle": "steps-post", "label": label}
            ink |= {"lw": 1.8 if name in ("shipped", "auto") else 1.3, "gid": f"profile {name}"}
            axes.plot([1.0, *at, high], shares, **ink)
        axes.set_ylabel("fraction of points  (dimensionless)")
        axes.set_xlabel(r"CPU time divided by the smallest  $t/t_\mathrm{best}$")
        panels.logarithmic(axes, (1.0, high))
        panels.unit_range(axes)
        panels.legend_above(axes, rf"{contest}, error within ${tolerance}$")
    return figure


def versus_cost(dataset: xr.Dataset) -> Figure:
    """Draw errors against CPU time."""
    return _versus(dataset, "seconds")


def versus_work(dataset: xr.Dataset) -> Figure:
    """Draw errors against effort."""
    return _versus(dataset, "effort")


def _versus(dataset: xr.Dataset, cost: str) -> Figure:
    """Draw the errors of all trials against a cost, with a panel for each point.

    Each model with the default method has a colour and a marker, runs of other methods are grey.
    Trials outside of the axes are drawn at their edge, in a circle: errors far below the error of
    the reference, and trials without a result or without a cost.
    """
    costs, errors = dataset[cost].values, dataset["error"].values
    of_point = dataset["trial_point"].values.astype(str)
    models = look.in_order(set(dataset["trial_model"].values.astype(str)) - {"auto"})
    count = dataset["point"].size
    rows = -(-count // ACROSS)
    heights = ROW * rows + 0.35, LINE * (max(len(models), 7) + 2.0)
    figure = look.new_figure(look.DOUBLE, sum(heights))
    page, foot = figure.subfigures(2, 1, height_ratios=heights, squeeze=False).flat
    grid = panels.grid(page, count, ACROSS, sharex=True, sharey=True)
    paid, most = costs[np.isfinite(costs) & (costs > 0)], np.nanmax(errors[np.isfinite(errors)])
    references = dataset["reference_error"].values
    least = np.nanmin([*references[np.isfinite(references)] / 3.0, most / 100.0])
    ends = [(paid.min(initial=1.0), paid.max(initial=1.0)), (max(least, most / MOST), most)]
    (left, right), (bottom, top) = (
        (low / (high / low) ** (2 * EDGE), high * (high / low) ** (2 * EDGE)) for low, high in ends
    )
    grid[0].set(xscale="log", yscale="log", xlim=(left, right), ylim=(bottom, top))
    for axis in (grid[0].xaxis, grid[0].yaxis):
        axis.set_major_locator(LogLocator(numticks=5))
        axis.set_minor_locator(NullLocator())
    for index, (axes, name) in enumerate(
        zip(grid, dataset["point"].values.astype(str), strict=True)
    ):
        point = dataset.isel(point=index)
        _trials(axes, dataset.isel(trial=of_point == name).sortby("trial_level"), cost, ends)
        if (limit := float(point["reference_error"])) > bottom:
            axes.axhspan(bottom, min(limit, top), gid="reference", zorder=0.5, **UNKNOWN)
        _head(axes, point)
        if index + ACROSS >= count:
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(COSTS[cost])
        if index % ACROSS == 0:
            axes.set_ylabel(f"error of {MU_MACRO.math}\n(dimensionless)")
    shipped: list[Artist] = [Line2D([], [], label=one, **_ink(one, "shipped")) for one in models]
    marks: list[Artist] = [
        Line2D([], [], label="Pareto front", **FRONT),
        Line2D([], [], label="chosen by tolerance", **AUTO),
        Line2D([], [], label="paper's run", **PAPER),
        Line2D([], [], label="any other method", **OTHER),
        Line2D([], [], label="not converged, or none", **CROSS),
        Line2D([], [], label="beyond the axis", **BEYOND),
        Patch(label="within the reference's error", **UNKNOWN),
    ]
    for title, handles, side in (("shipped method", shipped, "left"), ("marks", marks, "center")):
        text: look.Ink = {"fontsize": look.SMALLEST, "title_fontsize": look.HEADING}
        foot.legend(handles=handles, title=title, alignment="left", loc=f"upper {side}", **text)
    return figure


def _head(axes: Axes, point: xr.Dataset) -> None:
    """Write the letter of a panel, and the title and the parameters of its point."""
    motion = str(point["point_motion"].item())
    quantities = [table.get(motion) for table in (VELOCITY, AMPLITUDE)]
    symbols = [one.latex if one else plain for one, plain in zip(quantities, "vA", strict=True)]
    values = (float(point[f"point_{n}"]) for n in ("velocity", "amplitude", "poisson"))
    pairs = zip((*symbols, r"\nu"), values, strict=True)
    numbers = look.conditions((symbol, value) for symbol, value in pairs if np.isfinite(value))
    title = panels.lettered(axes, look.literal(point["point_title"].item()))
    head = f"{look.wrapped(title, WIDTH, look.HEADING)}\n{numbers}"
    axes.set_title(head, loc="left", pad=4, fontsize=look.HEADING, linespacing=1.15)


def _trials(axes: Axes, rows: xr.Dataset, cost: str, ends: list[tuple[float, float]]) -> None:
    """Draw every trial of a point, with a curve for each model and markers for other methods.

    ends: ranges of costs and errors. Values outside are drawn near the edges of the panel.
    """
    raw = columns(rows, cost, "error")
    x, y = (
        np.clip(
            np.where(np.isfinite(one), one, np.inf),
            *(low / (high / low) ** EDGE, high * (high / low) ** EDGE),
        )
        for one, (low, high) in zip(raw, ends, strict=True)
    )
    model, method = (rows[f"trial_{n}"].values.astype(str) for n in ("model", "method"))
    best = np.flatnonzero(rows[f"front_{cost}"].values)
    best = best[np.lexsort((-y[best], x[best]))]
    axes.plot(x[best], y[best], drawstyle="steps-post", gid="front", **FRONT)
    bad = ~(np.isfinite(raw[1]) & (rows["converged"].values != 0))
    for pair in dict.fromkeys(zip(model, method, strict=True)):
        own = (model == pair[0]) & (method == pair[1])
        ink = _ink(*pair)
        finite = own & np.isfinite(raw[1])
        axes.plot(x[finite], y[finite], gid=" ".join(pair), **ink)
        if ink is not OTHER:
            axes.plot(x[own & bad], y[own & bad], gid="hollow", **ink | {"ls": "none", "mfc": "w"})
    axes.plot(x[bad], y[bad], gid="not converged", **CROSS)
    moved = (x != raw[0]) | (y != raw[1])
    axes.plot(x[moved], y[moved], gid="beyond", **BEYOND)


def _ink(model: str, method: str) -> look.Ink:
    """Return the colour, marker and line style for trials of a model with a method."""
    if method == "paper":
        return PAPER
    if model == "auto":
        return AUTO
    color, marker, _ = look.model(model)
    return SHIPPED | {"color": color, "marker": marker} if method == "shipped" else OTHER


def model_map(dataset: xr.Dataset) -> Figure:
    """Draw the cheapest accurate model at each velocity and amplitude: a row of panels for each
    motion, and a column for each tolerance."""
    tolerances = dataset["map_tolerance"].values
    names = {str(n) for motion in MOTIONS for n in dataset[f"{motion}_cheapest"].values.ravel()}
    models = look.in_order(names - {""})
    figure = look.new_figure(look.DOUBLE, 5.9)
    grid = figure.subplots(len(MOTIONS), tolerances.size, squeeze=False, sharex="row", sharey="row")
    for row, motion in zip(grid, MOTIONS, strict=True):
        for index, axes in enumerate(row):
            _cheapest(axes, dataset.isel(map_tolerance=index), motion, models)
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


def _cheapest(axes: Axes, dataset: xr.Dataset, motion: str, models: list[str]) -> None:
    """Colour every cell by its model, and label every connected region."""
    velocity, amplitude = (dataset[f"{motion}_{n}"] for n in ("velocity", "amplitude"))
    names = dataset[f"{motion}_cheapest"].transpose(amplitude.name, velocity.name).values
    codes = np.array([[models.index(str(n)) if str(n) else -1 for n in line] for line in names])
    steps = np.diff(amplitude.values)
    logarithmic = amplitude.values[0] > 0 and not np.allclose(steps, steps[:1], rtol=0.1)
    x, y = panels.edges(velocity.values, True), panels.edges(amplitude.values, bool(logarithmic))
    axes.set(xscale="log", yscale="log" if logarithmic else "linear")
    colours = ListedColormap([_pale(name) for name in models] or [(1.0, 1.0, 1.0)])
    # Coloured edges prevent hairlines between the cells in a PDF.
    ink: look.Ink = {"cmap": colours, "vmin": -0.5, "vmax": max(len(models), 1) - 0.5}
    ink |= {"edgecolors": "face", "lw": 0.3}
    axes.pcolormesh(x, y, np.ma.masked_less(codes, 0), gid="cheapest", **ink)
    for i, j in np.argwhere(codes < 0):
        axes.fill_between(x[j : j + 2], y[i], y[i + 1], gid="none", **NONE)
    text: look.Ink = {"ha": "center", "va": "center", "fontweight": "bold", "gid": "region"}
    for code, name in enumerate(models):
        regions, count = ndimage.label(codes == code)
        for region in range(1, count + 1):
            depth = ndimage.distance_transform_cdt(np.pad(regions == region, 1))[1:-1, 1:-1]
            # Among the cells farthest from the border, the label is in the most central one.
            deepest = np.argwhere(depth == depth.max())
            i, j = deepest[np.argmin(np.hypot(*(deepest - deepest.mean(axis=0)).T))]
            axes.text(velocity.values[j], amplitude.values[i], look.model(name)[2], **text)
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    for axis in (axes.xaxis, axes.yaxis) if logarithmic else (axes.xaxis,):
        panels.logarithmic_ticks(axis)
    panels.ticks_outside(axes)


def _pale(model: str) -> tuple[float, float, float]:
    """Return the colour of a model, lightened so that black letters are readable on it."""
    red, green, blue = (1.0 - 0.5 * (1.0 - part) for part in to_rgb(look.model(model)[0]))
    return red, green, blue
