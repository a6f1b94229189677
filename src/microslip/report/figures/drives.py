"""Drives of a contact: friction over velocity under each drive, and a mass on a spring."""

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

NEEDED = {
    "transverse": ("velocity", "amplitude", "mu_macro"),
    "drive_force": ("velocity", "velocity_error", "force", "converged"),
    "drive_spring": ("velocity", "stiffness", "mu_macro", "mu_macro_error", "converged"),
    "drive_body": ("mass", "stiffness", "mu_macro", "mu_macro_error", "converged"),
}
SPRINGS = ((look.BLUE, "s"), (look.GREEN, "^"), (look.ORANGE, "D"))
"""Colour and marker of the points of each stiffness, from the softest on."""
GOOD = 0.01
"""A share of the friction at a constant velocity within which that is a good model."""


def draw(name: str, *datasets: xr.Dataset) -> Figure:
    """Draw friction over the mean velocity, and over the mass at one velocity."""
    given = dict(zip(NEEDED, datasets, strict=True))
    for key, dataset in given.items():
        require(name, key, dataset, NEEDED[key])
    figure = look.new_figure(look.DOUBLE, 3.1)
    left, right = figure.subplots(1, 2)
    _over_velocity(left, given)
    _over_mass(right, given)
    return figure


def _over_velocity(axes: Axes, given: dict[str, xr.Dataset]) -> None:
    """All drives at the amplitude of the sweeps."""
    springs = _one(given["drive_spring"])
    amplitude = float(springs["amplitude"])
    moved = _moved(given, amplitude)
    axes.plot(
        *(moved["velocity"], moved["mu_macro"]),
        color=look.BLACK,
        linewidth=1.3,
        label="constant velocity",
        gid="velocity",
    )
    for part, (color, marker) in _by_stiffness(springs):
        label = f"spring, ${DRIVES['stiffness'].latex} = {look.number(float(part['stiffness']))}$"
        mu, error, good = (part[k].values for k in ("mu_macro", "mu_macro_error", "converged"))
        ink: dict[str, Any] = {"color": color, "marker": marker, "markerfacecolor": "white"}
        computed(axes, part["velocity"].values, mu, error, good, label, **ink)
    pulled = _one(given["drive_force"])
    pulled = pulled.isel(force=(pulled["velocity"].values > 0.0))
    errors = np.zeros(pulled["force"].size)
    place, force, good = (pulled[k].values for k in ("velocity", "force", "converged"))
    computed(axes, place, force, errors, good, "constant force", color=look.VERMILLION)
    velocity = moved["velocity"].values
    axes.set_xscale("log")
    axes.set(xlim=(velocity[velocity > 0.0][0], velocity[-1]))
    ticks.logarithmic(axes.xaxis)
    axes.set_xlabel(look.axis(VELOCITY["transverse"]))
    look.unit_range(axes)
    axes.set_ylabel(look.FRICTION.replace("  (", "\n("))
    look.legend_above(axes, "a", f"amplitude {amplitude:g}, sideways")


def _over_mass(axes: Axes, given: dict[str, xr.Dataset]) -> None:
    """A mass on springs at one velocity, and what a constant velocity gives there."""
    bodies = _one(given["drive_body"])
    amplitude, velocity = float(bodies["amplitude"]), float(bodies["velocity"])
    moved = float(_at(_moved(given, amplitude), "velocity", velocity)["mu_macro"])
    axes.axhspan(moved * (1 - GOOD), moved * (1 + GOOD), color=look.PALE, label="within 1 %")
    axes.axhline(moved, color=look.BLACK, linewidth=1.3, label="constant velocity", gid="velocity")
    for part, (color, marker) in _by_stiffness(bodies):
        label = f"${DRIVES['stiffness'].latex} = {look.number(float(part['stiffness']))}$"
        mu, error, good = (part[k].values for k in ("mu_macro", "mu_macro_error", "converged"))
        computed(axes, part["mass"].values, mu, error, good, label, color=color, marker=marker)
    axes.set_xscale("log")
    axes.set(xlim=(bodies["mass"].values[0], bodies["mass"].values[-1]))
    ticks.logarithmic(axes.xaxis)
    axes.set_xlabel(look.axis(DRIVES["mass"]))
    axes.set_ylabel(look.FRICTION.replace("  (", "\n("))
    at = look.conditions([(VELOCITY["transverse"].latex, velocity)])
    look.legend_above(axes, "b", f"a mass on a spring, {at}", ncols=3)


def _one(dataset: xr.Dataset) -> xr.Dataset:
    """At one Poisson's ratio, without the axes that have one entry."""
    return at_one_poisson(dataset)[0].squeeze()


def _by_stiffness(dataset: xr.Dataset) -> list[tuple[xr.Dataset, tuple[str, str]]]:
    parts = [dataset.isel(stiffness=k) for k in range(dataset.sizes["stiffness"])]
    return list(zip(parts, SPRINGS, strict=False))


def _moved(given: dict[str, xr.Dataset], amplitude: float) -> xr.Dataset:
    """The cut of the map of the paper at an amplitude."""
    return _at(at_one_poisson(given["transverse"])[0], "amplitude", amplitude)


def _at(dataset: xr.Dataset, dim: str, value: float) -> xr.Dataset:
    """A dataset at a value that it has, but for rounding; raises ValueError if it has not."""
    same = np.flatnonzero(np.isclose(dataset[dim].values, value, rtol=1e-9, atol=0.0))
    if not same.size:
        raise ValueError(f"the sweep transverse has no {dim} {value:g}, as the drives have")
    return dataset.isel({dim: same[0]})
