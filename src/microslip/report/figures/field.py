"""Tractions in the contact and instantaneous centre of rotation of a steady bore (Figure 3)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from matplotlib.ticker import MultipleLocator
from matplotlib.tri import Triangulation
from scipy.interpolate import griddata

from microslip.config.quantities import FORWARD, LATERAL
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

SPACING = 0.14
"""Distance between the arrows, in contact radii."""
SHADES = LinearSegmentedColormap.from_list("bound", ["#FFFFFF", "#8CC8EE"])
"""Colours that contrast well with black arrows."""


def draw(dataset: xr.Dataset) -> Figure:
    """Draw traction arrows over a colour map of the bound, with a horizontal lateral axis.

    The longest arrow is shorter than the distance between arrows, so that arrows do not touch.
    """
    x, y = columns(dataset, "field_lateral_position", "field_forward_position")
    tractions = columns(dataset, "field_traction_lateral", "field_traction_forward")
    bound, centre = dataset["field_bound"].values, float(dataset["field_centre_lateral"])
    figure = look.new_figure(look.SINGLE, 3.95)
    axes = figure.add_subplot(aspect="equal")
    axes.add_patch(Circle((0, 0), 1.0, fill=False, lw=0.9))
    # The bound is constant between the outermost cells and the rim.
    angle = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
    rim = np.cos(angle), np.sin(angle)
    bounds = np.append(bound, griddata((x, y), bound, rim, method="nearest"))
    mesh = Triangulation(np.append(x, rim[0]), np.append(y, rim[1]))
    shading: look.Ink = {"shading": "gouraud", "cmap": SHADES, "vmin": 0.0, "zorder": 0}
    shade = axes.tripcolor(mesh, bounds, **shading)
    shade.set_clip_path(Circle((0, 0), 1.0, transform=axes.transData))
    label = r"friction bound  $\mu p\,a^2/(\mu F_z)$"
    panels.colour_bar(shade, axes, label, orientation="horizontal", aspect=32)
    arrow: look.Ink = {"width": 0.006, "headwidth": 3.4, "headlength": 3.8, "headaxislength": 3.4}
    arrow |= {"angles": "xy", "scale_units": "xy", "minlength": 0.6, "pivot": "mid"}
    arrows = axes.quiver(
        *lattice(x, y, *tractions, centre=centre),
        scale=bound.max() / (0.8 * SPACING),
        gid="traction",
        **arrow,
    )
    axes.quiverkey(arrows, 0.7, 1.042, 0.4, r"$0.4\,\mu F_z/a^2$", labelpos="E", labelsep=0.06)
    mark: look.Ink = {"mfc": "white", "mec": look.VERMILLION, "mew": 1.6, "zorder": 6}
    mark |= {"gid": "centre", "label": "instantaneous centre"}
    axes.plot([centre], [0.0], "o", ms=6.5, **mark)
    axes.set(xlim=(min(-1.1, centre - 0.15), 1.1), ylim=(-1.1, 1.1))
    axes.set(xlabel=look.axis(LATERAL), ylabel=look.axis(FORWARD))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MultipleLocator(0.5))
    text = look.conditions([(look.symbol(dataset, "velocity"), float(dataset["field_velocity"]))])
    axes.text(0.035, 0.97, text, transform=axes.transAxes, va="top")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), handlelength=1.0, borderaxespad=0.1)
    return figure


def lattice(
    x: np.ndarray, y: np.ndarray, *fields: np.ndarray, centre: float
) -> tuple[np.ndarray, ...]:
    """Interpolate fields linearly from the cells onto a square lattice.

    Arrows at the cells would overlap in the middle and at the rim. Nodes close to the rim and to
    the centre of rotation are omitted. Returns lateral and forward positions, then the fields.
    """
    count = round(1.0 / SPACING)
    line = SPACING * np.arange(-count, count + 1)
    nodes = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    values = griddata(np.column_stack((x, y)), np.column_stack(fields), nodes)
    visible = np.isfinite(values).all(axis=1)
    visible &= np.hypot(*nodes.T) < 1.0 - 0.4 * SPACING
    visible &= np.hypot(nodes[:, 0] - centre, nodes[:, 1]) > SPACING / 2.0
    return (*nodes[visible].T, *values[visible].T)
