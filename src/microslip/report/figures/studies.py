"""Draw the figures of the studies.

The figures of the study `accuracy` are performance profiles, plots of error against cost, and maps
of the cheapest model. The figure of the study `stability` is a table. A coloured square shows the
outcome of each method in each case. The figures of the study `claims` show static limits, fractions
of the friction bound, and stick zones.
"""

from __future__ import annotations

from functools import partial

import matplotlib
import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from scipy import ndimage

from microslip.config.quantities import AMPLITUDE, FORWARD, MU_MACRO, VELOCITY
from microslip.datasets.catalogue import FORMS, STATIC
from microslip.report.figures import style as look
from microslip.report.motions import MOTIONS
from microslip.report.selection import columns
from microslip.studies.static_limits import FORMULAS

# Accuracy

NAMES = {"auto": "chosen by tolerance", "paper": "paper's run"}
"""Labels of competitors whose names need an explanation."""
LEAST_RANGE = 10.0
"""The axis of a profile extends at least to this cost ratio."""
COSTS = {
    "seconds": "CPU time of a run  $t$ (s)",
    "effort": "effort: iterations $\\times$ unknowns\n(dimensionless)",
}
"""Label of each cost."""
ACROSS, WIDTH, ROW, LINE = 3, 1.95, 1.95, 0.15
"""Number of panels in a row, followed by the width of a panel, the height of a row and the height
of a legend line, all in inches."""
MOST = 1e6
"""Largest ratio of the upper to the lower end of the axis of errors."""
EDGE = 0.06
"""A value outside the range is drawn at this distance from the range. The distance is given as a
fraction of the range."""
FRONT: look.Ink = {"color": "#EBD9A0", "lw": 5.0, "solid_capstyle": "round", "zorder": 1}
AUTO: look.Ink = {"color": look.BLACK, "marker": "D", "lw": 0.8, "ms": 4.2, "zorder": 7}
PAPER: look.Ink = {"color": look.BLACK, "marker": "*", "ls": "none", "ms": 9.0, "zorder": 8}
OTHER: look.Ink = {"color": "#8C8C8C", "marker": "o", "ls": "none", "ms": 2.0, "zorder": 3}
CROSS: look.Ink = {"color": look.BLACK, "marker": "x", "ls": "none", "ms": 5.0, "zorder": 9}
BEYOND: look.Ink = {"mfc": "none", "mec": look.BLACK, "marker": "o", "ls": "none", "ms": 7.5}
BEYOND |= {"mew": 0.6, "zorder": 9}
MARKS = {
    "Pareto front": FRONT,
    **{NAMES["auto"]: AUTO, NAMES["paper"]: PAPER, "any other method": OTHER},
    **{"not converged, or none": CROSS, "beyond the axis": BEYOND},
}
"""Labels and styles of the legend entries that apply to all models."""
SHIPPED: look.Ink = {"lw": 1.1, "ms": 4.2, "mew": 0.8, "zorder": 5}
UNKNOWN: look.Ink = {"fc": "none", "ec": "#A8A8A8", "lw": 0.0, "hatch": "/////"}
NONE: look.Ink = {"fc": "white", "ec": look.GREY, "lw": 0.0, "hatch": 5 * "/"}


def profile(dataset: xr.Dataset) -> Figure:
    """Draw performance profiles at the tightest tolerance, with a panel for each contest.

    A profile is the fraction of points that a competitor solves within a given cost ratio.
    """
    dataset = dataset.isel(map_tolerance=int(np.argmin(dataset["map_tolerance"].values)))
    of_contest = dataset["competitor_contest"].values.astype(str)
    contests = list(dict.fromkeys(of_contest))
    figure = look.new_figure(look.DOUBLE, 3.1 * -(-len(contests) // 2))
    grid = look.grid(figure, len(contests), 2)
    tolerance = look.number(float(dataset["map_tolerance"]))
    for axes, contest in zip(grid, contests, strict=True):
        own = dataset.isel(competitor=of_contest == contest)
        ratios = own["profile_ratio"].transpose("competitor", "point").values
        high = 1.3 * max(ratios[np.isfinite(ratios)].max(initial=1.0), LEAST_RANGE)
        names = own["competitor"].values.astype(str)
        # The default method comes first and is black. The others follow in the order of the
        # dataset.
        order = np.argsort(~np.isin(names, ("shipped", "auto")), kind="stable")
        for place, (name, row) in enumerate(zip(names[order], ratios[order], strict=True)):
            at = np.sort(row[np.isfinite(row)])
            color, _, ls = look.LINES[min(place, len(look.LINES) - 1)]
            color = look.MODELS.get(name, (color,))[0]
            shares = np.array([0, *range(1, at.size + 1), at.size]) / row.size
            label = NAMES.get(name, name) + ("" if at.size else ": never")
            ink: look.Ink = {"color": color, "drawstyle": "steps-post", "label": label}
            ink |= {"ls": look.DOTTED if place and color == look.BLACK else ls}
            ink |= {"lw": 1.3 if place else 1.8, "gid": f"profile {name}"}
            axes.plot([1.0, *at, high], shares, **ink)
        axes.set_ylabel("fraction of points  (dimensionless)")
        axes.set_xlabel(r"CPU time divided by the smallest  $t/t_\mathrm{best}$")
        look.logarithmic(axes, (1.0, high))
        look.unit_range(axes)
        look.legend_above(axes, rf"{contest}, error within ${tolerance}$")
    return figure


def _versus(dataset: xr.Dataset, cost: str) -> Figure:
    """Draw the errors of all trials against the cost, with a panel for each point.

    Each model with the default method has its own colour and marker. Runs of other methods are
    grey. Trials outside the axes are drawn at the edge, each with a circle around its marker. A
    trial is outside the axes if its error is far below the error of the reference, or if its result
    or its cost is missing.
    """
    names = {f"trial_{name}": name for name in ("point", "model", "method", "level")}
    names |= {cost: "cost", f"front_{cost}": "front"}
    trials = dataset[[*names, "error", "converged"]].to_dataframe().rename(columns=names)
    trials = trials.sort_values("level", kind="stable")
    models = look.in_order(set(trials["model"]) - {"auto"})
    count = dataset["point"].size
    height = ROW * -(-count // ACROSS) + LINE * -(-(len(models) + 7) // ACROSS) + 0.45
    figure = look.new_figure(look.DOUBLE, height)
    grid = look.grid(figure, count, ACROSS, sharex=True, sharey=True)
    finite = trials[["cost", "error"]].where(np.isfinite)
    paid, most = finite["cost"].where(finite["cost"] > 0.0, 1.0), finite["error"].max()
    ends = {"cost": (paid.min(), paid.max()), "error": (most / MOST, most)}
    x, y = (finite[one].fillna(np.inf).clip(*_beyond(*ends[one], EDGE)) for one in ends)
    bad = finite["error"].isna() | (trials["converged"] == 0)
    beyond = (x != trials["cost"]) | (y != trials["error"])
    trials = trials.assign(x=x, y=y, bad=bad, beyond=beyond)
    xlim, ylim = (_beyond(*each, 2 * EDGE) for each in ends.values())
    grid[0].set(xscale="log", yscale="log", xlim=xlim, ylim=ylim)
    for index, axes in enumerate(grid):
        point = dataset.isel(point=index)
        _trials(axes, trials[trials["point"] == str(point["point"].item())])
        if (limit := float(point["reference_error"])) > ylim[0]:
            axes.axhspan(ylim[0], min(limit, ylim[1]), gid="reference", zorder=0.5, **UNKNOWN)
        values = {dim: float(point[f"point_{dim}"]) for dim in ("velocity", "amplitude", "poisson")}
        conditions = look.conditions(str(point["point_motion"].item()), values)
        title = look.literal(point["point_title"].item())
        look.heading(axes, f"{title}\n{conditions}", WIDTH)
        if index + ACROSS >= count:
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(COSTS[cost])
    figure.supylabel(f"error of {MU_MACRO.math}  (dimensionless)", fontsize=look.LABEL)
    styles = {f"{one}, shipped method": _ink(one, "shipped") for one in models} | MARKS
    marks: list = [Line2D([], [], label=label, **ink) for label, ink in styles.items()]
    marks.append(Patch(label="within the reference's error", **UNKNOWN))
    look.legend_of_figure(figure, marks, "lower center", ncols=ACROSS, fontsize=look.SMALLEST)
    return figure


versus_cost = partial(_versus, cost="seconds")
"""Draw errors against CPU time."""
versus_work = partial(_versus, cost="effort")
"""Draw errors against effort."""


def _beyond(low: float, high: float, share: float) -> tuple[float, float]:
    """Return a value below and a value above a logarithmic range. The distance from each value to
    the range is `share` times the length of the range."""
    factor = (high / low) ** share
    return low / factor, high * factor


def _trials(axes: Axes, trials: pd.DataFrame) -> None:
    """Draw every trial at a point, with a curve for each model and markers for other methods."""
    front = trials[trials["front"] != 0].sort_values(["x", "y"], ascending=[True, False])
    axes.plot(front["x"], front["y"], drawstyle="steps-post", gid="front", **FRONT)
    for (model, method), own in trials.groupby(["model", "method"], sort=False):
        ink, known = _ink(model, method), own[np.isfinite(own["error"])]
        axes.plot(known["x"], known["y"], gid=f"{model} {method}", **ink)
        bad = own[own["bad"]]
        axes.plot(bad["x"], bad["y"], gid="hollow", **ink | {"ls": "none", "mfc": "w"})
    for name, ink in (("bad", CROSS), ("beyond", BEYOND)):
        which = trials[trials[name]]
        axes.plot(which["x"], which["y"], gid=name, **ink)


def _ink(model: str, method: str) -> look.Ink:
    """Return the colour, marker and line style for trials of a model with a method."""
    if method == "paper":
        return PAPER
    if model == "auto":
        return AUTO
    color, marker = look.model(model)
    return SHIPPED | {"color": color, "marker": marker} if method == "shipped" else OTHER


def model_map(dataset: xr.Dataset) -> Figure:
    """Draw the cheapest accurate model at each velocity and amplitude, with a row of panels for
    each motion and a column for each tolerance."""
    tolerances = dataset["map_tolerance"].values
    names = {str(n) for motion in MOTIONS for n in dataset[f"{motion}_cheapest"].values.ravel()}
    models = look.in_order(names - {""})
    figure = look.new_figure(look.DOUBLE, 5.9)
    grid = figure.subplots(len(MOTIONS), tolerances.size, squeeze=False, sharex="row", sharey="row")
    for row, motion in zip(grid, MOTIONS, strict=True):
        for index, axes in enumerate(row):
            _cheapest(axes, dataset.isel(map_tolerance=index), motion, models)
            tolerance = look.number(float(tolerances[index]))
            look.heading(axes, rf"{motion}, error within ${tolerance}$")
            axes.set_xlabel(look.axis(VELOCITY[motion]))
        row[0].set_ylabel(look.axis(AMPLITUDE[motion]))
    handles = [
        Patch(fc=_pale(n), ec=look.BLACK, lw=0.6, label=rf"$\bf{{{_short(n)}}}$  {n}")
        for n in models
    ]
    handles += [Patch(label="no model within the tolerance", **NONE)] if "" in names else []
    look.legend_of_figure(figure, handles, "lower center", ncols=4)
    return figure


def _cheapest(axes: Axes, dataset: xr.Dataset, motion: str, models: list[str]) -> None:
    """Colour each cell by its cheapest model, and label each connected region."""
    dims = f"{motion}_amplitude", f"{motion}_velocity"
    amplitude, velocity = columns(dataset, *dims)
    names = dataset[f"{motion}_cheapest"].transpose(*dims).values.astype(str)
    steps = np.diff(amplitude)
    logarithmic = bool(amplitude[0] > 0 and not np.allclose(steps, steps[:1], rtol=0.1))
    x, y = look.edges(velocity, True), look.edges(amplitude, logarithmic)
    axes.set(xscale="log", yscale="log" if logarithmic else "linear")
    look.cells(axes, x, y, names == "", gid="none", **NONE)
    text: look.Ink = {"ha": "center", "va": "center", "fontweight": "bold", "gid": "region"}
    for name in models:
        # Coloured edges prevent hairlines between the cells in PDF files.
        ink: look.Ink = {"fc": _pale(name), "ec": _pale(name), "lw": 0.3, "gid": f"cheapest {name}"}
        look.cells(axes, x, y, names == name, **ink)
        regions, count = ndimage.label(names == name)
        for region in range(1, count + 1):
            depth = ndimage.distance_transform_cdt(np.pad(regions == region, 1))[1:-1, 1:-1]
            # The label is in the most central one of the cells that are farthest from the border.
            deepest = np.argwhere(depth == depth.max())
            i, j = deepest[np.argmin(np.hypot(*(deepest - deepest.mean(axis=0)).T))]
            axes.text(velocity[j], amplitude[i], _short(name), **text)
    axes.set(xlim=x[[0, -1]], ylim=y[[0, -1]])
    for axis in (axes.xaxis, axes.yaxis) if logarithmic else (axes.xaxis,):
        look.logarithmic_ticks(axis)
    look.ticks_outside(axes)


def _short(model: str) -> str:
    return model[:2].capitalize()


def _pale(model: str) -> tuple[float, ...]:
    """Return the colour of a model, lightened so that black letters on it are readable."""
    return tuple(0.5 + 0.5 * part for part in to_rgb(look.model(model)[0]))


# Stability

OUTCOMES = {
    1: ("converged", "#CDE7DC", "\N{CHECK MARK}", "#00664A", "within its error estimate"),
    2: ("slow", "#F0B84B", "S", look.BLACK, "not converged within its budget, as reported"),
    3: ("wrong", "#C04F00", "W", "white", "reported as converged, but too far from the reference"),
    4: ("diverged", "#222222", "D", "white", "diverged, or no result"),
}
"""Name, fill colour, symbol, symbol colour and meaning of each outcome, by code. The fill colours
become darker from good to bad, so that they also differ in greyscale."""
CASE, LEGEND = 0.125, 1.7
"""Height of a row of the table, and total height of the method names and the legend, in inches."""
NOTE = 2.8
"""Width of the notes beside the table, in inches."""


def atlas(dataset: xr.Dataset) -> Figure:
    """Draw a table of the outcomes, with a row for each case and a column for each method. A square
    is blank if the method does not apply."""
    outcome = dataset["outcome"].transpose("case", "method").values.astype(int)
    methods = dataset["method"].values.astype(str)
    of_case, labels = (part.astype(str) for part in columns(dataset, "case_axis", "case_label"))
    order = np.argsort(methods != "shipped", kind="stable")  # the default method comes first
    order = order[(outcome.any(axis=0) | (methods == "shipped"))[order]]
    texts = zip(*columns(dataset, "axis", "axis_label", "axis_note"), strict=True)
    blocks = [(np.flatnonzero(of_case == str(axis)), *two) for axis, *two in texts]
    blocks = [block for block in blocks if block[0].size]
    sizes = [own.size for own, *_ in blocks]
    figure = look.new_figure(look.DOUBLE, CASE * (sum(sizes) + 2 * len(sizes)) + LEGEND)
    grid = figure.subplots(len(sizes), 1, squeeze=False, sharex=True, height_ratios=sizes)[:, 0]
    small: look.Ink = {"fontsize": look.SMALLEST}
    for axes, (own, title, note) in zip(grid, blocks, strict=True):
        codes = outcome[np.ix_(own, order)]
        x, y = np.arange(len(order) + 1), np.arange(own.size + 1)
        for code, (_, fill, sign, color, _) in OUTCOMES.items():
            square: look.Ink = {"fc": fill, "ec": "white", "lw": 0.8, "gid": f"outcome {code}"}
            look.cells(axes, x, y, codes == code, **square)
            text = small | {"color": color, "ha": "center", "va": "center_baseline"}
            text |= {"fontweight": "normal" if code == 1 else "bold"}
            for row, column in np.argwhere(codes == code):
                axes.text(column + 0.5, row + 0.5, sign, **text)
        axes.add_patch(Rectangle((0, 0), 1, own.size, fill=False, clip_on=False))
        axes.set(xlim=(0, len(order)), ylim=(own.size, 0))
        axes.set_yticks(y[:-1] + 0.5, labels[own])
        axes.tick_params(length=0, pad=1.5, labelbottom=False, labelsize=look.SMALLEST)
        axes.spines[:].set_visible(False)
        look.heading(axes, look.literal(title))
        wide = look.wrapped(look.literal(note), NOTE, look.SMALLEST)
        beside = small | {"va": "top", "color": look.GREY, "linespacing": 1.1}
        axes.text(1.02, 1.0, wide, transform=axes.transAxes, **beside)
    grid[0].set_xticks(x[:-1] + 0.5, methods[order], rotation=90)
    grid[0].tick_params(axis="x", labeltop=True, pad=16.0)
    grid[0].get_xticklabels()[0].set_fontweight("bold")
    handles = [
        Patch(fc=fill, label=f"{sign}  {name}: {meaning}")
        for name, fill, sign, _, meaning in OUTCOMES.values()
    ]
    handles.append(Patch(fc="white", ec=look.PALE, label="blank: the method does not apply"))
    look.legend_of_figure(figure, handles, "lower left", ncols=1, **small)
    return figure


# Claims

PAPERS_RUN: look.Ink = {"mfc": "none", "mec": look.VERMILLION, "mew": 1.1, "zorder": 6, "ms": 6.5}
PAPERS_RUN |= {"marker": "s", "ls": "none", "clip_on": False, "gid": "paper"}
LIGHTEST = 0.82
"""Upper end of the colour map for lines. Lighter lines would have too little contrast."""
MOMENTS = {0: "before one turning point", 1: "mid-stroke", 2: "before the other"}
"""Labels of the moments in `patches`, keyed by the index of the moment in the dataset."""
AREAS = (
    ("patch_stick", "all", look.BLACK, look.SOLID),
    ("patch_stick_right", "right half", look.BLUE, look.DASHED),
    ("patch_stick_left", "left half", look.VERMILLION, look.DASHDOT),
)


def static(dataset: xr.Dataset) -> Figure:
    """Draw friction against the amplitude, and fractions of the friction bound against the
    radius."""
    figure = look.new_figure(look.DOUBLE, 6.4)
    grid = figure.subplots(2, 2)
    for axes, (motion, texts) in zip(grid[0], MOTIONS.items(), strict=True):
        _friction(axes, dataset, motion)
        axes.set(xlabel=look.axis(AMPLITUDE[motion]), ylabel=look.FRICTION)
        look.legend_above(axes, texts.title)
    for axes, motion in zip(grid[1], MOTIONS, strict=True):
        _shares(axes, dataset, motion)
        look.legend_above(axes, "fraction of the friction bound")
    for axes in grid.flat:
        look.unit_range(axes)
    return figure


def _friction(axes: Axes, dataset: xr.Dataset, motion: str) -> None:
    """Draw lines for the limit and the formulas, and markers for the points and the paper's run."""
    amplitude = dataset[f"{motion}_curve_amplitude"].values
    for variable, form in {"limit": STATIC, **FORMULAS[motion]}.items():
        values, known = dataset[f"{motion}_curve_{variable}"], FORMS[motion][form]
        look.closed_form(axes, amplitude, values, form, known.equation or known.label)
    at, run = columns(dataset, f"{motion}_amplitude", f"{motion}_paper")
    for what, name, marker in (("march", "slowest", "v"), ("slow", "paper_velocity", "o")):
        values, errors = columns(dataset, f"{motion}_{what}", f"{motion}_{what}_error")
        label = look.conditions(motion, {"velocity": float(dataset[f"claims_{name}"])})
        ink: look.Ink = {"label": label, "marker": marker, "clip_on": False}
        look.computed(axes, at, values, errors, np.isfinite(errors), **ink)
    axes.plot(at, run, label=f"the paper's run, {label}", **PAPERS_RUN)
    axes.set_xlim(0.0, max(amplitude[-1], at.max()))


def _shares(axes: Axes, dataset: xr.Dataset, motion: str) -> None:
    """Draw two fractions of the friction bound: the fraction that the oscillation uses (solid), and
    the fraction that is left for forward friction (dashed)."""
    dim = f"{motion}_share_amplitude"
    radius, amplitudes = columns(dataset, "share_radius", dim)
    shades = matplotlib.colormaps[look.COLOURMAP](np.linspace(0.0, LIGHTEST, amplitudes.size))
    for index, (amplitude, color) in enumerate(zip(amplitudes, shades, strict=True)):
        row = dataset.isel({dim: index})
        label = look.conditions(motion, {"amplitude": amplitude})
        axes.plot(radius, row[f"{motion}_used_share"], color=color, label=label, gid="used")
        axes.plot(radius, row[f"{motion}_left_share"], color=color, ls=look.DASHED, gid="left")
    for ls, label in ((look.SOLID, "used"), (look.DASHED, "remaining, forward")):
        axes.plot([], [], color=look.BLACK, ls=ls, label=label)
    axes.set(xlim=(0.0, 1.0), xlabel=r"radius  $r/a$")
    axes.set_ylabel("fraction of the bound  (dimensionless)")


def patches(dataset: xr.Dataset) -> Figure:
    """Draw the contact at three moments of an oscillating bore, and the stick area over a
    period."""
    figure = look.new_figure(look.DOUBLE, 5.2)
    grid = figure.subplot_mosaic("abc;ddd", height_ratios=(1.0, 0.72))
    contacts = [grid[which] for which in "abc"]
    for axes, (moment, note) in zip(contacts, MOMENTS.items(), strict=True):
        shade = _contact(axes, dataset.isel(patch_moment=moment))
        look.heading(axes, note)
    contacts[0].set_ylabel(look.axis(FORWARD))
    label = "traction divided by bound  $|q|/(\\mu p)$\nwhere it sticks"
    look.colour_bar(shade, contacts, label, shrink=0.8, pad=0.015, aspect=24)
    axes, phase = grid["d"], dataset["patch_phase"].values / np.pi
    for variable, label, color, ls in AREAS:
        axes.plot(phase, dataset[variable], color=color, ls=ls, label=label, gid=variable)
    for moment in dataset["patch_moment_phase"].values[list(MOMENTS)] / np.pi:
        axes.axvline(moment, color=look.GREY, lw=0.7, ls=look.DOTTED, zorder=0)
    at = {name: float(dataset[f"patch_{name}"]) for name in ("amplitude", "velocity")}
    look.legend_above(axes, f"stick area, {look.conditions('bore', at)}", ncols=3)
    axes.set(xlim=phase[[0, -1]], xlabel=r"phase  $\Omega t/\pi$")
    axes.set_ylabel("fraction of the contact  (dimensionless)")
    look.unit_range(axes)
    return figure


def _contact(axes: Axes, at: xr.Dataset) -> ScalarMappable:
    """Colour each sticking point by the ratio of the traction to the friction bound.  Slipping
    points are white."""
    share = at["patch_share"].where(at["patch_share"] < 1.0).values
    x, y = columns(at, "patch_lateral", "patch_forward")
    ink: look.Ink = {"cmap": look.COLOURMAP, "vmax": 1.0, "gid": "sticks"}
    shade = look.disc(axes, x, y, share, "nearest", **ink)
    edge = columns(at, "patch_edge_lateral", "patch_edge_forward")
    axes.plot(*edge, color=look.VERMILLION, ls=look.DASHED, gid="theory")
    phase = float(at["patch_moment_phase"]) / np.pi
    text = rf"{look.number(phase)}\,\pi" if abs(phase) > 1e-9 else "0"
    axes.text(0.5, 0.04, rf"$\Omega t = {text}$", transform=axes.transAxes, ha="center")
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.32, 1.08), xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    return shade
