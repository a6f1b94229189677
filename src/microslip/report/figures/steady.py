"""Figure 4: forward friction and torque of the steady bore against the forward velocity."""

from __future__ import annotations

from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from microslip.config.quantities import FORCE_FORWARD, TORQUE, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.cuts import computed
from microslip.report.figures.data import curve, limit, require, sweep

CURVES = (
    ("force", "Eq 21", "mu_forward_theory", "mu_macro", look.BLUE, look.SOLID, "o"),
    ("torque", "Eq 22", "mu_torque_theory", "mu_torque", look.VERMILLION, look.DASHED, "s"),
)
"""Each quantity's name, its theory, its values and their error, and its look."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw Eqs 21 and 22 with the computed steady values."""
    needed = [n for _, _, theory, values, *_ in CURVES for n in (theory, values)]
    needed += ["velocity", "converged", "mu_macro_error", "mu_torque_error"]
    require(name, "continuous_bore", dataset, needed)
    dataset, _ = sweep(dataset, ("velocity",))
    velocity = dataset["velocity"].values

    figure = look.new_figure(look.SINGLE, 2.7)
    axes = figure.add_subplot()
    for what, equation, theory, values, color, linestyle, marker in CURVES:
        label = f"{what}, {equation}"
        line: dict[str, Any] = {
            "color": color,
            "linestyle": linestyle,
            "label": label,
            "gid": theory,
        }
        axes.plot(*curve(limit(dataset, theory)), **line)
        columns = (values, f"{values}_error", "converged")
        found, errors, converged = (dataset[name].values for name in columns)
        computed(
            axes,
            velocity,
            found,
            errors,
            converged,
            label=f"{what}, computed",
            color=color,
            marker=marker,
        )
    if velocity[0] > 0 and velocity[-1] >= 20 * velocity[0]:
        axes.set_xscale("log")
        ticks.logarithmic(axes.xaxis)
    axes.set_xlim(velocity[0], velocity[-1])
    axes.set_xlabel(look.axis(VELOCITY["continuous-bore"]))
    axes.set_ylabel(f"force  {FORCE_FORWARD.math}\ntorque  {TORQUE.math}")
    look.unit_range(axes)
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, columnspacing=1.5)
    return figure
