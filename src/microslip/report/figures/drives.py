"""Figures of drives: friction against velocity for each drive, and a mass on a spring."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import DRIVES, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_one_poisson, columns

SPRINGS = ((look.BLUE, "s"), (look.GREEN, "^"), (look.ORANGE, "D"))
"""Colours and markers of the points, by ascending stiffness."""
GOOD = 0.01
"""Relative deviation below which a constant velocity is a good model of a drive."""
AS_A_VELOCITY = 1e5
"""Smallest dimensionless stiffness that is labelled as a constant velocity."""
MARGIN = 1.1
"""Factor by which the velocity axis extends beyond the first and the last velocity."""
MU = ("mu_macro", "mu_macro_error", "converged")


def drives(
    name: str, transverse: xr.Dataset, force: xr.Dataset, spring: xr.Dataset, body: xr.Dataset
) -> Figure:
    """Draw friction against the mean velocity, and against the mass at one velocity."""
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2)
    _over_velocity(left, transverse, force, spring)
    _over_mass(right, transverse, body)
    return figure


def _over_velocity(
    axes: Axes, transverse: xr.Dataset, force: xr.Dataset, spring: xr.Dataset
) -> None:
    """Draw friction against the mean velocity for all drives."""
    springs = _one(spring)
    amplitude = float(springs["amplitude"])
    velocity, mu = columns(_constant_velocity(transverse, amplitude), "velocity", "mu_macro")
    ink: look.Ink = {"color": look.BLACK, "lw": 1.3, "gid": "velocity"}
    axes.plot(velocity, mu, label="constant velocity", **ink)
    _springs(axes, springs, "velocity", mfc="white")
    _force(axes, _one(force))
    panels.logarithmic(axes, (velocity[velocity > 0.0][0], velocity[-1]))
    axes.set(xlabel=look.axis(VELOCITY["transverse"]), ylabel=look.FRICTION_IN_TWO_LINES)
    panels.unit_range(axes)
    panels.legend_above(axes, f"amplitude {amplitude:g}, lateral oscillation")


def _over_mass(axes: Axes, transverse: xr.Dataset, body: xr.Dataset) -> None:
    """Draw friction as a function of the mass on a spring, and friction at a constant velocity."""
    bodies = _one(body)
    amplitude, velocity = float(bodies["amplitude"]), float(bodies["velocity"])
    at = _constant_velocity(transverse, amplitude).sel(velocity=velocity, method="nearest")
    mu = float(at["mu_macro"])
    axes.axhspan(mu * (1 - GOOD), mu * (1 + GOOD), color=look.PALE, label="within 1 %")
    axes.axhline(mu, color=look.BLACK, lw=1.3, label="constant velocity", gid="velocity")
    _springs(axes, bodies, "mass", name="")
    mass = bodies["mass"].values
    panels.logarithmic(axes, mass[[0, -1]])
    axes.set(xlabel=look.axis(DRIVES["mass"]), ylabel=look.FRICTION_IN_TWO_LINES)
    at = look.conditions([(VELOCITY["transverse"].latex, velocity)])
    panels.legend_above(axes, f"a mass on a spring, {at}", ncols=3)


def _springs(axes: Axes, dataset: xr.Dataset, dim: str, name: str = "spring, ", **ink: Any) -> None:
    """Draw friction at every stiffness. Very stiff springs are labelled as a constant velocity."""
    for k, (color, marker) in zip(range(dataset.sizes["stiffness"]), SPRINGS, strict=False):
        part = dataset.isel(stiffness=k)
        stiffness = float(part["stiffness"])
        label = f"{name}${DRIVES['stiffness'].latex} = {look.number(stiffness)}$"
        style: look.Ink = {"color": color, "marker": marker, **ink}
        if stiffness >= AS_A_VELOCITY:
            label, style = "constant velocity", {}
        panels.computed(axes, *columns(part, dim, *MU), label=label, **style)


def _force(axes: Axes, dataset: xr.Dataset) -> None:
    """Draw constant force against mean velocity, for contacts that move."""
    moving = dataset.isel(force=(dataset["velocity"].values > 0.0))
    velocity, force, converged = columns(moving, "velocity", "force", "converged")
    label, exact = "constant force", np.zeros(force.size)
    panels.computed(axes, velocity, force, exact, converged, label=label, color=look.VERMILLION)


def _one(dataset: xr.Dataset) -> xr.Dataset:
    """Select one Poisson's ratio and drop axes with one entry."""
    return at_one_poisson(dataset).squeeze()


def _constant_velocity(transverse: xr.Dataset, amplitude: float) -> xr.Dataset:
    """Select an amplitude of the sweep `transverse`, up to rounding."""
    return at_one_poisson(transverse).sel(amplitude=amplitude, method="nearest")
