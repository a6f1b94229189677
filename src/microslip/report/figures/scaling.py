"""How iterations, time and memory of a step grow with the number of unknowns."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.data import require

PANELS = (
    ("iterations", "iterations a step  (dimensionless)"),
    ("seconds", "time a step (s)"),
    ("memory", "memory (bytes)"),
)
"""Each panel: the quantity in the names of the variables, and its label."""
VARIABLES = (
    "scaling_model",
    "scaling_unknowns",
    "scaling_label",
    *(f"scaling_{what}" for what, _ in PANELS),
    *(f"scaling_exponent_{what}" for what, _ in PANELS),
)
STYLES = (look.SOLID, look.DASHED, look.DASHDOT, look.DOTTED)


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw one panel a quantity, one curve a model, with the fitted exponent in its label."""
    require(name, "accuracy_cost", dataset, VARIABLES)
    figure = look.new_figure(look.DOUBLE, 3.1)
    panels = figure.subplots(1, len(PANELS), sharex=True)
    for which, axes, (what, label) in zip("abc", panels, PANELS, strict=True):
        _panel(axes, dataset, what)
        axes.set(xlabel="unknowns  $N$  (dimensionless)", ylabel=label)
        look.legend_above(axes, which, "fitted growth", ncols=1)
    return figure


def _panel(axes: Axes, dataset: xr.Dataset, what: str) -> None:
    """Draw one quantity of every model against the unknowns."""
    axes.set(xscale="log", yscale="log")
    names = dataset["scaling_model"].values.astype(str)
    for index, model in enumerate(names):
        of_model = dataset.isel(scaling_model=index)
        x, y = (of_model[f"scaling_{n}"].values.astype(float) for n in ("unknowns", what))
        kept = np.isfinite(x) & np.isfinite(y)
        order = np.argsort(x[kept])
        x, y = x[kept][order], y[kept][order]
        exponent = float(of_model[f"scaling_exponent_{what}"])
        growth = rf"  $N^{{{exponent:.2f}}}$" if np.isfinite(exponent) else ""
        color, marker, _ = look.model(model)
        axes.plot(
            x,
            y,
            color=color,
            marker=marker,
            markersize=4.0,
            linestyle=STYLES[index % len(STYLES)],
            label=f"{model}{growth}",
            gid=what,
        )
        if what == "iterations" and x.size:
            sizes = of_model["scaling_label"].values.astype(str)
            _size(axes, x[-1], y[-1], sizes[kept][order][-1])
    axes.margins(0.06, 0.14)
    for axis in (axes.xaxis, axes.yaxis):
        ticks.logarithmic(axis, 6)


def _size(axes: Axes, x: float, y: float, text: str) -> None:
    """Write at the last point of a curve which resolution it is."""
    ink: dict[str, Any] = {"fontsize": look.SMALLEST, "ha": "right", "va": "bottom", "gid": "size"}
    axes.annotate(text, (x, y), (-2, 3), textcoords="offset points", **ink)
