"""Two contacts that work against each other on one body, and one: friction over velocity."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import DRIVES, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.cuts import computed
from microslip.report.figures.data import at_one_poisson, require
from microslip.report.figures.drives import SPRINGS
from microslip.theory.drift import antiphase_drift

NEEDED = {
    "one_spring": ("velocity", "stiffness", "mu_macro", "mu_macro_error", "converged"),
    "pair_spring": ("velocity", "stiffness", "mu_macro", "mu_macro_error", "converged"),
    "pair_force": ("velocity", "velocity_error", "force", "converged"),
}
AS_A_VELOCITY = 1e5
"""Stiffness from which on a spring is told as a constant velocity."""

MARGIN = 1.1
"""Free space beside the first and the last velocity, as a factor, so that no mark is cut."""


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw friction over the mean velocity, of one contact and of the pair."""
    given = dict(zip(NEEDED, datasets, strict=True))
    for key, dataset in given.items():
        require(name, key, dataset, NEEDED[key])
    one, pair, pulled = (at_one_poisson(dataset)[0].squeeze() for dataset in given.values())
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    _springs(left, one)
    _springs(right, pair)
    _force(right, pulled)
    velocity = pair["velocity"].values
    for axes in (left, right):
        axes.set_xscale("log")
        axes.set(xlim=(velocity[0] / MARGIN, velocity[-1] * MARGIN))
        ticks.logarithmic(axes.xaxis)
        axes.set_xlabel(look.axis(VELOCITY["transverse"]))
        look.unit_range(axes)
    left.set_ylabel(look.FRICTION.replace("  (", "\n("))
    amplitude = f"amplitude {float(pair['amplitude']):g}, along the motion"
    look.letter(left, "a", f"one contact, {amplitude}")
    look.letter(right, "b", "two in antiphase")
    # the right panel has all that the left one has
    handles, labels = right.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def _springs(axes: Axes, dataset: xr.Dataset) -> None:
    """Friction on every spring; the stiffest may stand for a constant velocity."""
    for k, (color, marker) in zip(range(dataset.sizes["stiffness"]), SPRINGS, strict=False):
        part = dataset.isel(stiffness=k)
        stiffness = float(part["stiffness"])
        label = f"spring, ${DRIVES['stiffness'].latex} = {look.number(stiffness)}$"
        ink: dict[str, Any] = {"color": color, "marker": marker}
        if stiffness >= AS_A_VELOCITY:
            label, ink = "constant velocity", {"color": look.BLACK}
        mu, error, good = (part[k].values for k in ("mu_macro", "mu_macro_error", "converged"))
        computed(axes, part["velocity"].values, mu, error, good, label, **ink)


def _force(axes: Axes, dataset: xr.Dataset) -> None:
    """Points of the pair under forces, and the closed form that they should lie on."""
    pulled = dataset.isel(force=(dataset["velocity"].values > 0.0))
    errors = np.zeros(pulled["force"].size)
    columns = pulled["velocity"].values, pulled["force"].values, errors, pulled["converged"].values
    computed(axes, *columns, "constant force", color=look.VERMILLION)
    forces = np.linspace(0.0, 1.0, 200, endpoint=False)
    velocity = antiphase_drift(forces, float(dataset["amplitude"]))
    axes.plot(
        *(velocity, forces),
        color=look.VERMILLION,
        linewidth=1.0,
        linestyle="--",
        label="its closed form",
        gid="antiphase",
    )
