"""Figure of self-propelled motions: force and efficiency, from stall to no load."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns, finite_or_nan

ROWS = {"force": r"force  $F/(\mu F_z)$", "efficiency": "efficiency  (dimensionless)"}
"""Variable and label of each row of panels."""
WIDTH, HEIGHT = 2.36, 5.2
VELOCITY = r"forward velocity  $v_0/(\omega u_\mathrm{lim})$"


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw a column of panels (force and efficiency) for each value of the variable `panel`."""
    names = [str(panel) for panel in dict.fromkeys(dataset["panel"].values)]
    figure = look.new_figure(max(WIDTH * len(names), look.SINGLE), HEIGHT)
    grid = figure.subplots(len(ROWS), len(names), sharex="col", squeeze=False)
    for row, (variable, label) in zip(grid, ROWS.items(), strict=True):
        row[0].set_ylabel(label)
        for axes, panel in zip(row, names, strict=True):
            lines = dataset.isel(line=np.flatnonzero(dataset["panel"].values == panel))
            _lines(axes, lines, variable)
            note = look.literal(panel) if variable == "force" else ""
            panels.heading(axes, note, WIDTH - 0.5)
    for axes in grid[-1]:
        axes.set_xlabel(VELOCITY)
        _legend(axes)
    return figure


def _lines(axes: Axes, dataset: xr.Dataset, variable: str) -> None:
    """Draw the lines of a panel. A line has hollow markers if one of its points is unconverged."""
    axes.axhline(0.0, color=look.PALE, lw=0.7, zorder=0.5)
    for k, (color, marker, ls) in zip(range(dataset.sizes["line"]), look.LINES, strict=False):
        one = dataset.isel(line=k)
        face = color if bool(one["converged"]) else "white"
        ink: look.Ink = {"marker": marker, "ms": 3.2, "mfc": face, "ls": ls, "lw": 1.0}
        ink |= {"mew": 0.7}
        x, y, error = map(finite_or_nan, columns(one, "velocity", variable, f"{variable}_error"))
        label = look.wrapped(look.literal(one["title"].values), WIDTH - 0.9, 7.5)
        axes.errorbar(x, y, yerr=error, fmt="none", ecolor=color, **look.ERROR_BARS)
        axes.plot(x, y, color=color, label=label, gid=variable, **ink)


def _legend(axes: Axes) -> None:
    """Add the legend of a column below its lower panel."""
    axes.legend(
        handles=[line for line in axes.get_lines() if line.get_gid() == "efficiency"],
        loc="upper left",
        bbox_to_anchor=(0.0, -0.2),
        fontsize=7.5,
        handlelength=3.0,
        borderaxespad=0.0,
    )
