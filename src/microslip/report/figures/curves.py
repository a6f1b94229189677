"""Draw friction along one axis of sweeps: computed points with error estimates, and closed forms.

The figure has a panel for each abscissa, and a line for each combination of values along the other
axes of a sweep. In a sweep over forces, the abscissa is the mean velocity that each force causes.
A certified map of static friction is drawn over the amplitude. Any other certified map is drawn
over the velocity, at several amplitudes. Figures of maps contain similar panels for the edges of a
map.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.config.quantities import FORCE_FORWARD, TORQUE
from microslip.report import selection
from microslip.report.figures import style as look
from microslip.report.selection import PLANE, closed_forms, columns, limit, moving

FORCE_AND_TORQUE = f"force  {FORCE_FORWARD.math}\ntorque  {TORQUE.math}"
JOINING = 0.7
"""Width of the lines that join markers, in points."""
MARGIN = 1.3
"""If the abscissa is the velocity that a force causes, the axis extends beyond the points by this
factor, because the error bars of slow velocities can reach 0."""
MOST_ABOVE = 4
"""A figure with at most this number of lines, all from one dataset, has a narrow panel with the
legend above the panel."""
MANY = 12
"""A legend with at most this number of lines is narrow."""
ABOVE = 2.0
"""Smallest height of a narrow panel with its labels below the legend, in inches."""
FINE, COARSE = 201, 5
"""Number of points on each line of a certified map, and number of amplitudes, each drawn as a
line."""


class Line(NamedTuple):
    """A line of a panel.

    Attributes
    ----------
    points : xarray.Dataset
        Points along one dimension.
    x, y : str
        Names of the variables of the abscissa and the ordinate.
    title : str
        Text of the legend.
    limit : tuple or None
        Abscissa, ordinate and label of a closed form or of the computed static limit.
    axes : tuple
        If the sweep has two other axes: for each of them, the index of the line's value, and its
        text in the legend.  The first index determines the colour of the line, and the second one
        its marker and style.
    """

    points: xr.Dataset
    x: str
    y: str
    title: str
    limit: tuple[np.ndarray, np.ndarray, str] | None = None
    axes: tuple[tuple[int, str], ...] = ()


def draw(*datasets: xr.Dataset) -> Figure:
    """Draw one or several sweeps along one axis."""
    shown = [_resampled(one) if "cell_error" in one else one.squeeze() for one in datasets]
    every = [line for one in shown for line in _lines(one, len(shown) > 1)]
    alone = len(shown) == 1 and len(every) <= MOST_ABOVE
    abscissae = list(dict.fromkeys(line.x for line in every))
    figure = look.new_figure(*((look.SINGLE, 2.7) if alone else (look.DOUBLE, 3.3)))
    grid = look.grid(figure, len(abscissae), len(abscissae))
    for axes, abscissa in zip(grid, abscissae, strict=True):
        lines = [line for line in every if line.x == abscissa]
        _panel(axes, lines, alone)
        _references(axes, lines[0].points, shown)
        places = np.concatenate([one.points[one.x] for one in lines])
        if places.size and any(one.y == "force" for one in lines):
            axes.set_xlim(places.min() / MARGIN, places.max() * MARGIN)
        look.logarithmic_if_wide(axes, places)
        still = [one for one in lines if one.limit is not None and one.x == "amplitude"]
        if velocities := {float(one.points["velocity"]) for one in still}:
            at = f"${look.number(velocities.pop())}$" if len(velocities) == 1 else "of the legend"
            axes.set_title(f"lines: limit for velocity to 0;\nmarkers: velocity {at}", loc="left")
        if len(grid) > 1:
            look.legend_above(axes, ncols=1)
    if len(grid) == 1:
        where, ncols = ("upper center", 2) if alone else ("right upper", 1)
        handles = grid[0].get_legend_handles_labels()[0]
        look.legend_of_figure(figure, handles, where, ncols=ncols, handlelength=3.0)
        least = sum(one.get_window_extent().height for one in figure.legends) / figure.dpi
        figure.set_figheight(max(figure.get_figheight(), least + (ABOVE if alone else 0.0)))
    return figure


def _resampled(dataset: xr.Dataset) -> xr.Dataset:
    """Return the values of a certified map along lines."""
    return selection.resampled(dataset, FINE, COARSE, poisson=np.unique(dataset["poisson"].values))


def _lines(dataset: xr.Dataset, titled: bool) -> Iterator[Line]:
    """Yield the lines of a sweep."""
    over_force = "force" in dataset.dims
    variable = "velocity" if over_force else "mu_macro"
    title, still = look.literal(selection.short_title(dataset)) if titled else "", None
    dim, parts = selection.lines(dataset, variable)
    if dim in PLANE:
        if dim == "amplitude" and 0.0 in dataset.indexes.get("velocity", ()):
            still = dataset.sel(velocity=0.0)
        _, parts = selection.lines(moving(dataset).squeeze(), variable, dim)
    motion, others = dataset.attrs.get("motion", ""), dataset[variable].indexes
    others = {n: index for n, index in others.items() if n in parts[0][0]}
    by_axis = len(others) == 2 and max(map(len, others.values())) <= len(look.LINES)
    by_axis = by_axis and not titled and "mu_torque" not in dataset
    for at, points in parts:
        where = look.conditions(motion, at)
        places = ((others[n].get_loc(at[n]), look.conditions(motion, {n: at[n]})) for n in at)
        axes = tuple(places) if by_axis else ()
        certified = "certified map" if "error" in dataset.attrs else "computed"
        text = ", ".join(filter(None, [title, where])) or certified
        if over_force:
            moves = points.isel(force=points["velocity"].values > 0)
            # A contact at rest cannot be shown on a logarithmic axis of velocities.
            if at_rest := points.sizes["force"] - moves.sizes["force"]:
                text = f"{text} ({at_rest} at rest: not drawn)"
            yield Line(moves, "velocity", "force", text, axes=axes)
            continue
        rest = still.sel({one: at[one] for one in at if one in still.dims}) if still else None
        words = {"mu_macro": "force, ", "mu_torque": "torque, "}
        for name, word in words.items() if "mu_torque" in dataset else [("mu_macro", "")]:
            yield Line(points, dim, name, f"{word}{text}", _limit(points, rest, dim, name), axes)


def _limit(
    points: xr.Dataset, still: xr.Dataset | None, dim: str, variable: str
) -> tuple[np.ndarray, np.ndarray, str] | None:
    """Return a closed form that is exact for these points. If there is none, return the computed
    static limit."""
    for form in closed_forms(points):
        own = ("torque" in form.name) == ("torque" in variable)
        line = limit(points, form.name)
        on_axis = form.arguments[0] == dim and line.ndim == 1
        if form.exact and own and on_axis and form.name != "mu_large_amplitude":
            return line[line.dims[0]].values, line.values, form.label
    if still is None:
        return None
    return still[dim].values, still[variable].values, "limit for velocity to 0"


def _panel(axes: Axes, lines: Sequence[Line], alone: bool, joined: bool = True) -> None:
    """Draw lines with the same abscissa, and label the axes.

    alone: if True, all lines come from one dataset. joined: if True, join the points of lines
    without a limit.
    """
    limits = [one.limit and (*map(tuple, one.limit[:2]), one.limit[2]) for one in lines]
    ratios = {str(one.points["poisson"].values) for one in lines}
    group = len(ratios) if len(ratios) > 1 else len(lines)
    for k, line in enumerate(lines):
        color, marker, ls = look.line(k)
        room = 1.1 if alone else 1.6 if len(lines) <= MANY else 2.4
        label = look.wrapped(line.title, room, 8.0)
        if line.axes:
            (first, _), (second, _) = line.axes
            color, (_, marker, ls), label = look.line(first)[0], look.line(second), ""
        label = f" {label}" if label.startswith("_") else label  # a leading "_" would hide it
        # Later markers are smaller and in front, so that neighbouring lines at one place can be
        # seen.
        overlaps = line.limit is None or len(lines) > MOST_ABOVE
        size = 3.4 + overlaps * min(1.5, 3.0 / group) * ((len(lines) - 1 - k) % group)
        ink: look.Ink = {"color": color, "marker": marker, "ms": size}
        joining: look.Ink = {"lw": JOINING, "ls": ls if joined else "none", "label": label}
        if line.limit is not None:
            x, y, form = line.limit
            common = limits.count(limits[k]) > 1
            # With several datasets, the points and the limit of a line share one legend entry.
            joint = not (alone or common)
            own: look.Ink = ink | {"label": label} if joint else {"color": color, "label": form}
            if limits.index(limits[k]) == k:
                axes.plot(x, y, ls=ls, gid="limit", markevery=[], **own)
            joining = {"ls": "none", "label": "" if joint else label}
        of = "x" if line.y == "force" else "y"
        names = line.x, line.y, f"{getattr(line, of)}_error", "converged"
        show = look.certified if "error" in line.points.attrs else look.computed
        show(axes, *columns(line.points, *names), of=of, clip_on=False, **ink | joining)
    for n in range(2):
        for index, text in dict.fromkeys(line.axes[n] for line in lines if line.axes):
            color, marker, ls = look.line(index)
            key: look.Ink = {"color": look.GREY, "marker": marker, "ls": ls, "lw": JOINING}
            axes.plot([], [], label=text, **key if n else {"color": color})
    quantities = [look.quantity(one.points, one.x) for one in lines]
    several = len({one.unit for one in quantities}) > 1
    text = f"{quantities[0].text}, in the units of each motion"
    axes.set_xlabel(text if several else look.axis(quantities[0]))
    torque = any(line.y == "mu_torque" for line in lines)
    axes.set_ylabel(FORCE_AND_TORQUE if torque else look.FRICTION)
    look.unit_range(axes)
    axes.margins(x=0.0 if alone else 0.02)


def _references(axes: Axes, points: xr.Dataset, shown: Sequence[xr.Dataset]) -> None:
    """Draw a reference line: the friction of a sweep without a drive, at the velocity of the
    drive."""
    if "drive" not in points.attrs or points.get("velocity", points["poisson"]).ndim:
        return
    for one in shown:
        same = all(one.attrs.get(n) == points.attrs.get(n) for n in ("motion", "pressure"))
        if same and "drive" not in one.attrs and "velocity" in one.dims:
            near = one.sel(velocity=float(points["velocity"]), method="nearest")
            if np.isclose(near["velocity"], points["velocity"]) and near["mu_macro"].ndim == 0:
                text = look.literal(selection.short_title(one))
                axes.axhline(float(near["mu_macro"]), color=look.BLACK, label=text, gid="reference")


def cut(axes: Axes, parts: Sequence[xr.Dataset], dim: str, at: xr.DataArray) -> None:
    """Draw friction along an edge of a map, with the closed forms for this edge.

    parts: the map at each Poisson's ratio. dim: axis along the edge. at: coordinate of the edge
    along the other axis.
    """
    other, value = str(at.name), float(at)
    forms = [
        form
        for form in closed_forms(parts[-1])
        if dim in form.arguments and (dim == "velocity" or len(form.arguments) == 1)
    ]
    for form in forms:
        values = limit(parts[0], form.name)
        values = values.sel({other: value}) if other in values.dims else values
        look.closed_form(axes, values[values.dims[0]], values, form.name, form.label)
    motion, markers = parts[0].attrs.get("motion", ""), ""
    edge = look.conditions(motion, {other: value})
    if dim == "amplitude" and forms and value > 0:
        limit_text = f"lines: limit for ${look.symbol(motion, other)} \\to 0$"
        edge, markers = f"{edge},\n{limit_text}", " markers:"
    lines = []
    for part in parts:
        points = (moving(part) if dim == "velocity" else part).sel({other: at})
        title = f"computed, {look.ratio(part)}" if len(parts) > 1 else "computed"
        lines.append(Line(points, dim, "mu_macro", title))
    _panel(axes, lines, alone=True, joined=False)
    look.legend_above(axes, f"{'left' if dim == 'amplitude' else 'top'} edge,{markers} {edge}")
    if dim == "velocity":
        look.logarithmic(axes, points[dim].values[[0, -1]])
