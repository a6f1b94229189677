"""Maps of the velocity that a constant force gives a vibrated contact."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from microslip.config.quantities import AMPLITUDE, DRIVES, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures.data import curve, limit, require, sweep
from microslip.theory.catalogue import STATIC

DECADES = np.linspace(-3.0, 1.0, 17)
"""Decimal logarithms of the velocities that bands begin at."""
LINES = (0.01, 0.1, 1.0)
"""Velocities that have a line."""
RIGID = "velocity_large_amplitude"
NEEDED = ("force", "amplitude", "velocity", "converged", RIGID, STATIC)
STAYS: dict[str, Any] = {"facecolor": look.PALE, "edgecolor": "none"}
UNCONVERGED: dict[str, Any] = {"color": look.BLACK, "marker": "x", "linestyle": "none"}


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw the velocity over force and amplitude, sideways and under oscillating bore."""
    figure, marked = look.new_figure(look.DOUBLE, 3.3), False
    panels = figure.subplots(1, len(datasets))
    for axes, letter, dataset in zip(panels, look.letters(len(datasets)), datasets, strict=True):
        require(name, dataset.attrs.get("title", name), dataset, NEEDED)
        filled, has_marks = _map(axes, dataset, letter)
        marked |= has_marks
    bar = figure.colorbar(filled, ax=list(panels), pad=0.02, ticks=np.arange(-3.0, 2.0))
    bar.ax.set_yticklabels([f"${look.number(10.0**power)}$" for power in np.arange(-3.0, 2.0)])
    bar.set_label("mean velocity  (dimensionless)")
    bar.ax.tick_params(direction="out")
    _legend(figure, marked)
    return figure


def _map(axes: Axes, dataset: xr.Dataset, letter: str) -> tuple[ContourSet, bool]:
    """One map; returns its bands, and whether a point is marked as not converged."""
    motion = dataset.attrs["motion"]
    part, poisson = sweep(dataset.assign(mu_macro=dataset["velocity"]), ("amplitude", "force"))
    part = part.transpose("amplitude", "force", ...)
    force, amplitude = part["force"].values, part["amplitude"].values
    slowest, fastest = 10.0 ** DECADES[[0, -1]]
    shown = np.log10(np.clip(np.nan_to_num(part["velocity"].values), slowest, fastest))
    bands = axes.contourf(
        force, amplitude, shown, levels=DECADES, cmap=look.COLOURMAP, extend="both"
    )
    bands.set_edgecolor("face")
    levels = np.log10(LINES)
    lines = axes.contour(
        *(force, amplitude, shown),
        levels=levels,
        colors="white",
        linestyles="solid",  # their logarithms are below 0, which alone means nothing
        linewidths=0.9,
        gid="contours",
    )
    axes.clabel(lines, fmt={at: f"{10.0**at:g}" for at in levels}, fontsize=look.SMALLEST)
    rigid = np.log10(part[RIGID].transpose("amplitude", "force").values)
    axes.contour(
        *(force, amplitude, rigid),
        levels=levels,
        colors=look.VERMILLION,
        linestyles=[look.DASHED],
        linewidths=1.0,
        gid=RIGID,
    )
    across, held = curve(limit(part, STATIC))
    axes.fill_betweenx(across, 0.0, held, zorder=3, gid="stays", **STAYS)
    axes.plot(held, across, color=look.BLACK, linewidth=1.3, zorder=4, gid=STATIC)
    axes.set(xlim=(force[0], force[-1]), ylim=(amplitude[0], amplitude[-1]))
    axes.set_xlabel(look.axis(DRIVES["force"]))
    axes.set_ylabel(look.axis(AMPLITUDE[motion]))
    axes.tick_params(which="both", direction="out", top=False, right=False)
    note = "velocity " + look.axis(VELOCITY[motion]).removeprefix(VELOCITY[motion].text).strip()
    look.letter(axes, letter, note + (rf", $\nu = {look.number(poisson)}$" if poisson else ""))
    bad = np.argwhere(part["converged"].values == 0)
    axes.plot(force[bad[:, 1]], amplitude[bad[:, 0]], gid="unconverged", **UNCONVERGED)
    return bands, bool(len(bad))


def _legend(figure: Figure, marked: bool) -> None:
    rigid: dict[str, Any] = {"color": look.VERMILLION, "linestyle": look.DASHED, "linewidth": 1.0}
    handles = [
        Line2D([], [], color=look.BLACK, linewidth=1.3, label="static limit: threshold"),
        Patch(label="comes to rest", **STAYS),
        Line2D([], [], label="rigid contact, at the same velocities", **rigid),
    ]
    if marked:
        handles.append(Line2D([], [], label="not converged", **UNCONVERGED))
    figure.legend(handles=handles, loc="outside upper center", ncols=len(handles))
