"""Draw single runs: forces over the first periods (Figure 1), the tractions and the instantaneous
centre of rotation of a steady bore (Figure 3), and transients (Figure 5)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from scipy.interpolate import griddata

from microslip.config.quantities import FORCE_FORWARD, FORCE_LATERAL, FORWARD
from microslip.report.figures import style as look
from microslip.report.figures.curves import FORCE_AND_TORQUE
from microslip.report.selection import columns

MARGIN = 0.12
"""Space above and below the curve of a force, divided by the range of the force."""
STARTS = {
    "stress-free": "full stick, no stress",
    "full-rotation": "full rotational slip",
    "full-slip": "full forward slip",
}
"""Labels of the initial states used in the paper. Any other state is labelled with its name."""
QUANTITIES = (
    ("force", "Eq 21", "transient_force_forward", look.BLUE, look.SOLID),
    ("torque", "Eq 22", "transient_torque", look.VERMILLION, look.DASHDOT),
)
"""For each quantity of a transient: name of the quantity, equation for the steady value, name of
the variable, colour and line style."""
SPACING = 0.14
"""Distance between the arrows, in contact radii."""
SHADES = LinearSegmentedColormap.from_list("bound", ["#FFFFFF", "#8CC8EE"])
"""Colour map of the friction bound, which contrasts well with black arrows."""


def _conditions(dataset: xr.Dataset, run: str, *names: str) -> str:
    """Format the conditions of a run. `run` is the first word in the names of the run's
    variables."""
    values = {name: float(dataset[f"{run}_{name}"]) for name in (*names, "poisson")}
    values["poisson"] = values["poisson"] or np.nan  # 0 is not shown
    return look.conditions(dataset.attrs.get("motion", ""), values)


def history(dataset: xr.Dataset) -> Figure:
    """Draw the forward force, the mean of this force over the last period, and the lateral
    force."""
    periods = dataset["history_phase"].values / (2.0 * np.pi)
    forward, lateral = columns(dataset, "history_force_forward", "history_force_lateral")
    figure = look.new_figure(look.SINGLE, 3.2)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1.0))
    upper.plot(periods, forward, color=look.BLUE, gid="forward")
    lower.plot(periods, lateral, color=look.GREY, lw=1.0, gid="lateral")
    last = periods >= periods[-1] - 1.0 - 1e-9
    mean = np.trapezoid(forward[last], periods[last]) / np.ptp(periods[last])
    label = rf"mean of last period ${mean:.3f}$"
    upper.axhline(mean, color=look.VERMILLION, ls=look.DASHED, label=label, gid="mean")
    for axes in (upper, lower):
        axes.margins(x=0.0, y=MARGIN)
        axes.grid(axis="x", color=look.PALE, lw=0.5)
    upper.set_ylim(bottom=min(0.0, upper.get_ylim()[0]))
    upper.set_ylabel(f"forward force\n{FORCE_FORWARD.math}")
    lower.set_ylabel(f"lateral force\n{FORCE_LATERAL.math}")
    lower.set_xlabel(r"phase in periods  $\omega t/(2\pi)$")
    lower.locator_params(axis="x", integer=True)
    look.legend_above(upper, _conditions(dataset, "history", "velocity", "amplitude"))
    look.heading(lower)
    return figure


def transients(dataset: xr.Dataset) -> Figure:
    """Draw force and torque against the forward travel, with a panel for each initial state."""
    starts = [str(label) for label in dataset["start"].values]
    figure = look.new_figure(look.DOUBLE, 2.45)
    grid = look.grid(figure, len(starts), len(starts), sharex=True, sharey=True)
    for index, (axes, start) in enumerate(zip(grid, starts, strict=True)):
        at = dataset.isel(start=index)
        for what, equation, name, color, ls in QUANTITIES:
            # The values of shorter runs end in NaN, which is not drawn.
            line = columns(at, "transient_displacement", name)
            axes.plot(*line, color=color, ls=ls, label=f"{what}, computed", gid=name)
            ink: look.Ink = {"color": color, "ls": look.DOTTED, "lw": 1.0, "zorder": 1.5}
            ink |= {"label": f"{what}, {equation}", "gid": f"{what}_theory"}
            axes.axhline(float(at[f"transient_{what}_theory"]), **ink)
        name = STARTS.get(start, look.literal(start))
        look.heading(axes, f"{name}, {_conditions(dataset, 'transient', 'velocity')}", 2.0)
    longest = float(dataset["transient_displacement"].max())
    grid[0].set(ylabel=FORCE_AND_TORQUE, xlim=(0.0, longest))
    grid[len(starts) // 2].set_xlabel(r"forward travel  $v_0 t/u_\mathrm{lim}$")
    look.unit_range(grid[0])
    look.legend_of_figure(figure, grid[0].get_legend_handles_labels()[0], "upper center", 4)
    return figure


def field(dataset: xr.Dataset) -> Figure:
    """Draw arrows for the tractions over a colour map of the bound. The lateral axis is horizontal.

    The longest arrow is shorter than the distance between arrows, so that arrows do not touch.
    """
    x, y = columns(dataset, "field_lateral_position", "field_forward_position")
    tractions = columns(dataset, "field_traction_lateral", "field_traction_forward")
    bound, centre = dataset["field_bound"].values, float(dataset["field_centre_lateral"])
    figure = look.new_figure(look.SINGLE, 3.95)
    axes = figure.add_subplot()
    shade = look.disc(axes, x, y, bound, "linear", cmap=SHADES)
    label = r"friction bound  $\mu p\,a^2/(\mu F_z)$"
    look.colour_bar(shade, axes, label, orientation="horizontal", aspect=32)
    arrow: look.Ink = {"width": 0.006, "headwidth": 3.4, "headlength": 3.8, "headaxislength": 3.4}
    arrow |= {"angles": "xy", "scale_units": "xy", "minlength": 0.6, "pivot": "mid"}
    arrow |= {"scale": bound.max() / (0.8 * SPACING), "gid": "traction"}
    arrows = axes.quiver(*_lattice(x, y, *tractions, centre=centre), **arrow)
    axes.quiverkey(arrows, 0.7, 1.042, 0.4, r"$0.4\,\mu F_z/a^2$", labelpos="E", labelsep=0.06)
    mark: look.Ink = {"mfc": "white", "mec": look.VERMILLION, "mew": 1.6, "zorder": 6}
    mark |= {"gid": "centre", "label": "instantaneous centre"}
    axes.plot([centre], [0.0], "o", ms=6.5, **mark)
    axes.set(xlim=(min(-1.1, centre - 0.15), 1.1), ylim=(-1.1, 1.1), ylabel=look.axis(FORWARD))
    axes.set(xticks=np.linspace(-1.0, 1.0, 5), yticks=np.linspace(-1.0, 1.0, 5))
    text = _conditions(dataset, "field", "velocity")
    axes.text(0.035, 0.97, text, transform=axes.transAxes, va="top")
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), handlelength=1.0, borderaxespad=0.1)
    return figure


def _lattice(
    x: np.ndarray, y: np.ndarray, *fields: np.ndarray, centre: float
) -> tuple[np.ndarray, ...]:
    """Interpolate fields linearly from the cells onto a square lattice.

    Arrows at the cells would overlap in the middle and at the rim. Nodes close to the rim or to the
    centre of rotation are omitted. Returns the lateral and forward positions, followed by the
    fields.
    """
    line = SPACING * np.arange(-round(1.0 / SPACING), round(1.0 / SPACING) + 1)
    nodes = np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    values = griddata(np.column_stack((x, y)), np.column_stack(fields), nodes)
    visible = np.isfinite(values).all(axis=1)
    visible &= np.hypot(*nodes.T) < 1.0 - 0.4 * SPACING
    visible &= np.hypot(nodes[:, 0] - centre, nodes[:, 1]) > SPACING / 2.0
    return (*nodes[visible].T, *values[visible].T)
