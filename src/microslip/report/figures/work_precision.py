"""Accuracy against cost: the error of every trial over its time, or over its effort.

One panel a point. All panels share their axes, so further down and to the left is better in every
one. Models with the method that ships have a look each; runs by other methods are small grey marks
of one kind, which `profile` tells apart. What has no place on the axes is drawn in strips along
them, never left out: errors too small to judge at the bottom, trials without a result at the top,
costs of zero at the left.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.markers import CARETDOWN, CARETLEFT
from matplotlib.patches import Patch
from matplotlib.transforms import Bbox

from microslip.config.quantities import AMPLITUDE, MU_MACRO, VELOCITY
from microslip.report.figures import style as look
from microslip.report.figures.data import require
from microslip.report.figures.panels import (
    COLUMNS,
    PANEL,
    TITLE,
    Scale,
    grid,
    label_beside,
    share_axes,
)

COSTS = {
    "accuracy_vs_cost": ("seconds", "front_seconds", "CPU time of a run  $t$ (s)"),
    "accuracy_vs_work": (
        "effort",
        "front_effort",
        "effort: iterations $\\times$ unknowns\n(dimensionless)",
    ),
}
"""Abscissa of each figure: the variable, the front in it, the label."""
POINT: tuple[str, ...] = (
    "point",
    "point_title",
    "point_motion",
    "point_velocity",
    "point_amplitude",
)
POINT += ("point_poisson", "reference_error")
TRIAL: tuple[str, ...] = (
    "trial_point",
    "trial_model",
    "trial_method",
    "trial_level",
    "trial_tolerance",
)
TRIAL += ("error", "converged")

BELOW_REFERENCE = 3.0
"""Errors so many times smaller than what is known of any reference are drawn in the strip."""
MOST = 1e6
"""The largest error over the smallest that has a place above the strip."""

FRONT: dict[str, Any] = {
    "color": "#EBD9A0",
    "linewidth": 5.0,
    "solid_capstyle": "round",
    "zorder": 1,
}
UNKNOWN: dict[str, Any] = {
    "facecolor": "none",
    "edgecolor": "#A8A8A8",
    "linewidth": 0.0,
    "hatch": "/////",
}
SHIPPED: dict[str, Any] = {"linewidth": 1.1, "markersize": 4.2, "markeredgewidth": 0.8, "zorder": 5}
OTHER: dict[str, Any] = {
    "color": "#8C8C8C",
    "marker": "o",
    "linestyle": "none",
    "markersize": 2.0,
    "zorder": 3,
}
OTHER |= {"markeredgewidth": 0.0}
AUTO: dict[str, Any] = {
    "color": look.BLACK,
    "marker": "D",
    "linewidth": 0.8,
    "markersize": 4.2,
    "zorder": 7,
}
PAPER: dict[str, Any] = {
    "color": look.BLACK,
    "marker": "*",
    "linestyle": "none",
    "markersize": 9.0,
    "zorder": 8,
}
CROSS: dict[str, Any] = {"color": look.BLACK, "marker": "x", "linestyle": "none", "markersize": 5.0}
CROSS |= {"markeredgewidth": 0.7, "zorder": 9}
ARROW: dict[str, Any] = {"color": look.BLACK, "linestyle": "none", "markersize": 3.6, "zorder": 9}
MARKS = 7  # lines in the legend of marks


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the figure `name`: errors over seconds, or over effort."""
    cost, front, label = COSTS[name]
    require(name, "accuracy_cost", dataset, (*POINT, *TRIAL, cost, front))
    points = [dataset.isel(point=index) for index in range(dataset.sizes["point"])]
    if not points or not dataset.sizes["trial"]:
        raise ValueError(f"figure {name}: the dataset holds no points or no trials")
    of_point = dataset["trial_point"].values.astype(str)
    scales = _scale_of_costs(dataset[cost].values), _scale_of_errors(dataset)
    letters = look.letters(len(points))
    titles = [_title(which, point) for which, point in zip(letters, points, strict=True)]
    models = set(dataset["trial_model"].values.astype(str)) - {"auto"}
    others = bool(set(dataset["trial_method"].values.astype(str)) - {"shipped", "paper"})
    # Beside a panel the lists stand one above the other.
    figure, panels, below = grid(titles, len(models) + MARKS + 2, max(len(models), MARKS))
    for index, (axes, point) in enumerate(zip(panels, points, strict=True)):
        rows = dataset.isel(trial=of_point == str(point["point"].item()))
        table = Table(rows, cost, *scales)
        share_axes(axes, *scales)
        _behind(axes, float(point["reference_error"]), table, rows[front].values != 0)
        _trials(axes, table)
        _labels(axes, table)
        lowest = index + COLUMNS >= len(points)
        axes.tick_params(labelleft=index % COLUMNS == 0, labelbottom=lowest)
        axes.set_xlabel(label if lowest else "")
        axes.set_ylabel("" if index % COLUMNS else f"error of {MU_MACRO.math}\n(dimensionless)")
    _legends(below, models, others)
    return figure


class Table:
    """The trials of one point as arrays: where they are drawn, and what they are."""

    def __init__(self, rows: xr.Dataset, cost: str, costs: Scale, errors: Scale) -> None:
        order = np.lexsort((rows[cost].values, rows["trial_level"].values))
        self.order = order
        columns = ("trial_model", "trial_method")
        self.model, self.method = (rows[name].values.astype(str)[order] for name in columns)
        self.tolerance = rows["trial_tolerance"].values[order]
        self.converged = rows["converged"].values[order] != 0
        raw_cost, raw_error = (rows[name].values.astype(float)[order] for name in (cost, "error"))
        self.finite = np.isfinite(raw_error)
        self.x, self.y = costs.shown(raw_cost), errors.shown(raw_error)
        self.left, self.low = raw_cost < costs.low, raw_error < errors.low
        self.costs, self.errors = costs, errors
        self.auto = self.model == "auto"


def _scale_of_costs(costs: np.ndarray) -> Scale:
    """A scale that spans all costs above zero."""
    costs = np.asarray(costs, dtype=float)
    counted = costs[np.isfinite(costs) & (costs > 0)]
    low, high = (counted.min(), counted.max()) if counted.size else (1.0, 10.0)
    margin = max((high / low) ** 0.05, 1.2)
    below, above = bool((costs <= 0).any()), not np.isfinite(costs).all()
    return Scale.over(low / margin, high * margin, below, above)


def _scale_of_errors(dataset: xr.Dataset) -> Scale:
    """A scale from just below what can be judged to the largest error."""
    errors, of_point = dataset["error"].values, dataset["trial_point"].values.astype(str)
    counted = np.isfinite(errors) & (errors > 0)
    lows = []
    columns = (dataset[name].values for name in ("point", "reference_error"))
    for point, known in zip(*columns, strict=True):
        smallest = errors[counted & (of_point == str(point))].min(initial=np.inf) / 1.5
        known = known / BELOW_REFERENCE if np.isfinite(known) else 0.0
        lows.append(max(known, smallest) if np.isfinite(smallest) else known or np.inf)
    high = 1.5 * errors[counted].max(initial=1e-3)
    low = max(min(*lows, high / 100.0), high / MOST)
    return Scale.over(low, high, bool((errors < low).any()), not np.isfinite(errors).all())


def _title(which: str, point: xr.Dataset) -> str:
    """The heading of a panel: its letter, the title of its point, and the point's numbers."""
    motion = str(point["point_motion"].item())
    known = (table.get(motion) for table in (VELOCITY, AMPLITUDE))
    symbols = [one.latex if one else plain for one, plain in zip(known, "vA", strict=True)]
    values = (float(point[f"point_{n}"]) for n in ("velocity", "amplitude", "poisson"))
    numbers = [
        rf"${symbol} = {look.number(value)}$"
        for symbol, value in zip((*symbols, r"\nu"), values, strict=True)
        if np.isfinite(value)
    ]
    title = look.heading(which, look.literal(point["point_title"].item()))
    return look.wrapped(title, PANEL[0], TITLE) + "\n" + ",  ".join(numbers)


def _behind(axes: Axes, known: float, table: Table, front: np.ndarray) -> None:
    """Draw what lies behind the trials: the reference's error, hatched, and the Pareto front."""
    bottom, top = axes.get_ylim()
    if known > bottom:  # what is not known at all is NaN
        axes.axhspan(bottom, min(known, top), gid="reference", zorder=0.5, **UNKNOWN)
    chosen = front[table.order]
    x, y = table.x[chosen], table.y[chosen]
    along = np.lexsort((-y, x))
    axes.plot(x[along], y[along], drawstyle="steps-post", gid="front", **FRONT)


def _trials(axes: Axes, table: Table) -> None:
    """Draw every trial of a point: curves over the levels, one a model, and marks of others."""
    for model, method in dict.fromkeys(zip(table.model, table.method, strict=True)):
        mine = (table.model == model) & (table.method == method)
        color, marker, _ = look.model(model)
        if method == "paper":
            ink = PAPER
        elif model == "auto":
            ink = AUTO
        elif method == "shipped":
            ink = SHIPPED | {"color": color, "marker": marker}
        else:
            ink = OTHER
        joined, failed = mine & table.finite, mine & ~(table.finite & table.converged)
        axes.plot(table.x[joined], table.y[joined], gid=f"{model} {method}", **ink)
        if ink is OTHER:
            failed = failed & False  # the cross tells enough
        ink = ink | {"linestyle": "none", "markerfacecolor": "white"}
        axes.plot(table.x[failed], table.y[failed], gid="hollow", **ink)
    failed = ~(table.finite & table.converged)
    axes.plot(table.x[failed], table.y[failed], gid="not converged", **CROSS)
    left, bottom = table.costs.first, table.errors.first
    strips: list[tuple[np.ndarray, str, Any]]
    strips = [(table.low, "low", CARETDOWN), (table.left, "left", CARETLEFT)]
    for mine, gid, marker in strips:
        x = np.full(mine.sum(), left) if gid == "left" else table.x[mine]
        y = np.full(mine.sum(), bottom) if gid == "low" else table.y[mine]
        if mine.any():
            axes.plot(x, y, marker=marker, gid=gid, clip_on=False, **ARROW)


def _labels(axes: Axes, table: Table) -> None:
    """Name the tolerances where there is room; the list below tells the other marks."""
    points = axes.transData.transform(np.column_stack((table.x, table.y)))
    drawn = [points]
    for line in axes.get_lines():
        if " " in (line.get_gid() or "") and line.get_linestyle() != "None":  # those of a model
            corners = axes.transData.transform(line.get_path().vertices)
            drawn.append(np.concatenate([*map(_along, corners[:-1], corners[1:]), corners]))
    taken: list[Bbox] = []
    for index in np.flatnonzero(table.auto):
        text = f"${look.power_of_ten(table.tolerance[index])}$"
        label_beside(axes, text, points[index], np.concatenate(drawn), taken)


def _along(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Points of a line from start to end, in pixels, closer than letters are wide."""
    return np.linspace(start, end, 20)


def _legends(below: Axes, models: set[str], others: bool) -> None:
    """Two lists: the models, and the marks; side by side where there is room."""
    shipped = [
        Line2D([], [], label=name, color=look.model(name)[0], marker=look.model(name)[1], **SHIPPED)
        for name in look.in_order(models)
    ]
    marks = [
        Line2D([], [], label="Pareto front", **FRONT),
        Line2D([], [], label="chosen by tolerance", **AUTO),
        Line2D([], [], label="paper's run", **PAPER),
        *([Line2D([], [], label="any other method", **OTHER)] if others else []),
        Line2D([], [], label="not converged, or none", **CROSS),
        Line2D([], [], label="too small for the axis", **ARROW | {"marker": CARETDOWN}),
        Patch(label="within the reference's error", **UNKNOWN),
    ]
    wide = below.get_position().width > 0.8
    top = 1.0
    lists: list[tuple[str, Sequence[Artist]]]
    lists = [("shipped method", shipped), ("marks", marks)]
    for index, (title, handles) in enumerate(lists):
        if not handles:
            continue
        legend = Legend(
            below,
            handles,
            [str(handle.get_label()) for handle in handles],
            title=title,
            loc="upper left",
            bbox_to_anchor=(0.4 * index, 1.0) if wide else (0.0, top),
            fontsize=look.SMALLEST,
            title_fontsize=TITLE,
            alignment="left",
            borderaxespad=0.0,
            borderpad=0.0,
            handlelength=2.2,
        )
        below.add_artist(legend)
        top -= legend.get_window_extent().height / below.bbox.height + 0.05
