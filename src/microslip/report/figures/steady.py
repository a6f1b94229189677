"""Figures 4 and 5: steady bore at different forward velocities, and transients."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from microslip.config.quantities import FORCE_FORWARD, TORQUE, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_one_poisson, columns, curve, limit

QUANTITIES = (
    ("force", "Eq 21", "forward", "mu_macro", "transient_force_forward", look.BLUE, look.SOLID),
    ("torque", "Eq 22", "torque", "mu_torque", "transient_torque", look.VERMILLION, look.DASHED),
)
"""For each quantity: name; equation; names of the closed form, the steady value and the history;
colour; line style."""
MARKERS = "os"
LABEL = f"force  {FORCE_FORWARD.math}\ntorque  {TORQUE.math}"
STARTS = {
    "stress-free": "full stick, no stress",
    "full-rotation": "full rotational slip",
    "full-slip": "full forward slip",
}
"""Labels of the initial states in the paper. Other states are labelled with their names."""


def curves(name: str, dataset: xr.Dataset) -> Figure:
    """Draw Eqs 21 and 22, and the computed steady values."""
    dataset = at_one_poisson(dataset)
    velocity = dataset["velocity"].values
    figure = look.new_figure(look.SINGLE, 2.7)
    axes = figure.add_subplot()
    for (what, equation, theory, value, _, color, ls), marker in zip(
        QUANTITIES, MARKERS, strict=True
    ):
        form = f"mu_{theory}_theory"
        line = curve(limit(dataset, form))
        axes.plot(*line, color=color, ls=ls, label=f"{what}, {equation}", gid=form)
        points = columns(dataset, "velocity", value, f"{value}_error", "converged")
        panels.computed(axes, *points, label=f"{what}, computed", color=color, marker=marker)
    axes.set_xlim(velocity[0], velocity[-1])
    if velocity[0] > 0 and velocity[-1] >= 20 * velocity[0]:
        panels.logarithmic(axes)
    axes.set(xlabel=look.axis(VELOCITY["continuous-bore"]), ylabel=LABEL)
    panels.unit_range(axes)
    panels.legend_of_figure(figure, axes.get_legend_handles_labels()[0], ncols=2)
    return figure


def transients(name: str, dataset: xr.Dataset) -> Figure:
    """Draw force and torque against the forward travel, with a panel for each initial state."""
    dataset = at_one_poisson(dataset)
    starts = [str(label) for label in dataset["start"].values]
    figure = look.new_figure(look.DOUBLE, 2.45)
    grid = figure.subplots(1, len(starts), sharex=True, sharey=True, squeeze=False)[0]
    for index, start in enumerate(starts):
        axes, at = grid[index], dataset.isel(start=index)
        for (what, equation, _, _, history, color, _), marker in zip(
            QUANTITIES, MARKERS, strict=True
        ):
            travel, values = columns(at, "transient_displacement", history)
            finite = np.isfinite(travel) & np.isfinite(values)  # shorter runs end in NaN
            marks: look.Ink = {"marker": marker, "ms": 3.4, "markevery": (0.06, 0.12)}
            marks |= {"gid": history}
            label, theory = f"{what}, computed", f"transient_{what}_theory"
            axes.plot(travel[finite], values[finite], color=color, label=label, **marks)
            ink: look.Ink = {"color": color, "ls": look.DASHED, "lw": 1.0, "zorder": 1.5}
            ink |= {"gid": theory}
            axes.axhline(float(at[theory]), label=f"{what}, {equation}", **ink)
        panels.heading(axes, STARTS.get(start, look.literal(start)))
    grid[0].set(ylabel=LABEL, xlim=(0.0, float(dataset["transient_displacement"].max())))
    grid[len(starts) // 2].set_xlabel(r"forward travel  $v_0 t/u_\mathrm{lim}$")
    panels.unit_range(grid[0])
    panels.legend_of_figure(figure, grid[0].get_legend_handles_labels()[0])
    where = VELOCITY["continuous-bore"].latex, float(dataset["transient_velocity"])
    grid[-1].text(0.97, 0.05, look.conditions([where]), transform=grid[-1].transAxes, ha="right")
    return figure
