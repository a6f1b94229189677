"""The static limit beside the paper's formulas, and the part of the bound that makes the gap."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import AMPLITUDE, Quantity
from microslip.report.figures import style as look
from microslip.report.figures.cuts import computed
from microslip.report.figures.data import require
from microslip.theory.catalogue import FORMS, STATIC

BORE_AMPLITUDE = replace(AMPLITUDE["bore"], latex=r"\tilde{\varphi}")
MOTIONS = (
    (
        *("transverse", "transverse oscillation", AMPLITUDE["transverse"]),
        (
            ("limit", STATIC, look.BLUE, look.SOLID),
            ("zone", "mu_static_stick_zone", look.GREEN, look.DASHED),
            ("slider", "mu_static_slider", look.ORANGE, look.DASHDOT),
        ),
    ),
    (
        *("bore", "oscillating bore", BORE_AMPLITUDE),
        (
            ("limit", STATIC, look.BLUE, look.SOLID),
            ("zone", "mu_static_stick_zone", look.GREEN, look.DASHED),
            ("zone_printed", "mu_static_stick_zone_printed", look.ORANGE, look.DOTTED),
        ),
    ),
)
"""Each column: the motion, its name, its amplitude, and its curves: variable, closed form, colour
and line style."""
POINTS = ("slow", "slow_error", "paper", "march", "march_error")
LIGHTEST = 0.82
"""Shades for curves of one kind, from dark to light; the lightest are too pale for lines."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw friction over amplitude above, shares of the bound over the radius below."""
    needed = ["share_radius", "claims_slowest", "claims_paper_velocity"]
    for motion, _, _, curves in MOTIONS:
        needed += [f"{motion}_curve_{n}" for n in ("amplitude", *(c[0] for c in curves))]
        needed += [f"{motion}_{n}" for n in ("amplitude", "used_share", "left_share", *POINTS)]
    require(name, "claims", dataset, needed)

    figure = look.new_figure(look.DOUBLE, 6.4)
    grid = figure.subplots(2, 2)
    for axes, below, upper, lower, motion in zip(*grid, "ab", "cd", MOTIONS, strict=True):
        _friction(axes, dataset, motion)
        look.legend_above(axes, upper, motion[1])
        _shares(below, dataset, motion[0], motion[2])
        look.legend_above(below, lower, "share of the friction bound")
    return figure


def _friction(axes: Axes, dataset: xr.Dataset, column: tuple) -> None:
    """The limit and formulas for it as lines; certified points and the paper's run as marks."""
    motion, _, quantity, curves = column
    amplitude = dataset[f"{motion}_curve_amplitude"].values
    for variable, name, color, linestyle in curves:
        values, form = dataset[f"{motion}_curve_{variable}"].values, FORMS[motion][name]
        ink: dict[str, Any] = {
            "color": color,
            "linestyle": linestyle,
            "label": form.equation or form.label,
        }
        axes.plot(amplitude, values, gid=variable, zorder=3, **ink)
    at = dataset[f"{motion}_amplitude"].values
    paper, slowest = (float(dataset[f"claims_{n}"]) for n in ("paper_velocity", "slowest"))
    for variable, velocity, marker in (("slow", paper, "o"), ("march", slowest, "v")):
        values, errors = (dataset[f"{motion}_{n}"].values for n in (variable, f"{variable}_error"))
        text = rf"$\tilde{{v}} = {look.number(velocity)}$"
        good = np.isfinite(errors)
        ink = {"marker": marker, "color": look.BLACK, "clip_on": False}
        computed(axes, at, values, errors, good, text, **ink)
    axes.plot(
        at,
        dataset[f"{motion}_paper"].values,
        label=rf"the paper's run, $\tilde{{v}} = {look.number(paper)}$",
        gid="paper",
        linestyle="none",
        marker="s",
        markersize=6.5,
        markerfacecolor="none",
        markeredgecolor=look.VERMILLION,
        markeredgewidth=1.1,
        zorder=6,
        clip_on=False,
    )
    axes.set(xlim=(0.0, amplitude[-1]), xlabel=look.axis(quantity), ylabel=look.FRICTION)
    look.unit_range(axes)


def _shares(axes: Axes, dataset: xr.Dataset, motion: str, quantity: Quantity) -> None:
    """Draw the share of the bound that the oscillation uses, solid, and the rest, dashed."""
    radius = dataset["share_radius"].values
    dim = f"{motion}_share_amplitude"
    amplitudes = dataset[dim].values
    shades = matplotlib.colormaps[look.COLOURMAP](np.linspace(0.0, LIGHTEST, amplitudes.size))
    for index, (amplitude, color) in enumerate(zip(amplitudes, shades, strict=True)):
        row = dataset.isel({dim: index})
        used, left = (row[f"{motion}_{n}_share"].values for n in ("used", "left"))
        text = look.conditions([(quantity.latex, float(amplitude))])
        axes.plot(radius, used, color=color, linestyle=look.SOLID, label=text, gid="used")
        axes.plot(radius, left, color=color, linestyle=look.DASHED, gid="left")
    for linestyle, text in ((look.SOLID, "used"), (look.DASHED, "left, forward")):
        axes.plot([], [], color=look.BLACK, linestyle=linestyle, label=text)
    axes.set(xlim=(0.0, 1.0), xlabel=r"radius  $r/a$", ylabel="share of the bound  (dimensionless)")
    look.unit_range(axes)
