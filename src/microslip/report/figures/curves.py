"""Friction along one axis of sweeps: computed points with error estimates, and closed forms.

The figure has a panel for each abscissa, and a line for each value of the other axes of a sweep. A
sweep over forces is drawn at the mean velocities that the forces cause.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.config.quantities import FORCE_FORWARD, TORQUE
from microslip.datasets.catalogue import FORMS, STATIC, ClosedForm
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns, limit

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
    dim : str
        This dimension.
    variable, title : str
        Variable that is drawn, and text of the legend.
    limit : tuple or None
        Abscissa, ordinate and label of a closed form or of the computed static limit.
    """

    points: xr.Dataset
    dim: str
    variable: str
    title: str
    limit: tuple[np.ndarray, np.ndarray, str] | None

    @property
    def abscissa(self) -> str:
        """Name of the abscissa."""
        return "velocity" if self.dim == "force" else self.dim


def closed_forms(dataset: xr.Dataset) -> list[ClosedForm]:
    """Return the closed forms that a dataset contains. The closed forms of its motion come
    first."""
    motion = dataset.attrs.get("motion", "").partition(":")[0]
    every = {name: form for forms in FORMS.values() for name, form in forms.items()}
    every = FORMS.get(motion, {}) | {
        name: form for name, form in every.items() if name not in FORMS.get(motion, {})
    }
    return [form for name, form in every.items() if name in dataset]


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
    lines = [line for one in shown for line in _lines(one, len(shown) > 1)]
    abscissae = list(dict.fromkeys(line.abscissa for line in lines))
    alone = len(shown) == 1
    width = look.SINGLE if alone else look.DOUBLE
    figure = look.new_figure(width, 2.7 if alone else 3.3)
    grid = panels.grid(figure, len(abscissae), len(abscissae))
    for axes, abscissa in zip(grid, abscissae, strict=True):
        own = [line for line in lines if line.abscissa == abscissa]
        handles = _panel(axes, own, shown, alone)
        if len(grid) > 1:
            panels.legend_above(axes, ncols=1, handles=handles)
        elif alone:
            panels.legend_of_figure(figure, handles, ncols=2)
        else:
            panels.legend_of_figure(figure, handles, "right upper", ncols=1, handlelength=3.0)
    return figure


def _static_map(dataset: xr.Dataset) -> xr.Dataset:
    """Return the values of a certified map of static friction on a fine axis."""
    low, high = (float(one) for one in (dataset["amplitude"].min(), dataset["amplitude"].max()))
    ratios = np.unique(dataset["poisson"].values)
    amplitude = np.linspace(low, high, FINE)
    fine = dataset.microslip.at(velocity=0.0, amplitude=amplitude, poisson=ratios).squeeze()
    fine["amplitude"].attrs = dataset["amplitude"].attrs
    return fine.assign(converged=np.isfinite(fine["mu_macro"])).assign_attrs(dataset.attrs)


def _lines(dataset: xr.Dataset, titled: bool) -> list[Line]:
    """Return the lines of a sweep."""
    over_force = "force" in dataset.dims
    variables = ["velocity"] if over_force else ["mu_macro"]
    variables += ["mu_torque"] if "mu_torque" in dataset else []
    sizes = {str(dim): dataset.sizes[dim] for dim in dataset[variables[0]].dims}
    dim = "force" if over_force else max(sizes, key=lambda one: sizes[one])
    title, still = look.literal(dataset.attrs.get("title", "")) if titled else "", None
    if dim == "amplitude" and "velocity" in sizes:
        still = dataset.sel(velocity=0.0) if 0.0 in dataset["velocity"] else None
        moves = dataset.isel(velocity=dataset["velocity"].values > 0)
        dataset = moves.squeeze("velocity") if moves.sizes["velocity"] == 1 else moves
    elif dim == "velocity":
        dataset = dataset.isel(velocity=dataset["velocity"].values > 0)
    others = [str(one) for one in dataset[variables[0]].dims if one != dim]
    lines = []
    for place in product(*(range(dataset.sizes[other]) for other in others)):
        at = dict(zip(others, place, strict=True))
        points = dataset.isel(at)
        texts = [title] + [
            look.conditions([(look.symbol(points, o), float(points[o]))]) for o in others
        ]
        rest = still.isel({one: k for one, k in at.items() if one in still.dims}) if still else None
        for variable in variables:
            limits = (points, rest, dim, variable)
            text = ", ".join(filter(None, texts))
            lines.append(Line(points, dim, variable, text, _limit(*limits)))
    return lines


def _limit(
    points: xr.Dataset, still: xr.Dataset | None, dim: str, variable: str
) -> tuple[np.ndarray, np.ndarray, str] | None:
    """Return a closed form that is exact for these points, else the computed static limit."""
    for form in closed_forms(points):
        exact = form.exact and (form.any_poisson or float(points["poisson"]) == 0.0)
        own = ("torque" in form.name) == (
            "torque" in variable
        ) and form.name != "mu_large_amplitude"
        line = limit(points, form.name)
        if exact and own and form.arguments[0] == dim and line.ndim == 1:
            return line[line.dims[0]].values, line.values, form.label
    if still is None:
        return None
    return still[dim].values, still[variable].values, "limit for velocity to 0"


def _panel(
    axes: Axes, lines: Sequence[Line], shown: Iterable[xr.Dataset], alone: bool
) -> list[Artist]:
    """Draw all lines with the same abscissa, and label the axes. Returns the legend entries."""
    both = alone and any(line.variable == "mu_torque" for line in lines)
    low, high, notes = 0.0, 1.0, set()
    handles: list[Artist] = []
    for k, line in enumerate(lines):
        color, marker, ls = look.LINES[k % len(look.LINES)]
        title, joining = line.title, {"lw": JOINING, "ls": "-"}
        if both:
            color, marker, ls = ((look.BLUE, "o", look.SOLID), (look.VERMILLION, "s", look.DASHED))[
                line.variable == "mu_torque"
            ]
        what = "torque" if line.variable == "mu_torque" else "force" if both else ""
        label = ", ".join(filter(None, (what, title or "computed")))
        if line.dim == "force" and (rest := int((line.points["velocity"] <= 0).sum())):
            label += f" ({rest} at rest: not drawn)"
        label = look.wrapped(label, np.inf if alone else 1.6, 8.0)
        if line.limit is not None:
            x, y, form = line.limit
            axes.plot(x, y, color=color, ls=ls, gid="limit")
            joining = {"ls": "none"}
            ink: look.Ink = {"color": color, "ls": ls}
            if alone:
                handles.append(Line2D([], [], label=form, **ink))
                ink = {"color": color, "ls": "none"}
            handles.append(Line2D([], [], marker=marker, ms=3.6, label=label, **ink))
            notes |= {float(line.points["velocity"])} if line.dim == "amplitude" else set()
        x, y, error, converged = _values(line)
        ink = {"color": color, "marker": marker, "ms": 3.6, **joining}
        panels.computed(axes, x, y, error, converged, label=label, **ink)
        low, high = np.nanmin([low, *y]), np.nanmax([high, *y])
    _references(axes, lines, shown)
    named = {handle.get_label() for handle in handles}
    others = axes.get_legend_handles_labels()[0]
    handles += [handle for handle in others if handle.get_label() not in named]
    quantities = [look.quantity(one.points, one.abscissa) for one in lines]
    several = len({one.unit for one in quantities}) > 1
    text = f"{quantities[0].text}, in the units of each motion"
    axes.set_xlabel(text if several else look.axis(quantities[0]))
    panels.unit_range(axes, low, high)
    axes.set_ylabel(FORCE_AND_TORQUE if both else look.FRICTION_IN_TWO_LINES)
    axes.margins(x=0.0 if alone else 0.02)
    panels.logarithmic_if_wide(axes, np.concatenate([_values(line)[0] for line in lines]))
    if notes:
        at = ", ".join(f"${look.number(one)}$" for one in sorted(notes))
        text = f"lines: limit for velocity to 0;\nmarkers: velocity {at}"
        axes.set_title(text, loc="left", fontsize=look.HEADING)
    return handles


def _values(line: Line) -> tuple[np.ndarray, ...]:
    """Return abscissa, ordinate, its error estimate, and flags of converged points. A contact at
    rest has no place on a logarithmic axis of velocities."""
    if line.dim == "force":
        points = line.points.isel(force=line.points["velocity"].values > 0)
        x, y, converged = columns(points, "velocity", "force", "converged")
        return x, y, np.zeros(y.size), converged
    names = line.dim, line.variable, f"{line.variable}_error", "converged"
    return columns(line.points, *names)


def _references(axes: Axes, lines: Sequence[Line], shown: Iterable[xr.Dataset]) -> None:
    """Draw friction at the velocity of a drive, from a sweep without a drive in the figure."""
    points = lines[0].points
    if "drive" not in points.attrs or "velocity" not in points.coords or points["velocity"].ndim:
        return
    for one in shown:
        same = all(one.attrs.get(n) == points.attrs.get(n) for n in ("motion", "pressure"))
        if same and "drive" not in one.attrs and "velocity" in one.dims:
            near = one.sel(velocity=float(points["velocity"]), method="nearest")
            if (
                np.isclose(float(near["velocity"]), float(points["velocity"]))
                and near["mu_macro"].ndim == 0
            ):
                text = look.literal(one.attrs.get("title", ""))
                axes.axhline(float(near["mu_macro"]), color=look.BLACK, label=text, gid="reference")
