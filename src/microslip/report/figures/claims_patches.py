"""Stick zones of the oscillating bore: alternating patches, and their areas over a period."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from scipy.spatial import cKDTree

from microslip.config.quantities import FORWARD, LATERAL, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures.claims_static import BORE_AMPLITUDE
from microslip.report.figures.data import require

VARIABLES = (
    "patch_velocity",
    "patch_amplitude",
    "patch_phase",
    "patch_stick",
    "patch_stick_right",
    "patch_stick_left",
    "patch_lateral",
    "patch_forward",
    "patch_moment_phase",
    "patch_share",
    "patch_edge_lateral",
    "patch_edge_forward",
)
PIXELS = 401
"""Pixels along a side of the picture of a contact; each shows the point next to it."""
MOMENTS = ((0, "before one turning point"), (1, "mid-stroke"), (2, "before the other"))
"""The moments that are shown, and what they are."""
AREAS = (
    ("patch_stick", "all", look.BLACK, look.SOLID),
    ("patch_stick_right", "right half", look.BLUE, look.DASHED),
    ("patch_stick_left", "left half", look.VERMILLION, look.DASHDOT),
)


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the contact at three moments above, the sticking area over a period below."""
    require(name, "claims", dataset, VARIABLES)
    figure = look.new_figure(look.DOUBLE, 5.2)
    grid = figure.add_gridspec(2, len(MOMENTS), height_ratios=(1.0, 0.72))
    panels = [figure.add_subplot(grid[0, i], aspect="equal") for i in range(len(MOMENTS))]
    for axes, which, (moment, note) in zip(panels, "abc", MOMENTS, strict=True):
        shade = _contact(axes, dataset.isel(patch_moment=moment))
        look.letter(axes, which, note)
    panels[0].set_ylabel(look.axis(FORWARD))
    bar = figure.colorbar(shade, ax=panels, shrink=0.8, pad=0.015, aspect=24)
    bar.set_label("traction over bound  $|q|/(\\mu p)$\nwhere it sticks")
    _areas(figure.add_subplot(grid[1, :]), dataset)
    return figure


def _contact(axes: Axes, at: xr.Dataset) -> ScalarMappable:
    """Draw sticking points shaded by the share of the bound in use, and slipping points white."""
    x, y, share = (at[f"patch_{n}"].values for n in ("lateral", "forward", "share"))
    line = np.linspace(-1.0, 1.0, PIXELS)
    pixels = np.stack(np.meshgrid(line, line), axis=-1)
    _, nearest = cKDTree(np.column_stack((x, y))).query(pixels)
    shown = np.where(np.hypot(*np.moveaxis(pixels, -1, 0)) < 1.0, share[nearest], 1.0)
    edge = 1.0 + 0.5 * (line[1] - line[0])
    shade = axes.imshow(
        np.ma.masked_greater_equal(shown, 1.0),
        cmap=look.COLOURMAP,
        vmin=0.0,
        vmax=1.0,
        origin="lower",
        extent=(-edge, edge, -edge, edge),
        interpolation="nearest",
        gid="sticks",
    )
    axes.add_patch(Circle((0, 0), 1.0, facecolor="none", edgecolor=look.BLACK, linewidth=0.9))
    edge = (at[f"patch_edge_{n}"].values for n in ("lateral", "forward"))
    axes.plot(*edge, color=look.VERMILLION, linestyle=look.DASHED, linewidth=1.3, gid="theory")
    phase = float(at["patch_moment_phase"]) / np.pi
    text = rf"{look.number(phase)}\,\pi" if abs(phase) > 1e-9 else "0"
    axes.text(0.5, 0.04, rf"$\Omega t = {text}$", transform=axes.transAxes, ha="center")
    axes.set(xlim=(-1.08, 1.08), ylim=(-1.32, 1.08), xlabel=look.axis(LATERAL))
    axes.set(xticks=(-1, 0, 1), yticks=(-1, 0, 1))
    return shade


def _areas(axes: Axes, dataset: xr.Dataset) -> None:
    """Shares of the contact's area that stick."""
    phase = dataset["patch_phase"].values / np.pi
    for variable, label, color, linestyle in AREAS:
        values = dataset[variable].values
        axes.plot(phase, values, color=color, linestyle=linestyle, label=label, gid=variable)
    for moment in dataset["patch_moment_phase"].values[[index for index, _ in MOMENTS]] / np.pi:
        axes.axvline(moment, color=look.GREY, linewidth=0.7, linestyle=look.DOTTED, zorder=0)
    symbols = BORE_AMPLITUDE.latex, VELOCITY["bore"].latex
    values = (float(dataset[f"patch_{n}"]) for n in ("amplitude", "velocity"))
    place = look.conditions(zip(symbols, values, strict=True))
    look.legend_above(axes, "d", f"area that sticks, {place}", ncols=3)
    axes.set(xlim=(phase[0], phase[-1]), xlabel=r"phase  $\Omega t/\pi$")
    axes.set(ylabel="share of the contact  (dimensionless)")
    look.unit_range(axes)
