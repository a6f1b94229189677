"""Friction along one axis of sweeps: computed points with error estimates, and closed forms.

The figure has a panel for each abscissa, and a line for each value of the other axes of a sweep. A
sweep over forces is drawn at the mean velocities that the forces cause.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import FORCE_FORWARD, TORQUE
from microslip.datasets.catalogue import FORMS, STATIC, ClosedForm
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.panels import columns, limit, moving, resampled

PLANE = "velocity", "amplitude"
FORCE_AND_TORQUE = f"force  {FORCE_FORWARD.math}\ntorque  {TORQUE.math}"
JOINING = 0.5
"""Width in points of the lines that join markers."""
FINE = 201
"""Number of amplitudes at which a certified map of static friction is drawn."""


class Line(NamedTuple):
    """A line of a panel.

    Attributes
    ----------
    points : xarray.Dataset
        Points along one dimension.
    x, y : str
        Variables of the abscissa and the ordinate.
    title : str
        Text of the legend.
    limit : tuple or None
        Abscissa, ordinate and label of a closed form or of the computed static limit.
    """

    points: xr.Dataset
    x: str
    y: str
    title: str
    limit: tuple[np.ndarray, np.ndarray, str] | None = None


def closed_forms(dataset: xr.Dataset) -> list[ClosedForm]:
    """Return the closed forms that a dataset contains. The closed forms of its motion come
    first."""
    own = FORMS.get(dataset.attrs.get("motion", "").partition(":")[0], {})
    every = {name: form for forms in FORMS.values() for name, form in forms.items()}
    return [form for name, form in (own | every | own).items() if name in dataset]


def closed_form(axes: Axes, parts: Sequence[xr.Dataset], form: ClosedForm, **at: float) -> None:
    """Draw a closed form from its variable in the first dataset. at: coordinates to select."""
    at_0 = not form.any_poisson and any(part["poisson"] > 0 for part in parts)
    label = r"limit at $\nu = 0$" if at_0 and form.name == STATIC else form.label
    (color, ls), line = look.LIMITS[form.name], limit(parts[0], form.name)
    line = line.sel({dim: value for dim, value in at.items() if dim in line.dims})
    axes.plot(line[line.dims[0]], line, color=color, ls=ls, label=label, gid=form.name)


def draw(*datasets: xr.Dataset) -> Figure:
    """Draw one or several sweeps along one axis."""
    shown = [_static_map(one) if "cell_error" in one else one.squeeze() for one in datasets]
    alone = len(shown) == 1
    lines = [line for one in shown for line in _lines(one, not alone)]
    abscissae = list(dict.fromkeys(line.x for line in lines))
    figure = look.new_figure(*((look.SINGLE, 2.7) if alone else (look.DOUBLE, 3.3)))
    grid = panels.grid(figure, len(abscissae), len(abscissae))
    for axes, abscissa in zip(grid, abscissae, strict=True):
        _panel(axes, [line for line in lines if line.x == abscissa], shown)
        if len(grid) > 1:
            panels.legend_above(axes, ncols=1)
    if len(grid) == 1:
        place = ("upper center", 2) if alone else ("right upper", 1)
        handles = grid[0].get_legend_handles_labels()[0]
        panels.legend_of_figure(figure, handles, place[0], ncols=place[1], handlelength=3.0)
    return figure


def _static_map(dataset: xr.Dataset) -> xr.Dataset:
    """Return the values of a certified map of static friction on a fine axis."""
    amplitude, ratios = dataset["amplitude"].values, np.unique(dataset["poisson"].values)
    fine = np.linspace(amplitude.min(), amplitude.max(), FINE)
    return resampled(dataset, velocity=0.0, amplitude=fine, poisson=ratios)


def _lines(dataset: xr.Dataset, titled: bool) -> Iterator[Line]:
    """Yield the lines of a sweep. The abscissa is the longest axis."""
    over_force = "force" in dataset.dims
    variables = ["velocity"] if over_force else ["mu_macro"]
    variables += ["mu_torque"] if "mu_torque" in dataset else []
    sizes = {str(dim): dataset.sizes[dim] for dim in dataset[variables[0]].dims}
    dim = "force" if over_force else max(sizes, key=lambda one: sizes[one])
    title, still = look.literal(dataset.attrs.get("title", "")) if titled else "", None
    if dim in PLANE and "velocity" in sizes:
        if dim == "amplitude" and 0.0 in dataset["velocity"]:
            still = dataset.sel(velocity=0.0)
        dataset = moving(dataset)
        dataset = dataset.squeeze("velocity") if dataset.sizes["velocity"] == 1 else dataset
    others = [str(one) for one in dataset[variables[0]].dims if one != dim]
    for place in product(*(range(dataset.sizes[other]) for other in others)):
        at = dict(zip(others, place, strict=True))
        points = dataset.isel(at)
        texts = [look.conditions([(look.symbol(points, one), float(points[one]))]) for one in at]
        text = ", ".join(filter(None, [title, *texts]))
        if over_force:
            moves = points.isel(force=points["velocity"].values > 0)
            # A contact at rest has no place on a logarithmic axis of velocities.
            if at_rest := points.sizes["force"] - moves.sizes["force"]:
                text = f"{text or 'computed'} ({at_rest} at rest: not drawn)"
            moves = moves.assign(force_error=xr.zeros_like(moves["force"]))
            yield Line(moves, "velocity", "force", text)
            continue
        rest = still.isel(at, missing_dims="ignore") if still else None
        for variable in variables:
            yield Line(points, dim, variable, text, _limit(points, rest, dim, variable))


def _limit(
    points: xr.Dataset, still: xr.Dataset | None, dim: str, variable: str
) -> tuple[np.ndarray, np.ndarray, str] | None:
    """Return a closed form that is exact for these points, else the computed static limit."""
    for form in closed_forms(points):
        exact = form.exact and (form.any_poisson or float(points["poisson"]) == 0.0)
        own = ("torque" in form.name) == ("torque" in variable)
        line = limit(points, form.name)
        on_axis = form.arguments[0] == dim and line.ndim == 1
        if exact and own and on_axis and form.name != "mu_large_amplitude":
            return line[line.dims[0]].values, line.values, form.label
    if still is None:
        return None
    return still[dim].values, still[variable].values, "limit for velocity to 0"


def _panel(axes: Axes, lines: Sequence[Line], shown: Sequence[xr.Dataset]) -> None:
    """Draw all lines with the same abscissa, and label the axes."""
    alone = len(shown) == 1
    both = alone and any(line.y == "mu_torque" for line in lines)
    notes = set()
    for k, line in enumerate(lines):
        is_torque = line.y == "mu_torque"
        color, marker, ls = look.LINES[k % len(look.LINES)]
        if both:
            color, ls = look.LIMITS["mu_torque_theory" if is_torque else "mu_forward_theory"]
            marker = "s" if is_torque else "o"
        label = line.title or "computed"
        if both or is_torque:
            label = f"{'torque' if is_torque else 'force'}, {label}"
        label = look.wrapped(label, np.inf if alone else 1.6, 8.0)
        if label.startswith("_"):  # which would hide it
            label = f" {label}"
        ink: look.Ink = {"color": color, "marker": marker, "ms": 3.6}
        joining: look.Ink = {"lw": JOINING, "ls": "-"}
        if line.limit is not None:
            x, y, form = line.limit
            joining = {"ls": "none"}
            axes.plot(x, y, color=color, ls=ls, gid="limit", label=form if alone else "")
            if not alone:  # one legend entry for the points and their limit
                axes.plot([], [], ls=ls, label=label, **ink)
                label = ""
            notes |= {float(line.points["velocity"])} if line.x == "amplitude" else set()
        names = line.x, line.y, f"{line.y}_error", "converged"
        panels.computed(axes, *columns(line.points, *names), label=label, **ink | joining)
    _references(axes, lines, shown)
    quantities = [look.quantity(one.points, one.x) for one in lines]
    several = len({one.unit for one in quantities}) > 1
    text = f"{quantities[0].text}, in the units of each motion"
    axes.set_xlabel(text if several else look.axis(quantities[0]))
    axes.set_ylabel(FORCE_AND_TORQUE if both else look.FRICTION)
    panels.unit_range(axes)
    axes.margins(x=0.0 if alone else 0.02)
    panels.logarithmic_if_wide(axes)
    if notes:
        at = ", ".join(f"${look.number(one)}$" for one in sorted(notes))
        text = f"lines: limit for velocity to 0;\nmarkers: velocity {at}"
        axes.set_title(text, loc="left", fontsize=look.HEADING)


def _references(axes: Axes, lines: Sequence[Line], shown: Sequence[xr.Dataset]) -> None:
    """Draw friction at the velocity of a drive, from a sweep without a drive in the figure."""
    points = lines[0].points
    if "drive" not in points.attrs or "velocity" not in points.coords or points["velocity"].ndim:
        return
    for one in shown:
        same = all(one.attrs.get(n) == points.attrs.get(n) for n in ("motion", "pressure"))
        if same and "drive" not in one.attrs and "velocity" in one.dims:
            near = one.sel(velocity=float(points["velocity"]), method="nearest")
            if np.isclose(near["velocity"], points["velocity"]) and near["mu_macro"].ndim == 0:
                text = look.literal(one.attrs.get("title", ""))
                axes.axhline(float(near["mu_macro"]), color=look.BLACK, label=text, gid="reference")
