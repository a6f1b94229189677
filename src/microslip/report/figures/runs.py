"""Single runs: forces over the first periods, and transients (Figures 1 and 5)."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from microslip.config.quantities import FORCE_FORWARD, FORCE_LATERAL
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.curves import FORCE_AND_TORQUE
from microslip.report.figures.data import columns

MARGIN = 0.12
"""Space above and below a force, divided by its range."""
STARTS = {
    "stress-free": "full stick, no stress",
    "full-rotation": "full rotational slip",
    "full-slip": "full forward slip",
}
"""Labels of the initial states in the paper. Other states are labelled with their names."""
QUANTITIES = (
    ("force", "Eq 21", "transient_force_forward", look.BLUE),
    ("torque", "Eq 22", "transient_torque", look.VERMILLION),
)
"""For each quantity of a transient: name, equation of the steady value, variable, colour."""


def history(dataset: xr.Dataset) -> Figure:
    """Draw the forward force with its mean over the last period, and the lateral force."""
    periods = dataset["history_phase"].values / (2.0 * np.pi)
    forward, lateral = columns(dataset, "history_force_forward", "history_force_lateral")
    figure = look.new_figure(look.SINGLE, 3.2)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(1.7, 1.0))
    upper.plot(periods, forward, color=look.BLUE, gid="forward")
    last = periods >= periods[-1] - 1.0 - 1e-9
    mean = np.trapezoid(forward[last], periods[last]) / np.ptp(periods[last])
    label = rf"mean of last period ${mean:.3f}$"
    upper.axhline(mean, color=look.VERMILLION, ls=look.DASHED, label=label, gid="mean")
    lower.plot(periods, lateral, color=look.GREY, lw=1.0, gid="lateral")
    low, high = min(0.0, forward.min()), forward.max()
    upper.set_ylim(low - (MARGIN * (high - low) if low < 0 else 0.0), high + MARGIN * (high - low))
    upper.set_ylabel(f"forward force\n{FORCE_FORWARD.math}")
    lower.set(ylabel=f"lateral force\n{FORCE_LATERAL.math}")
    lower.set(xlabel=r"phase in periods  $\omega t/(2\pi)$", xlim=(periods[0], periods[-1]))
    lower.margins(y=MARGIN)
    lower.xaxis.set_major_locator(MultipleLocator(max(1, round(np.ptp(periods) / 8))))
    for axes in (upper, lower):
        axes.grid(axis="x", color=look.PALE, lw=0.5)
        axes.set_axisbelow(True)
    names = "velocity", "amplitude"
    symbols = [look.symbol(dataset, name) for name in names]
    values = [float(dataset[f"history_{name}"]) for name in names]
    panels.legend_above(upper, look.conditions(zip(symbols, values, strict=True)))
    panels.heading(lower)
    return figure


def transients(dataset: xr.Dataset) -> Figure:
    """Draw force and torque against the forward travel, with a panel for each initial state."""
    starts = [str(label) for label in dataset["start"].values]
    figure = look.new_figure(look.DOUBLE, 2.45)
    grid = figure.subplots(1, len(starts), sharex=True, sharey=True, squeeze=False)[0]
    for index, (axes, start) in enumerate(zip(grid, starts, strict=True)):
        at = dataset.isel(start=index)
        for (what, equation, name, color), ls in zip(
            QUANTITIES, (look.SOLID, look.DASHDOT), strict=True
        ):
            travel, values = columns(at, "transient_displacement", name)
            finite = np.isfinite(travel) & np.isfinite(values)  # shorter runs end in NaN
            ink: look.Ink = {"color": color, "ls": ls, "gid": name}
            axes.plot(travel[finite], values[finite], label=f"{what}, computed", **ink)
            ink = {"color": color, "ls": look.DOTTED, "lw": 1.0, "zorder": 1.5}
            steady = float(at[f"transient_{what}_theory"])
            axes.axhline(steady, label=f"{what}, {equation}", gid=f"{what}_theory", **ink)
        panels.heading(axes, STARTS.get(start, look.literal(start)))
    grid[0].set(ylabel=FORCE_AND_TORQUE)
    grid[0].set_xlim(0.0, float(dataset["transient_displacement"].max()))
    grid[len(starts) // 2].set_xlabel(r"forward travel  $v_0 t/u_\mathrm{lim}$")
    panels.unit_range(grid[0])
    panels.legend_of_figure(figure, grid[0].get_legend_handles_labels()[0])
    text = look.conditions(
        [(look.symbol(dataset, "velocity"), float(dataset["transient_velocity"]))]
    )
    grid[-1].text(0.97, 0.05, text, transform=grid[-1].transAxes, ha="right")
    return figure
