"""Effect of Poisson's ratio: both maps at several of its values, and their differences."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import MU_MACRO
from microslip.report.figures import contour_labels, ticks
from microslip.report.figures import style as look
from microslip.report.figures.data import require
from microslip.report.figures.formulas import mathtext
from microslip.report.figures.surface import refined, supported

LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9)
LOOKS = (
    (look.BLACK, look.SOLID),
    (look.BLUE, look.DASHED),
    (look.VERMILLION, look.DOTTED),
    (look.GREEN, look.DASHDOT),
)
"""For up to so many of Poisson's ratios, from the smallest on."""
MOST = 3
"""Datasets that a figure has room for."""
DIVERGING = "PuOr"
"""Pale in the middle, and evenly darker on both sides."""


def shows(dataset: xr.Dataset) -> bool:
    """Whether a dataset holds what several of Poisson's ratios change."""
    return "mu_macro_change" in dataset and dataset.sizes.get("poisson", 1) > 1


def has_room(datasets: Sequence[xr.Dataset]) -> bool:
    """Whether a figure can show all that these datasets hold."""
    ratios = (dataset.sizes["poisson"] for dataset in datasets)
    return len(datasets) <= MOST and max(ratios) <= len(LOOKS)


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw a row of panels for each dataset, up to three: contours for every Poisson's ratio, and
    beside them what the largest one changes."""
    if len(datasets) > MOST:
        raise ValueError(f"figure {name}: {len(datasets)} maps; allowed: up to {MOST}")
    figure = look.new_figure(look.DOUBLE, 2.8 * len(datasets))
    panels = figure.subplots(len(datasets), 2, width_ratios=(1.0, 1.15), squeeze=False)
    letters = iter(look.letters(2 * len(datasets)))
    for (left, right), dataset in zip(panels, datasets, strict=True):
        key = dataset.attrs.get("title", name)
        needed = ["amplitude", "velocity", "poisson", "mu_macro", "mu_macro_change"]
        require(name, key, dataset, needed)
        shown = dataset.isel(velocity=dataset["velocity"].values > 0)
        shown = shown.sortby("poisson").transpose("poisson", "amplitude", "velocity", ...)
        if not 2 <= shown.sizes["poisson"] <= len(LOOKS):
            raise ValueError(f"figure {name}: two to {len(LOOKS)} of Poisson's ratios are needed")
        _contours(left, shown, next(letters))
        _change(right, shown, next(letters))
    return figure


def _contours(axes: Axes, shown: xr.Dataset, letter: str) -> None:
    for index, (color, linestyle) in enumerate(LOOKS[: shown.sizes["poisson"]]):
        one = shown.isel(poisson=index)
        lines = axes.contour(
            *supported(_refined(one, "mu_macro"), _points(one, "mu_macro"), LEVELS),
            levels=LEVELS,
            colors=[color],
            linestyles=[linestyle],
            linewidths=1.1,
        )
        if index == 0:
            look.after_layout(
                axes.figure,
                partial(contour_labels.label, axes, lines, LEVELS, look.SMALLEST),
            )
        label = rf"$\nu = {look.number(float(one['poisson']))}$"
        axes.plot([], [], color=color, linestyle=linestyle, label=label)
    _share(axes, shown)
    key = "title" if "group" in shown.attrs else "motion"
    note = look.literal(shown.attrs.get(key, ""))
    look.legend_above(axes, letter, note, ncols=shown.sizes["poisson"])


def _refined(one: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The fine grid of a map, and a variable there."""
    return refined(*_points(one, name))


def _points(one: xr.Dataset, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Velocities and amplitudes of the points of a map, and a variable there."""
    return one["velocity"].values, one["amplitude"].values, one[name].values


def _change(axes: Axes, shown: xr.Dataset, letter: str) -> None:
    """Pale is what the errors of the points leave open: twice the tolerance."""
    last = shown.isel(poisson=-1)
    x, y, values = _refined(last, "mu_macro_change")
    step = 2.0 * float(shown.attrs["tolerance"])
    if not step > 0.0:  # no tolerance was meant: what the points claim at most
        step = 2.0 * max(float(shown["mu_macro_error"].max()), 1e-3)
    count = max(2, int(np.ceil(np.abs(values).max() / step)))
    levels = step * np.array([k for k in range(-count, count + 1) if k])
    filled = axes.contourf(x, y, values, levels, cmap=DIVERGING)
    filled.set_edgecolor("face")
    _share(axes, shown)
    ends = (levels[0], -step, step, levels[-1])
    bar = axes.figure.colorbar(filled, ax=axes, pad=0.02, aspect=24, ticks=ends)
    first = look.number(float(shown["poisson"][0]))
    at = look.number(float(last["poisson"]))
    bar.set_label(rf"{MU_MACRO.math} at $\nu = {at}$ less that at ${first}$")
    bar.ax.tick_params(direction="out")
    look.letter(axes, letter, "")


def _share(axes: Axes, shown: xr.Dataset) -> None:
    velocity, amplitude = shown["velocity"].values, shown["amplitude"].values
    axes.set_xscale("log")
    axes.set(xlim=(velocity[0], velocity[-1]), ylim=(amplitude[0], amplitude[-1]))
    velocity_unit, amplitude_unit = (
        mathtext(shown[dim].attrs.get("formula", "")) for dim in ("velocity", "amplitude")
    )
    axes.set_xlabel(f"forward velocity  {velocity_unit}".strip())
    axes.set_ylabel(f"amplitude  {amplitude_unit}".strip())
    ticks.logarithmic(axes.xaxis)
    axes.tick_params(which="both", direction="out", top=False, right=False)
