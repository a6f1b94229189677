"""Figure 5: how force and torque of the bore reach their steady values from three starts."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import FORCE_FORWARD, TORQUE, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures.data import at_one_poisson, require

VARIABLES = (
    "start",
    "transient_displacement",
    "transient_force_forward",
    "transient_torque",
    "transient_velocity",
    "transient_force_theory",
    "transient_torque_theory",
)

STARTS = {
    "stress-free": "full stick, no stress",
    "full-rotation": "full rotational slip",
    "full-slip": "full forward slip",
}
"""The paper's words for the starts; any other label is shown as it is."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw one panel for each start, force and torque against the way gone forward."""
    require(name, "continuous_bore", dataset, VARIABLES)
    dataset, _ = at_one_poisson(dataset)
    starts = [str(label) for label in dataset["start"].values]
    figure = look.new_figure(look.DOUBLE, 2.45)
    panels = figure.subplots(1, len(starts), sharex=True, sharey=True, squeeze=False)[0]
    letters = look.letters(len(starts))
    for index, (axes, letter, start) in enumerate(zip(panels, letters, starts, strict=True)):
        _panel(axes, dataset, index)
        look.letter(axes, letter, STARTS.get(start, look.literal(start)))
    panels[0].set_ylabel(f"force  {FORCE_FORWARD.math}\ntorque  {TORQUE.math}")
    panels[len(starts) // 2].set_xlabel(r"forward travel  $v_0 t/u_\mathrm{lim}$")
    look.unit_range(panels[0])
    handles, labels = panels[0].get_legend_handles_labels()
    velocity = float(dataset["transient_velocity"])
    figure.legend(
        handles,
        labels,
        loc="outside upper center",
        ncols=4,
        columnspacing=1.6,
    )
    where = look.conditions([(VELOCITY["continuous-bore"].latex, velocity)])
    panels[-1].text(0.97, 0.05, where, transform=panels[-1].transAxes, ha="right")
    return figure


def _panel(axes: Axes, dataset: xr.Dataset, index: int) -> None:
    """Force and torque from one start, with the steady values of theory dashed."""
    travel = dataset["transient_displacement"]
    travel = (travel.isel(start=index) if "start" in travel.dims else travel).values
    for what, variable, color, marker in (
        ("force", "transient_force_forward", look.BLUE, "o"),
        ("torque", "transient_torque", look.VERMILLION, "s"),
    ):
        equation = 21 if what == "force" else 22
        values = dataset[variable].isel(start=index).values
        held = np.isfinite(travel) & np.isfinite(values)  # runs of unequal length are padded
        axes.plot(
            travel[held],
            values[held],
            color=color,
            marker=marker,
            markersize=3.4,
            markevery=(0.06, 0.12),
            label=f"{what}, computed",
            gid=variable,
        )
        theory = f"transient_{what}_theory"
        axes.axhline(
            float(dataset[theory]),
            color=color,
            linestyle=look.DASHED,
            linewidth=1.0,
            zorder=1.5,
            label=f"{what}, Eq {equation}",
            gid=theory,
        )
    axes.set_xlim(0.0, float(np.nanmax(dataset["transient_displacement"].values)))
