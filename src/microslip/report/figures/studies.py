"""Figures of the studies.

Accuracy: performance profiles, error against cost, and cheapest models. Stability: a table with a
coloured square for the outcome of each method in each case. Claims: static limits, fractions of the
friction bound, and stick zones.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from string import ascii_lowercase

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import LogLocator, NullLocator
from scipy import ndimage
from scipy.interpolate import griddata

from microslip.config.quantities import AMPLITUDE, FORWARD, LATERAL, MU_MACRO, VELOCITY
from microslip.datasets.catalogue import FORMS
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.panels import columns

# Accuracy

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
FRONT: look.Ink = {"color": "#EBD9A0", "lw": 5.0, "solid_capstyle": "round", "zorder": 1}
AUTO: look.Ink = {"color": look.BLACK, "marker": "D", "lw": 0.8, "ms": 4.2, "zorder": 7}
PAPER: look.Ink = {"color": look.BLACK, "marker": "*", "ls": "none", "ms": 9.0, "zorder": 8}
OTHER: look.Ink = {"color": "#8C8C8C", "marker": "o", "ls": "none", "ms": 2.0, "zorder": 3}
CROSS: look.Ink = {"color": look.BLACK, "marker": "x", "ls": "none", "ms": 5.0, "mew": 0.7}
BEYOND: look.Ink = {"mfc": "none", "mec": look.BLACK, "marker": "o", "ls": "none", "ms": 7.5}
BEYOND |= {"mew": 0.6, "zorder": 9}
MARKS = {
    "Pareto front": FRONT,
    **{NAMES["auto"]: AUTO, NAMES["paper"]: PAPER, "any other method": OTHER},
    **{"not converged, or none": CROSS, "beyond the axis": BEYOND},
}
"""Labels and styles of the trials of all models."""
SHIPPED: look.Ink = {"lw": 1.1, "ms": 4.2, "mew": 0.8, "zorder": 5}
UNKNOWN: look.Ink = {"fc": "none", "ec": "#A8A8A8", "lw": 0.0, "hatch": "/////"}
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


def _versus(dataset: xr.Dataset, cost: str) -> Figure:
    """Draw the errors of all trials against a cost, with a panel for each point.

    Each model with the default method has a colour and a marker, runs of other methods are grey.
    Trials outside of the axes are drawn at their edge, in a circle: errors far below the error of
    the reference, and trials without a result or without a cost.
    """
    costs, errors = dataset[cost].values, dataset["error"].values
    models = look.in_order(set(dataset["trial_model"].values.astype(str)) - {"auto"})
    count = dataset["point"].size
    height = ROW * -(-count // ACROSS) + LINE * -(-(len(models) + 7) // ACROSS) + 0.45
    figure = look.new_figure(look.DOUBLE, height)
    grid = panels.grid(figure, count, ACROSS, sharex=True, sharey=True)
    paid, most = costs[np.isfinite(costs) & (costs > 0)], np.nanmax(errors[np.isfinite(errors)])
    references = dataset["reference_error"].values
    least = np.nanmin([*references[np.isfinite(references)] / 3.0, most / 100.0])
    ends = [(paid.min(initial=1.0), paid.max(initial=1.0)), (max(least, most / MOST), most)]
    xlim, ylim = (_beyond(*each, 2 * EDGE) for each in ends)
    grid[0].set(xscale="log", yscale="log", xlim=xlim, ylim=ylim)
    for axis in (grid[0].xaxis, grid[0].yaxis):
        axis.set_major_locator(LogLocator(numticks=5))
        axis.set_minor_locator(NullLocator())
    for index, axes in enumerate(grid):
        point = dataset.isel(point=index)
        own = dataset["trial_point"].values.astype(str) == str(point["point"].item())
        _trials(axes, dataset.isel(trial=own).sortby("trial_level"), cost, ends)
        if (limit := float(point["reference_error"])) > ylim[0]:
            axes.axhspan(ylim[0], min(limit, ylim[1]), gid="reference", zorder=0.5, **UNKNOWN)
        _head(axes, point)
        if index + ACROSS >= count:
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(COSTS[cost])
        if index % ACROSS == 0:
            axes.set_ylabel(f"error of {MU_MACRO.math}\n(dimensionless)")
    styles = {f"{one}, shipped method": _ink(one, "shipped") for one in models} | MARKS
    marks: list = [Line2D([], [], label=label, **ink) for label, ink in styles.items()]
    marks.append(Patch(label="within the reference's error", **UNKNOWN))
    panels.legend_of_figure(figure, marks, "lower center", ncols=ACROSS, fontsize=look.SMALLEST)
    return figure


versus_cost = partial(_versus, cost="seconds")
"""Draw errors against CPU time."""
versus_work = partial(_versus, cost="effort")
"""Draw errors against effort."""


def _beyond(low: float, high: float, share: float) -> tuple[float, float]:
    """Return two values outside of a logarithmic range, at a share of the range from its ends."""
    factor = (high / low) ** share
    return low / factor, high * factor


def _head(axes: Axes, point: xr.Dataset) -> None:
    """Write the letter of a panel, and the title and the parameters of its point."""
    motion = str(point["point_motion"].item())
    symbols = {
        "velocity": VELOCITY[motion].latex if motion in VELOCITY else "v",
        "amplitude": AMPLITUDE[motion].latex if motion in AMPLITUDE else "A",
        "poisson": r"\nu",
    }
    pairs = ((symbol, float(point[f"point_{name}"])) for name, symbol in symbols.items())
    numbers = look.conditions((symbol, value) for symbol, value in pairs if np.isfinite(value))
    title = panels.lettered(axes, look.literal(point["point_title"].item()))
    head = f"{look.wrapped(title, WIDTH, look.HEADING)}\n{numbers}"
    axes.set_title(head, loc="left", pad=4, fontsize=look.HEADING, linespacing=1.15)


def _trials(axes: Axes, rows: xr.Dataset, cost: str, ends: list[tuple[float, float]]) -> None:
    """Draw every trial of a point, with a curve for each model and markers for other methods.

    ends: ranges of costs and errors. Values outside are drawn near the edges of the panel.
    """
    raw = np.stack(columns(rows, cost, "error"))
    x, y = (
        np.clip(np.where(np.isfinite(one), one, np.inf), *_beyond(*each, EDGE))
        for one, each in zip(raw, ends, strict=True)
    )
    best = np.flatnonzero(rows[f"front_{cost}"].values)
    best = best[np.lexsort((-y[best], x[best]))]
    axes.plot(x[best], y[best], drawstyle="steps-post", gid="front", **FRONT)
    finite = np.isfinite(raw[1])
    bad = ~finite | (rows["converged"].values == 0)
    model, method = (rows[f"trial_{n}"].values.astype(str) for n in ("model", "method"))
    for pair in dict.fromkeys(zip(model, method, strict=True)):
        own = (model == pair[0]) & (method == pair[1])
        ink = _ink(*pair)
        axes.plot(x[own & finite], y[own & finite], gid=" ".join(pair), **ink)
        if ink is not OTHER:
            axes.plot(x[own & bad], y[own & bad], gid="hollow", **ink | {"ls": "none", "mfc": "w"})
    moved = (x != raw[0]) | (y != raw[1])
    for gid, which, ink in (("not converged", bad, CROSS), ("beyond", moved, BEYOND)):
        axes.plot(x[which], y[which], gid=gid, **ink)


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
    dims = f"{motion}_amplitude", f"{motion}_velocity"
    amplitude, velocity = columns(dataset, *dims)
    names = dataset[f"{motion}_cheapest"].transpose(*dims).values.astype(str)
    steps = np.diff(amplitude)
    logarithmic = bool(amplitude[0] > 0 and not np.allclose(steps, steps[:1], rtol=0.1))
    x, y = panels.edges(velocity, True), panels.edges(amplitude, logarithmic)
    axes.set(xscale="log", yscale="log" if logarithmic else "linear")
    panels.cells(axes, x, y, names == "", gid="none", **NONE)
    text: look.Ink = {"ha": "center", "va": "center", "fontweight": "bold", "gid": "region"}
    for name in models:
        # Coloured edges prevent hairlines between the cells in a PDF.
        ink: look.Ink = {"fc": _pale(name), "ec": _pale(name), "lw": 0.3, "gid": f"cheapest {name}"}
        panels.cells(axes, x, y, names == name, **ink)
        regions, count = ndimage.label(names == name)
        for region in range(1, count + 1):
            depth = ndimage.distance_transform_cdt(np.pad(regions == region, 1))[1:-1, 1:-1]
            # Among the cells farthest from the border, the label is in the most central one.
            deepest = np.argwhere(depth == depth.max())
            i, j = deepest[np.argmin(np.hypot(*(deepest - deepest.mean(axis=0)).T))]
            axes.text(velocity[j], amplitude[i], look.model(name)[2], **text)
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    for axis in (axes.xaxis, axes.yaxis) if logarithmic else (axes.xaxis,):
        panels.logarithmic_ticks(axis)
    panels.ticks_outside(axes)


def _pale(model: str) -> tuple[float, ...]:
    """Return the colour of a model, lightened so that black letters are readable on it."""
    return tuple(0.5 + 0.5 * part for part in to_rgb(look.model(model)[0]))


# Stability

OUTCOMES = {
    1: ("converged", "#CDE7DC", "\N{CHECK MARK}", "#00664A", "within its error estimate"),
    2: ("slow", "#F0B84B", "S", look.BLACK, "not converged within its budget, as reported"),
    3: ("wrong", "#C04F00", "W", "white", "reported as converged, but too far from the reference"),
    4: ("diverged", "#222222", "D", "white", "diverged, or no result"),
}
"""Outcomes by code: name, fill colour, symbol, symbol colour, meaning. The fill colours darken from
good to bad, so that they also differ in greyscale."""
BLANK = "blank: the method does not apply"
COLUMN, CASE, FOOT = 0.3, 0.125, 0.95
"""Width of a column, height of a row and of the legend, in inches."""
NOTE = 3.0
"""Width of the notes beside the table, in inches."""


def atlas(dataset: xr.Dataset) -> Figure:
    """Draw the outcomes: a row for each case, and a column for each method."""
    outcome = dataset["outcome"].transpose("case", "method").values.astype(int)
    methods = dataset["method"].values.astype(str)
    of_case, labels = (part.astype(str) for part in columns(dataset, "case_axis", "case_label"))
    order = np.argsort(methods != "shipped", kind="stable")  # the default method is first
    order = order[(outcome.any(axis=0) | (methods == "shipped"))[order]]
    blocks = [np.flatnonzero(of_case == str(axis)) for axis in dataset["axis"].values]
    # A block has a row for its heading and, except for the last one, a blank row below it.
    rows = sum(own.size + 2 for own in blocks if own.size) - 1
    figure = look.new_figure(look.DOUBLE, CASE * rows + FOOT + 1.2)
    axes = figure.add_subplot(aspect=CASE / COLUMN, anchor="W")
    axes.set(xlim=(0, len(order) + NOTE / COLUMN), ylim=(rows, 0))
    x, y, first = np.arange(len(order) + 1), np.arange(rows + 1), 1
    small: look.Ink = {"fontsize": look.SMALLEST}
    ticks: dict[float, str] = {}
    letters = iter(ascii_lowercase)
    for own, title, note in zip(blocks, *columns(dataset, "axis_label", "axis_note"), strict=True):
        if not own.size:
            continue
        codes = outcome[np.ix_(own, order)]
        for code, (_, fill, sign, color, _) in OUTCOMES.items():
            square: look.Ink = {"fc": fill, "ec": "white", "lw": 0.8, "gid": f"outcome {code}"}
            panels.cells(axes, x, y[first:], codes == code, **square)
            text = small | {"color": color, "ha": "center", "va": "center_baseline"}
            text |= {"fontweight": "normal" if code == 1 else "bold"}
            for row, column in np.argwhere(codes == code):
                axes.text(column + 0.5, first + row + 0.5, sign, **text)
        axes.add_patch(Rectangle((0, first), 1, own.size, fill=False, clip_on=False))
        head: look.Ink = {"va": "center", "fontsize": look.HEADING, "gid": "head"}
        title = f"({next(letters)})  {look.literal(title)}"
        axes.text(0.0, first - 0.5, title, fontweight="bold", **head)
        wide = look.wrapped(look.literal(note), NOTE - 0.2, look.SMALLEST)
        beside = small | {"va": "top", "color": look.GREY, "linespacing": 1.1}
        axes.text(len(order) + 0.4, first, wide, **beside)
        ticks |= {first + row + 0.5: label for row, label in enumerate(labels[own])}
        first += own.size + 2
    axes.set_yticks(list(ticks), ticks.values())
    axes.set_xticks(x[:-1] + 0.5, methods[order], rotation=90)
    axes.tick_params(length=0, pad=1.5, top=False, labeltop=True, labelbottom=False)
    axes.tick_params(labelsize=look.SMALLEST)
    axes.get_xticklabels()[0].set_fontweight("bold")
    axes.spines[:].set_visible(False)
    handles: list = []
    for _, fill, sign, color, _ in OUTCOMES.values():
        mark = Line2D([], [], marker=rf"$\bf{{{sign}}}$", color=color, ls="none", ms=5.0, mew=0.0)
        handles.append((Patch(fc=fill), mark))
    handles.append(Patch(fc="white", ec=look.PALE))
    texts = [*(f"{name}: {meaning}" for name, *_, meaning in OUTCOMES.values()), BLANK]
    place: look.Ink = {"loc": "outside lower left", "handlelength": 1.6, "handleheight": 1.1}
    figure.legend(handles, texts, **small, **place)
    return figure


# Claims

MOTIONS = {
    "transverse": ("transverse oscillation", AMPLITUDE["transverse"]),
    "bore": ("oscillating bore", replace(AMPLITUDE["bore"], latex=r"\tilde{\varphi}")),
}
"""Title and amplitude of each column of panels."""
CURVES = {
    "limit": "mu_static",
    "zone": "mu_static_stick_zone",
    "slider": "mu_static_slider",
    "zone_printed": "mu_static_stick_zone_printed",
}
"""Variables of the curves, and their closed forms. A motion has some of these variables."""
PAPERS_RUN: look.Ink = {"mfc": "none", "mec": look.VERMILLION, "mew": 1.1, "zorder": 6, "ms": 6.5}
PAPERS_RUN |= {"marker": "s", "ls": "none", "clip_on": False, "gid": "paper"}
LIGHTEST = 0.82
"""Upper end of the colour map for lines. Lines in lighter colours have too little contrast."""
PIXELS = 401
"""Number of pixels along each side of a contact's image."""
MOMENTS = {0: "before one turning point", 1: "mid-stroke", 2: "before the other"}
"""Labels of the moments in `patches`, keyed by index in the dataset."""
AREAS = (
    ("patch_stick", "all", look.BLACK, look.SOLID),
    ("patch_stick_right", "right half", look.BLUE, look.DASHED),
    ("patch_stick_left", "left half", look.VERMILLION, look.DASHDOT),
)


def static(dataset: xr.Dataset) -> Figure:
    """Draw friction against the amplitude, and fractions of the bound against the radius."""
    figure = look.new_figure(look.DOUBLE, 6.4)
    grid = figure.subplots(2, 2)
    for axes, (motion, (title, quantity)) in zip(grid[0], MOTIONS.items(), strict=True):
        _friction(axes, dataset, motion)
        axes.set(xlabel=look.axis(quantity), ylabel=look.FRICTION)
        panels.legend_above(axes, title)
    for axes, motion in zip(grid[1], MOTIONS, strict=True):
        _shares(axes, dataset, motion)
        panels.legend_above(axes, "fraction of the friction bound")
    for axes in grid.flat:
        panels.unit_range(axes)
    return figure


def _friction(axes: Axes, dataset: xr.Dataset, motion: str) -> None:
    """Draw lines for the limit and the formulas, and markers for the points and the paper's run."""
    amplitude = dataset[f"{motion}_curve_amplitude"].values
    for variable, form in CURVES.items():
        if f"{motion}_curve_{variable}" in dataset:
            (color, ls), known = look.LIMITS[form], FORMS[motion][form]
            ink: look.Ink = {"color": color, "ls": ls, "label": known.equation or known.label}
            values = dataset[f"{motion}_curve_{variable}"].values
            axes.plot(amplitude, values, zorder=3, gid=variable, **ink)
    at, run = columns(dataset, f"{motion}_amplitude", f"{motion}_paper")
    paper, slowest = (float(dataset[f"claims_{name}"]) for name in ("paper_velocity", "slowest"))
    for what, velocity, marker in (("slow", paper, "o"), ("march", slowest, "v")):
        values, errors = columns(dataset, f"{motion}_{what}", f"{motion}_{what}_error")
        ink = {"label": rf"$\tilde{{v}} = {look.number(velocity)}$", "marker": marker}
        panels.computed(axes, at, values, errors, np.isfinite(errors), clip_on=False, **ink)
    label = rf"the paper's run, $\tilde{{v}} = {look.number(paper)}$"
    axes.plot(at, run, label=label, **PAPERS_RUN)
    axes.set_xlim(0.0, max(amplitude[-1], at.max()))


def _shares(axes: Axes, dataset: xr.Dataset, motion: str) -> None:
    """Draw the fractions of the bound for oscillation (solid) and forward friction (dashed)."""
    dim = f"{motion}_share_amplitude"
    radius, amplitudes = columns(dataset, "share_radius", dim)
    shades = matplotlib.colormaps[look.COLOURMAP](np.linspace(0.0, LIGHTEST, amplitudes.size))
    for index, (amplitude, color) in enumerate(zip(amplitudes, shades, strict=True)):
        row = dataset.isel({dim: index})
        label = look.conditions([(MOTIONS[motion][1].latex, float(amplitude))])
        axes.plot(radius, row[f"{motion}_used_share"], color=color, label=label, gid="used")
        axes.plot(radius, row[f"{motion}_left_share"], color=color, ls=look.DASHED, gid="left")
    for ls, label in ((look.SOLID, "used"), (look.DASHED, "remaining, forward")):
        axes.plot([], [], color=look.BLACK, ls=ls, label=label)
    axes.set(xlim=(0.0, 1.0), xlabel=r"radius  $r/a$")
    axes.set_ylabel("fraction of the bound  (dimensionless)")


def patches(dataset: xr.Dataset) -> Figure:
    """Draw the contact at three moments of an oscillating bore, and the stick area in a period."""
    figure = look.new_figure(look.DOUBLE, 5.2)
    grid = figure.subplot_mosaic("abc;ddd", height_ratios=(1.0, 0.72))
    contacts = [grid[which] for which in "abc"]
    for axes, (moment, note) in zip(contacts, MOMENTS.items(), strict=True):
        shade = _contact(axes, dataset.isel(patch_moment=moment))
        panels.heading(axes, note)
    contacts[0].set_ylabel(look.axis(FORWARD))
    label = "traction divided by bound  $|q|/(\\mu p)$\nwhere it sticks"
    panels.colour_bar(shade, contacts, label, shrink=0.8, pad=0.015, aspect=24)
    axes, phase = grid["d"], dataset["patch_phase"].values / np.pi
    for variable, label, color, ls in AREAS:
        axes.plot(phase, dataset[variable], color=color, ls=ls, label=label, gid=variable)
    for moment in dataset["patch_moment_phase"].values[list(MOMENTS)] / np.pi:
        axes.axvline(moment, color=look.GREY, lw=0.7, ls=look.DOTTED, zorder=0)
    symbols = MOTIONS["bore"][1].latex, VELOCITY["bore"].latex
    values = (float(dataset[f"patch_{n}"]) for n in ("amplitude", "velocity"))
    at = look.conditions(zip(symbols, values, strict=True))
    panels.legend_above(axes, f"stick area, {at}", ncols=3)
    axes.set(xlim=phase[[0, -1]], xlabel=r"phase  $\Omega t/\pi$")
    axes.set_ylabel("fraction of the contact  (dimensionless)")
    panels.unit_range(axes)
    return figure


def _contact(axes: Axes, at: xr.Dataset) -> ScalarMappable:
    """Draw points that stick, coloured by traction divided by bound. Points that slip are white."""
    lateral, forward, share = columns(at, "patch_lateral", "patch_forward", "patch_share")
    line = np.linspace(-1.0, 1.0, PIXELS)
    x, y = np.meshgrid(line, line)
    shares = griddata((lateral, forward), share, (x, y), method="nearest")
    slips = (shares >= 1.0) | (np.hypot(x, y) >= 1.0)
    scale: look.Ink = {"cmap": look.COLOURMAP, "vmin": 0.0, "vmax": 1.0, "rasterized": True}
    shade = axes.pcolormesh(line, line, np.ma.masked_where(slips, shares), gid="sticks", **scale)
    axes.set_aspect("equal")
    panels.rim(axes)
    edge = columns(at, "patch_edge_lateral", "patch_edge_forward")
    axes.plot(*edge, color=look.VERMILLION, ls=look.DASHED, gid="theory")
    phase = float(at["patch_moment_phase"]) / np.pi
    text = rf"{look.number(phase)}\,\pi" if abs(phase) > 1e-9 else "0"
    axes.text(0.5, 0.04, rf"$\Omega t = {text}$", transform=axes.transAxes, ha="center")
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.32, 1.08), xlabel=look.axis(LATERAL))
    axes.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    return shade
