"""Lines of several sweeps on one panel: static friction against amplitude, or friction of a steady
motion against velocity."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.data import finite_or_nan, limit
from microslip.report.figures.formulas import mathtext

LOOKS = (
    (look.BLACK, "o", look.SOLID),
    (look.BLUE, "s", look.DASHED),
    (look.VERMILLION, "^", look.DASHDOT),
    (look.GREEN, "D", look.DOTTED),
    (look.ORANGE, "v", look.SOLID),
    (look.PURPLE, "P", look.DASHED),
    (look.SKY, "X", look.DASHDOT),
    (look.GREY, "*", look.DOTTED),
)
"""Colour, marker and line style of each sweep; any one of the three tells them apart, or nearly."""
THEORY = {"amplitude": ("mu_static",), "velocity": ("mu_forward_theory", "mu_closed_form")}
"""Limits from theory at Poisson's ratio 0 that stand for the line, along each axis."""
JOINING = 0.5
"""Width of lines that do no more than join marks."""
WIDTH, HEIGHT = 5.2, 3.3


def draw(name: str, datasets: Sequence[xr.Dataset], titles: Sequence[str]) -> Figure:
    """Draw every dataset with a colour, a marker and a line style of its own.

    titles: of the datasets, which may hold mathtext.
    """
    if len(datasets) > len(LOOKS):
        raise ValueError(f"figure {name}: {len(datasets)} sweeps; allowed: up to {len(LOOKS)}")
    (dim,) = {_abscissa(dataset) for dataset in datasets} or {""}
    figure = look.new_figure(WIDTH, HEIGHT)
    axes = figure.subplots()
    velocities, low, handles = set(), 0.0, []
    for dataset, (color, marker, linestyle) in zip(datasets, LOOKS, strict=False):
        limited = _line(axes, dataset, dim, color=color, linestyle=linestyle)
        style: dict[str, Any] = {"linestyle": linestyle} if limited else {"linewidth": JOINING}
        handles.append(Line2D([], [], color=color, marker=marker, markersize=4.0, **style))
        points = marched(dataset, dim)
        if points is not None:
            _marks(axes, points, dim, color, marker)
            velocities.update(np.atleast_1d(points["velocity"].values).tolist())
        low = min(low, float(dataset["mu_macro"].min()))
    look.unit_range(axes, low=np.floor(5 * low) / 5 if low < -0.01 else 0.0)
    axes.set_ylabel(look.FRICTION)
    axes.set_xlabel(_axis_label(dim, (d[dim].attrs.get("formula", "") for d in datasets)))
    if dim == "velocity":
        axes.set_xscale("log")
        ticks.logarithmic(axes.xaxis)
    axes.margins(x=0.02)
    # A legend leaves out what begins with an underscore.
    shown = [look.wrapped(title, 1.35, 8.0) for title in titles]
    shown = [rf"$\_${text[1:]}" if text.startswith("_") else text for text in shown]
    figure.legend(handles, shown, loc="outside right upper", handlelength=3.0)
    if dim == "amplitude" and velocities:
        at = [look.number(velocity) for velocity in sorted(velocities)]
        marks = rf"marks: velocity ${at[0]}$" + (rf" to ${at[-1]}$" if len(at) > 1 else "")
        axes.set_title(f"lines: limit for velocity to 0; {marks}", loc="left", fontsize=8.0)
    return figure


def marched(dataset: xr.Dataset, dim: str) -> xr.Dataset | None:
    """The points above velocity 0; of several velocities, along the amplitude, the smallest one."""
    points = dataset.isel(velocity=dataset["velocity"].values > 0)
    if not points.sizes["velocity"]:
        return None
    return points.isel(velocity=0) if dim == "amplitude" else points.squeeze()


def _abscissa(dataset: xr.Dataset) -> str:
    return "amplitude" if dataset.sizes.get("amplitude", 0) > 1 else "velocity"


def _line(axes: Axes, dataset: xr.Dataset, dim: str, **style: Any) -> bool:
    """The limit for vanishing velocity, or a closed form, and whether the dataset has one."""
    known = [variable for variable in THEORY[dim] if variable in dataset]
    if known and float(dataset["poisson"]) == 0.0:
        line = limit(dataset, known[0])
        if line.ndim == 1:
            axes.plot(line[line.dims[0]], line, gid="limit", **style)
            return True
    if dim == "amplitude" and float(dataset["velocity"][0]) == 0.0:
        still = dataset.isel(velocity=0)
        axes.plot(still[dim], finite_or_nan(still["mu_macro"].values), gid="limit", **style)
        return True
    return False


def _marks(axes: Axes, points: xr.Dataset, dim: str, color: str, marker: str) -> None:
    """Computed points with their errors, joined by a thin line; hollow where not converged."""
    x, y = points[dim].values, finite_or_nan(points["mu_macro"].values)
    axes.plot(x, y, color=color, linewidth=JOINING, alpha=0.6, zorder=1.5)
    done = points["converged"].values != 0
    for part, face in ((done, color), (~done, "white")):
        if not part.any():
            continue
        axes.errorbar(
            x[part],
            y[part],
            yerr=finite_or_nan(points["mu_macro_error"].values)[part],
            fmt=marker,
            color=color,
            markerfacecolor=face,
            markersize=4.0,
            markeredgewidth=0.7,
            elinewidth=0.7,
            capsize=1.8,
            gid="computed" if face == color else "unconverged",
        )


def _axis_label(dim: str, formulas: Iterable[str]) -> str:
    quantity = "forward velocity" if dim == "velocity" else "amplitude"
    texts = list(dict.fromkeys(filter(None, map(mathtext, formulas))))
    if sum(map(len, texts)) > 90 or any(" " in text for text in texts):
        return f"{quantity}, in the units of each motion"
    return f"{quantity}  {', '.join(texts)}"
