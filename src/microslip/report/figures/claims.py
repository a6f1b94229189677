"""Figures of the study `claims`: static limits, fractions of the friction bound, stick zones."""

from __future__ import annotations

from dataclasses import replace

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from scipy.interpolate import griddata

from microslip.config.quantities import AMPLITUDE, FORWARD, LATERAL, VELOCITY
from microslip.datasets.catalogue import FORMS
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

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
    for axes, (motion, (_, quantity)) in zip(grid[1], MOTIONS.items(), strict=True):
        _shares(axes, dataset, motion, quantity.latex)
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
    paper, slowest = (float(dataset[f"claims_{n}"]) for n in ("paper_velocity", "slowest"))
    for what, velocity, marker in (("slow", paper, "o"), ("march", slowest, "v")):
        names = (f"{motion}_{n}" for n in ("amplitude", what, f"{what}_error"))
        at, values, errors = columns(dataset, *names)
        label = rf"$\tilde{{v}} = {look.number(velocity)}$"
        points = at, values, errors, np.isfinite(errors)
        panels.computed(axes, *points, label=label, marker=marker, clip_on=False)
    label = rf"the paper's run, $\tilde{{v}} = {look.number(paper)}$"
    ink = {"mfc": "none", "mec": look.VERMILLION, "mew": 1.1, "zorder": 6, "clip_on": False}
    axes.plot(at, dataset[f"{motion}_paper"].values, "s", ms=6.5, label=label, gid="paper", **ink)
    axes.set_xlim(0.0, max(amplitude[-1], at.max()))


def _shares(axes: Axes, dataset: xr.Dataset, motion: str, symbol: str) -> None:
    """Draw the fractions of the bound for oscillation (solid) and forward friction (dashed)."""
    radius, dim = dataset["share_radius"].values, f"{motion}_share_amplitude"
    amplitudes = dataset[dim].values
    shades = matplotlib.colormaps[look.COLOURMAP](np.linspace(0.0, LIGHTEST, amplitudes.size))
    for index, (amplitude, color) in enumerate(zip(amplitudes, shades, strict=True)):
        row = dataset.isel({dim: index})
        used, rest = columns(row, f"{motion}_used_share", f"{motion}_left_share")
        label = look.conditions([(symbol, float(amplitude))])
        axes.plot(radius, used, color=color, ls=look.SOLID, label=label, gid="used")
        axes.plot(radius, rest, color=color, ls=look.DASHED, gid="left")
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
        axes.plot(phase, dataset[variable].values, color=color, ls=ls, label=label, gid=variable)
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
    half = 0.5 * (line[1] - line[0])
    frame: look.Ink = {"origin": "lower", "extent": 2 * (-1 - half, 1 + half)}
    slips = (shares >= 1.0) | (np.hypot(x, y) >= 1.0)
    scale: look.Ink = {"cmap": look.COLOURMAP, "vmin": 0.0, "vmax": 1.0, "interpolation": "nearest"}
    shade = axes.imshow(np.ma.masked_where(slips, shares), gid="sticks", **scale, **frame)
    axes.add_patch(Circle((0, 0), 1.0, fill=False, lw=0.9))
    edge = columns(at, "patch_edge_lateral", "patch_edge_forward")
    axes.plot(*edge, color=look.VERMILLION, ls=look.DASHED, gid="theory")
    phase = float(at["patch_moment_phase"]) / np.pi
    text = rf"{look.number(phase)}\,\pi" if abs(phase) > 1e-9 else "0"
    axes.text(0.5, 0.04, rf"$\Omega t = {text}$", transform=axes.transAxes, ha="center")
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.32, 1.08), xlabel=look.axis(LATERAL))
    axes.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    return shade
