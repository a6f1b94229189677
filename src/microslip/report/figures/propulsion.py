"""Propulsion: force and efficiency of self-propelled motions, from stall to no load."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure

from microslip.report.figures import style as look
from microslip.report.figures.data import finite_or_nan, require
from microslip.report.figures.lines import LOOKS

VARIABLES: tuple[str, ...] = (
    "velocity",
    "force",
    "force_error",
    "efficiency",
    "efficiency_error",
    "converged",
)
VARIABLES += ("panel", "title")
ROWS = (
    ("force", r"force  $F/(\mu F_z)$"),
    ("efficiency", "efficiency  (dimensionless)"),
)
"""Quantities of the rows, and their labels."""
WIDTH, HEIGHT = 2.36, 5.2
VELOCITY = r"forward velocity  $v_0/(\omega u_\mathrm{lim})$"


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw a column for each panel of the dataset: force above, efficiency below."""
    require(name, "propulsion", dataset, VARIABLES)
    panels = [str(panel) for panel in dict.fromkeys(dataset["panel"].values)]
    figure = look.new_figure(max(WIDTH * len(panels), look.SINGLE), HEIGHT)
    grid = figure.subplots(len(ROWS), len(panels), sharex="col", squeeze=False)
    letters = look.letters(len(ROWS) * len(panels))
    for column, panel in enumerate(panels):
        chosen = dataset.isel(line=np.flatnonzero(dataset["panel"].values == panel))
        if chosen.sizes["line"] > len(LOOKS):
            allowed = f"allowed: up to {len(LOOKS)}"
            raise ValueError(f"figure {name}: {chosen.sizes['line']} lines in {panel}; {allowed}")
        for row, (variable, label) in enumerate(ROWS):
            axes = grid[row, column]
            _lines(axes, chosen, variable)
            note = look.literal(panel) if row == 0 else ""
            look.letter(axes, letters[row * len(panels) + column], note, WIDTH - 0.5)
            if column == 0:
                axes.set_ylabel(label)
        grid[-1, column].set_xlabel(VELOCITY)
        _legend(grid[-1, column])
    return figure


def _lines(axes: Axes, dataset: xr.Dataset, variable: str) -> None:
    """The lines of one panel; hollow marks where not all of a line converged."""
    axes.axhline(0.0, color=look.PALE, linewidth=0.7, zorder=0.5)
    for index, (color, marker, linestyle) in zip(range(dataset.sizes["line"]), LOOKS, strict=False):
        one = dataset.isel(line=index)
        axes.errorbar(
            one["velocity"].values,
            finite_or_nan(one[variable].values),
            yerr=finite_or_nan(one[f"{variable}_error"].values),
            color=color,
            marker=marker,
            markersize=3.2,
            markeredgewidth=0.7,
            markerfacecolor=color if bool(one["converged"]) else "white",
            linestyle=linestyle,
            linewidth=1.0,
            elinewidth=0.7,
            capsize=1.5,
            label=look.literal(one["title"].values),
            gid=variable,
        )


def _legend(axes: Axes) -> None:
    """Below the column, where it hides nothing."""
    handles, labels = axes.get_legend_handles_labels()
    shown = [f"\N{ZERO WIDTH SPACE}{text}" if text.startswith("_") else text for text in labels]
    axes.legend(
        [handle.lines[0] for handle in handles if isinstance(handle, ErrorbarContainer)],
        [look.wrapped(text, WIDTH - 0.9, 7.5) for text in shown],
        loc="upper left",
        bbox_to_anchor=(0.0, -0.2),
        fontsize=7.5,
        handlelength=3.0,
        borderaxespad=0.0,
    )
