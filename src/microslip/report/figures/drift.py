"""Maps of the drift velocity of a vibrated contact under a constant force."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from microslip.config.quantities import AMPLITUDE, DRIVES, VELOCITY
from microslip.datasets.catalogue import STATIC
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_one_poisson, columns, curve, limit
from microslip.report.figures.map_panel import bands

DECADES = np.linspace(-3.0, 1.0, 17)
"""Decimal logarithms of the dimensionless velocities at the edges of the bands."""
LINES = (0.01, 0.1, 1.0)
"""Dimensionless velocities of the contours."""
RIGID = "velocity_large_amplitude"
REST: look.Ink = {"facecolor": look.PALE, "edgecolor": "none", "gid": "stays"}
THRESHOLD: look.Ink = {"color": look.BLACK, "lw": 1.3}
RIGID_LINE: look.Ink = {"color": look.VERMILLION, "ls": look.DASHED, "lw": 1.0}
UNCONVERGED: look.Ink = {"color": look.BLACK, "marker": "x", "ls": "none"}


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw velocity against force and amplitude for transverse oscillation and oscillating bore."""
    figure = look.new_figure(look.DOUBLE, 3.3)
    grid = figure.subplots(1, len(datasets))
    any_unconverged = False
    for axes, dataset in zip(grid, datasets, strict=True):
        filled, has_marks = _map(axes, dataset)
        any_unconverged |= has_marks
    velocity_bar(filled, list(grid))
    handles: list[Artist] = [
        Line2D([], [], label="static limit: threshold", **THRESHOLD),
        Patch(label="comes to rest", **REST),
        Line2D([], [], label="rigid contact, at the same velocities", **RIGID_LINE),
    ]
    if any_unconverged:
        handles.append(Line2D([], [], label="not converged", **UNCONVERGED))
    panels.legend_of_figure(figure, handles)
    return figure


def velocity_bands(
    axes: Axes, force: np.ndarray, amplitude: np.ndarray, velocity: np.ndarray
) -> tuple[ContourSet, np.ndarray]:
    """Fill a panel with bands of velocity, shape (amplitudes, forces).

    Returns the bands, and the decimal logarithms of the velocities, limited to the range of the
    bands.
    """
    clipped = np.clip(np.nan_to_num(velocity), *10.0 ** DECADES[[0, -1]])
    shown, settings = np.log10(clipped), {"levels": DECADES, "cmap": look.COLOURMAP}
    return bands(axes, force, amplitude, shown, extend="both", **settings), shown


def velocity_bar(filled: ContourSet, grid: Axes | list[Axes]) -> None:
    """Add the colour bar of the velocity."""
    powers = np.arange(-3.0, 2.0)
    bar = panels.colour_bar(filled, grid, "mean velocity  (dimensionless)", ticks=powers)
    bar.set_ticklabels([f"${look.number(10.0**power)}$" for power in powers])


def _map(axes: Axes, dataset: xr.Dataset) -> tuple[ContourSet, bool]:
    """Draw one map. Returns the bands, and True if the map has unconverged points."""
    motion = dataset.attrs["motion"]
    part = at_one_poisson(dataset).transpose("amplitude", "force", ...)
    poisson = float(part["poisson"])
    force, amplitude, velocity, rigid = columns(part, "force", "amplitude", "velocity", RIGID)
    filled, shown = velocity_bands(axes, force, amplitude, velocity)
    levels = np.log10(LINES)
    # Contours of negative values, here of logarithms, are dashed by default.
    white: look.Ink = {"colors": "white", "linestyles": "solid", "linewidths": 0.9}
    white |= {"gid": "contours"}
    lines = axes.contour(force, amplitude, shown, levels, **white)
    axes.clabel(lines, fmt={at: f"{10.0**at:g}" for at in levels}, fontsize=look.SMALLEST)
    ink: look.Ink = {"colors": look.VERMILLION, "linestyles": [look.DASHED], "linewidths": 1.0}
    axes.contour(force, amplitude, np.log10(rigid), levels, gid=RIGID, **ink)
    across, threshold = curve(limit(part, STATIC))
    axes.fill_betweenx(across, 0.0, threshold, zorder=3, **REST)
    axes.plot(threshold, across, zorder=4, gid=STATIC, **THRESHOLD)
    axes.set(xlim=force[[0, -1]], ylim=amplitude[[0, -1]])
    axes.set(xlabel=look.axis(DRIVES["force"]), ylabel=look.axis(AMPLITUDE[motion]))
    panels.ticks_outside(axes)
    note = "velocity " + look.axis(VELOCITY[motion]).removeprefix(VELOCITY[motion].text).strip()
    panels.heading(axes, note + (rf", $\nu = {look.number(poisson)}$" if poisson else ""))
    bad = np.argwhere(part["converged"].values == 0)
    axes.plot(force[bad[:, 1]], amplitude[bad[:, 0]], gid="unconverged", **UNCONVERGED)
    return filled, bool(len(bad))
