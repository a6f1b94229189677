"""Figure 1: forces over the first periods of a transverse oscillation."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from microslip.config.quantities import AMPLITUDE, FORCE_FORWARD, FORCE_LATERAL, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_one_poisson, columns


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the forward force with its mean over the last period, and the lateral force."""
    dataset = at_one_poisson(dataset)
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

    upper.set_ylabel(f"forward force\n{FORCE_FORWARD.math}")
    upper.set_ylim(min(0.0, 1.05 * forward.min()), 1.05)
    upper.yaxis.set_major_locator(MultipleLocator(0.2))
    lower.set(ylabel=f"lateral force\n{FORCE_LATERAL.math}", ylim=(-1.1, 1.1))
    lower.set(xlabel=r"phase in periods  $\omega t/(2\pi)$", xlim=(periods[0], periods[-1]))
    lower.xaxis.set_major_locator(MultipleLocator(max(1, round(np.ptp(periods) / 8))))
    for axes in (upper, lower):
        axes.grid(axis="x", color=look.PALE, lw=0.5)
        axes.set_axisbelow(True)
    symbols = VELOCITY["transverse"].latex, AMPLITUDE["transverse"].latex
    values = (float(dataset[f"history_{n}"]) for n in ("velocity", "amplitude"))
    panels.legend_above(upper, look.conditions(zip(symbols, values, strict=True)))
    panels.heading(lower)
    return figure
