"""One panel with a map: bands, contours, and hatched cells where a point is not converged."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from microslip.report.figures import contour_labels, signed, ticks
from microslip.report.figures import style as look
from microslip.report.figures.surface import refined, supported

FILL_LEVELS = np.linspace(0.0, 1.0, 21)
LINE_LEVELS = np.linspace(0.1, 0.9, 9)
FEW = len(LINE_LEVELS)
"""Points along an axis below which they are drawn: more than one contour may pass between two."""


def fill(
    axes: Axes,
    dataset: xr.Dataset,
    fills: np.ndarray = FILL_LEVELS,
    lines: np.ndarray = LINE_LEVELS,
    labelled: np.ndarray = LINE_LEVELS,
    size: float = 7.5,
) -> tuple[ContourSet, int]:
    """Fill a panel with `mu_macro` over velocity and amplitude, as `microslip.at` interpolates it.

    Contours end where the points do not support them. Then the points are drawn, and where they are
    few.

    fills, lines, labelled: levels of bands, of contours (dashed below 0, and heavier at 0 where
    there are such) and of those that have a number, ascending; size: of the numbers. Returns the
    bands, for a colour bar, and the number of hatched cells.
    """
    shown = dataset.isel(velocity=dataset["velocity"].values > 0)
    if min(shown.sizes["amplitude"], shown.sizes["velocity"]) < 2:
        raise ValueError("a map needs two amplitudes and two positive velocities at least")
    shown = shown.transpose("amplitude", "velocity", ...)
    velocity, amplitude = shown["velocity"].values, shown["amplitude"].values
    points = velocity, amplitude, shown["mu_macro"].values
    x, y, values = refined(*points)

    colours, norm = signed.scale(fills)
    filled = axes.contourf(
        x,
        y,
        np.clip(values, fills[0], fills[-1]),  # rounding beyond the ends must leave no white holes
        levels=fills,
        cmap=colours,
        norm=norm,
    )
    filled.set_edgecolor("face")  # no hairlines between the bands in a PDF
    filled.set_linewidth(0.3)
    known = supported((x, y, values), points, lines)
    contours = axes.contour(
        *known,
        levels=lines,
        colors=signed.inks(lines, fills),
        linestyles=["dashed" if level < 0 else "solid" for level in lines],
        linewidths=[1.1 if level == 0 else 0.7 for level in lines],
    )
    contours.set_gid("contours")
    axes.set_xscale("log")
    axes.set(xlim=(velocity[0], velocity[-1]), ylim=(amplitude[0], amplitude[-1]))
    ticks.logarithmic(axes.xaxis)
    if min(shown.sizes[dim] for dim in ("velocity", "amplitude")) < FEW or np.ma.count(
        known[2]
    ) < np.ma.count(values):
        axes.plot(*(part.ravel() for part in np.meshgrid(velocity, amplitude)), **POINTS)
    axes.tick_params(which="both", direction="out", top=False, right=False)
    look.after_layout(axes.figure, lambda: contour_labels.label(axes, contours, labelled, size))
    return filled, _hatch(axes, velocity, amplitude, shown["converged"].values != 0)


_HATCHED: dict[str, Any] = {
    "facecolor": (1.0, 1.0, 1.0, 0.45),
    "edgecolor": look.BLACK,
    "linewidth": 0.0,
    "hatch": "//////",
}


POINTS: dict[str, Any] = {
    "linestyle": "none",
    "marker": "o",
    "markersize": 3.0,
    "color": look.BLACK,
}
POINTS |= {"markeredgecolor": "white", "markeredgewidth": 0.4, "clip_on": False, "gid": "points"}


def shows_points(axes: Axes) -> bool:
    """Whether `fill` has drawn the points of the map in a panel."""
    return any(line.get_gid() == POINTS["gid"] for line in axes.get_lines())


def computed_points() -> Line2D:
    """Legend entry of the points of a map."""
    return Line2D([], [], label="computed points", **POINTS)


def unconverged(label: str) -> Patch:
    """Legend entry of hatched cells."""
    return Patch(label=label, **_HATCHED)


def _hatch(axes: Axes, velocity: np.ndarray, amplitude: np.ndarray, done: np.ndarray) -> int:
    """Hatch the cell around every point that is not converged, and count them."""
    x = np.exp(_cell_edges(np.log(velocity)))
    y = _cell_edges(amplitude)
    cells = [
        [(x[j], y[i]), (x[j + 1], y[i]), (x[j + 1], y[i + 1]), (x[j], y[i + 1])]
        for i, j in np.argwhere(~done)
    ]
    if cells:
        hatched = PolyCollection(cells, gid="unconverged", zorder=4, **_HATCHED)
        axes.add_collection(hatched, autolim=False)
    return len(cells)


def _cell_edges(points: np.ndarray) -> np.ndarray:
    """Edges half-way between the points; the outer ones at the outermost points."""
    return np.concatenate(([points[0]], (points[1:] + points[:-1]) / 2, [points[-1]]))
