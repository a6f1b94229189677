"""Work-precision diagrams: error of each trial against CPU time or effort.

There is a panel for each point, and all panels have the same axes. Each model with the default
method has a colour and a marker. Runs of other methods are small grey dots. The figure
`accuracy_profile` compares these methods. Trials outside the axes are drawn in strips at the ends.
The bottom strip is for errors below the reference's error, the top strip for trials without a
result, and the left strip for zero cost.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib import patheffects
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.markers import CARETDOWN, CARETLEFT
from matplotlib.patches import Patch

from microslip.config.quantities import AMPLITUDE, MU_MACRO, VELOCITY
from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

COSTS = {
    "accuracy_vs_cost": ("seconds", "CPU time of a run  $t$ (s)"),
    "accuracy_vs_work": ("effort", "effort: iterations $\\times$ unknowns\n(dimensionless)"),
}
"""Variable and label of the abscissa of each figure."""
COLUMNS, WIDTH, ROW, LINE = 3, 1.95, 1.95, 0.15
"""Number of panels in a row; width of a panel, height of a row and of a legend line, in inches."""
BELOW_REFERENCE = 3.0
"""Errors below the reference's error divided by this number are drawn at the bottom."""
MOST = 1e6
"""Largest ratio of the upper to the lower end of the error axis."""

FRONT: look.Ink = {"color": "#EBD9A0", "lw": 5.0, "solid_capstyle": "round", "zorder": 1}
UNKNOWN: look.Ink = {"fc": "none", "ec": "#A8A8A8", "lw": 0.0, "hatch": "/////"}
SHIPPED: look.Ink = {"lw": 1.1, "ms": 4.2, "mew": 0.8, "zorder": 5}
OTHER: look.Ink = {"color": "#8C8C8C", "marker": "o", "ls": "none", "ms": 2.0, "zorder": 3}
OTHER |= {"mew": 0.0}
AUTO: look.Ink = {"color": look.BLACK, "marker": "D", "lw": 0.8, "ms": 4.2, "zorder": 7}
PAPER: look.Ink = {"color": look.BLACK, "marker": "*", "ls": "none", "ms": 9.0, "zorder": 8}
CROSS: look.Ink = {"color": look.BLACK, "marker": "x", "ls": "none", "ms": 5.0, "mew": 0.7}
CROSS |= {"zorder": 9}
ARROW: look.Ink = {"color": look.BLACK, "ls": "none", "ms": 3.6, "zorder": 9}
ARROW |= {"clip_on": False, "marker": CARETDOWN}
AROUND = ((1, 0), (-1, 0), (0, 1), (0, -1), (0.7, 0.7), (-0.7, 0.7), (0.7, -0.7), (-0.7, -0.7))
"""Directions from a point to its label, in the order in which they are tried."""


@dataclass(frozen=True)
class Scale:
    """A logarithmic axis from `low` to `high`, with optional labelled strips at its ends.

    Values below `low` are drawn in the strip labelled `below`. Values that are not finite are drawn
    in the strip labelled `above`. A strip with an empty label is omitted.
    """

    low: float
    high: float
    below: str = ""
    above: str = ""

    @property
    def strip(self) -> float:
        """Ratio of the upper end of a strip to its lower end."""
        return (self.high / self.low) ** 0.1

    def shown(self, values: np.ndarray) -> np.ndarray:
        """Return the coordinates at which values are drawn."""
        inside = np.where(values < self.low, self.low / self.strip**0.5, values)
        return np.where(np.isfinite(values), inside, self.high * self.strip**0.5)

    def on(self, axes: Axes, axis: Axis) -> None:
        """Set the limits and ticks of an axis, and draw a line where a strip begins."""
        first = self.low / (self.strip if self.below else 1.0)
        last = self.high * (self.strip if self.above else 1.0)
        decades = np.arange(np.ceil(np.log10(self.low)), np.floor(np.log10(self.high)) + 1)
        # Labels at the ends would overlap those of the next panel.
        span = np.log10(last / first)
        inner = np.abs(decades - np.log10(first * last) / 2) < 0.44 * span
        decades = decades[inner][:: max(1, -(-inner.sum() // 5))]
        ticks = {10.0**power: f"$10^{{{power:.0f}}}$" for power in decades}
        if self.below == "0":
            ticks = {place: text for place, text in ticks.items() if place > self.low * self.strip}
            ticks[self.low / self.strip**0.5] = "0"
        if self.above:
            ticks = {place: text for place, text in ticks.items() if place < self.high / self.strip}
            ticks[self.high * self.strip**0.5] = self.above
        line = axes.axvline if axis is axes.xaxis else axes.axhline
        for place, name in ((self.low, self.below), (self.high, self.above)):
            if name:
                line(place, color=look.GREY, lw=0.5, ls=look.DOTTED, zorder=2)
        axis.set_ticks(list(ticks), list(ticks.values()))
        axis.set_ticks([], minor=True)
        (axes.set_xlim if axis is axes.xaxis else axes.set_ylim)(first, last)


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the figure `name`: errors against seconds, or against effort."""
    cost, label = COSTS[name]
    points = [dataset.isel(point=index) for index in range(dataset["point"].size)]
    models = look.in_order(set(dataset["trial_model"].values.astype(str)) - {"auto"})
    others = bool(set(dataset["trial_method"].values.astype(str)) - {"shipped", "paper"})
    rows = -(-len(points) // COLUMNS)
    heights = ROW * rows + 0.35, LINE * (max(len(models), 7) + 2.0)
    figure = look.new_figure(look.DOUBLE, sum(heights))
    page, foot = figure.subfigures(2, 1, height_ratios=heights, squeeze=False).flat
    grid = panels.grid(page, len(points), COLUMNS, sharex=True, sharey=True)
    costs, errors = _scale_of_costs(dataset[cost].values), _scale_of_errors(dataset)
    of_point = dataset["trial_point"].values.astype(str)
    for index, (axes, point) in enumerate(zip(grid, points, strict=True)):
        axes.set(xscale="log", yscale="log")
        costs.on(axes, axes.xaxis)
        errors.on(axes, axes.yaxis)
        own = dataset.isel(trial=of_point == str(point["point"].item()))
        _panel(axes, own.sortby("trial_level"), cost, costs, errors)
        _reference(axes, float(point["reference_error"]))
        _head(axes, point)
        if index + COLUMNS >= len(points):
            axes.tick_params(labelbottom=True)
            axes.set_xlabel(label)
        if index % COLUMNS == 0:
            axes.set_ylabel(f"error of {MU_MACRO.math}\n(dimensionless)")
    _legends(foot, models, others)
    return figure


def _scale_of_costs(costs: np.ndarray) -> Scale:
    """Return a scale for all costs above zero."""
    positive = costs[np.isfinite(costs) & (costs > 0)]
    low, high = (positive.min(), positive.max()) if positive.size else (1.0, 10.0)
    margin = max((high / low) ** 0.05, 1.2)
    below, above = (costs <= 0).any(), not np.isfinite(costs).all()
    return Scale(low / margin, high * margin, "0" * bool(below), "none" * bool(above))


def _scale_of_errors(dataset: xr.Dataset) -> Scale:
    """Return a scale from just below the smallest significant error to the largest error."""
    errors, of_point = dataset["error"].values, dataset["trial_point"].values.astype(str)
    positive = np.isfinite(errors) & (errors > 0)
    lows = []
    for point, limit in zip(*columns(dataset, "point", "reference_error"), strict=True):
        smallest = errors[positive & (of_point == str(point))].min(initial=np.inf) / 1.5
        limit = limit / BELOW_REFERENCE if np.isfinite(limit) else 0.0
        lows.append(max(limit, smallest) if np.isfinite(smallest) else limit or np.inf)
    high = 1.5 * errors[positive].max(initial=1e-3)
    low = max(min(*lows, high / 100.0), high / MOST)
    below, above = (errors < low).any(), not np.isfinite(errors).all()
    return Scale(low, high, "below" * bool(below), "none" * bool(above))


def _head(axes: Axes, point: xr.Dataset) -> None:
    """Write the letter of a panel, and the title and the parameters of its point."""
    motion = str(point["point_motion"].item())
    quantities = (table.get(motion) for table in (VELOCITY, AMPLITUDE))
    symbols = [one.latex if one else plain for one, plain in zip(quantities, "vA", strict=True)]
    values = (float(point[f"point_{n}"]) for n in ("velocity", "amplitude", "poisson"))
    pairs = zip((*symbols, r"\nu"), values, strict=True)
    numbers = look.conditions((symbol, value) for symbol, value in pairs if np.isfinite(value))
    title = panels.lettered(axes, look.literal(point["point_title"].item()))
    head = f"{look.wrapped(title, WIDTH, look.HEADING)}\n{numbers}"
    axes.set_title(head, loc="left", pad=4, fontsize=look.HEADING, linespacing=1.15)


def _reference(axes: Axes, error: float) -> None:
    """Hatch the range below the reference's error, unless this error is NaN."""
    bottom, top = axes.get_ylim()
    if error > bottom:
        axes.axhspan(bottom, min(error, top), gid="reference", zorder=0.5, **UNKNOWN)


def _panel(axes: Axes, rows: xr.Dataset, cost: str, costs: Scale, errors: Scale) -> None:
    """Draw every trial of a point, with a curve for each model and markers for other methods."""
    raw_x, raw_y, front = columns(rows, cost, "error", f"front_{cost}")
    x, y, converged = costs.shown(raw_x), errors.shown(raw_y), rows["converged"].values != 0
    model, method = (rows[f"trial_{n}"].values.astype(str) for n in ("model", "method"))
    best = np.flatnonzero(front)
    best = best[np.lexsort((-y[best], x[best]))]
    axes.plot(x[best], y[best], drawstyle="steps-post", gid="front", **FRONT)
    unconverged = ~(np.isfinite(raw_y) & converged)
    for pair in dict.fromkeys(zip(model, method, strict=True)):
        own = (model == pair[0]) & (method == pair[1])
        ink = _ink(*pair)
        finite = own & np.isfinite(raw_y)
        axes.plot(x[finite], y[finite], gid=" ".join(pair), **ink)
        if ink is not OTHER:
            hollow: look.Ink = ink | {"ls": "none", "mfc": "white", "gid": "hollow"}
            axes.plot(x[own & unconverged], y[own & unconverged], **hollow)
    axes.plot(x[unconverged], y[unconverged], gid="not converged", **CROSS)
    low, left = raw_y < errors.low, raw_x < costs.low
    if low.any():
        bottom = np.full(low.sum(), axes.get_ylim()[0])
        axes.plot(x[low], bottom, gid="low", **ARROW)
    if left.any():
        side = np.full(left.sum(), axes.get_xlim()[0])
        axes.plot(side, y[left], gid="left", **(ARROW | {"marker": CARETLEFT}))
    auto, tolerances = model == "auto", rows["trial_tolerance"].values
    texts = [f"${look.power_of_ten(tolerance)}$" for tolerance in tolerances[auto]]
    marks = np.column_stack((x, y))
    panels.after_layout(axes.get_figure(root=True), lambda: _label(axes, texts, auto, marks))


def _ink(model: str, method: str) -> look.Ink:
    """Return the colour, marker and line style for trials of a model with a method."""
    if method == "paper":
        return PAPER
    if model == "auto":
        return AUTO
    color, marker, _ = look.model(model)
    return SHIPPED | {"color": color, "marker": marker} if method == "shipped" else OTHER


def _label(axes: Axes, texts: list[str], has_label: np.ndarray, marks: np.ndarray) -> None:
    """Write labels beside markers. A label that would overlap a marker or a line is omitted.

    texts: labels, one for each true value in `has_label`; marks: data coordinates, shape (n, 2).
    """
    pixels, scale = axes.transData.transform(marks), look.DPI / 72.0
    line = pixels[has_label]
    obstacles = np.concatenate([pixels, *np.linspace(line[:-1], line[1:], 20)])
    for text, place in zip(texts, pixels[has_label], strict=True):
        size = np.array([look.width(text, look.SMALLEST) * 72.0, look.SMALLEST]) * scale
        for way in np.array(AROUND):
            middle = place + way * (size / 2 + 5.0 * scale)
            low, high = middle - size / 2, middle + size / 2
            overlaps = ((obstacles > low - scale) & (obstacles < high + scale)).all(axis=1)
            if not overlaps.any() and axes.bbox.contains(*low) and axes.bbox.contains(*high):
                white = [patheffects.withStroke(linewidth=1.5, foreground="white")]
                at = axes.transData.inverted().transform(middle)
                ink: look.Ink = {"fontsize": look.SMALLEST, "ha": "center", "va": "center"}
                ink |= {"zorder": 10, "path_effects": white, "gid": "label"}
                axes.text(at[0], at[1], text, **ink)
                corners = np.stack(np.meshgrid(*np.linspace(low, high, 5).T), axis=-1)
                obstacles = np.concatenate([obstacles, corners.reshape(-1, 2)])
                break


def _legends(figure: SubFigure, models: list[str], others: bool) -> None:
    """Add two legends side by side: models and markers."""
    shipped: list[Artist] = [
        Line2D([], [], label=model, **_ink(model, "shipped")) for model in models
    ]
    marks: list[Artist] = [
        Line2D([], [], label="Pareto front", **FRONT),
        Line2D([], [], label="chosen by tolerance", **AUTO),
        Line2D([], [], label="paper's run", **PAPER),
        *([Line2D([], [], label="any other method", **OTHER)] if others else []),
        Line2D([], [], label="not converged, or none", **CROSS),
        Line2D([], [], label="too small for the axis", **ARROW),
        Patch(label="within the reference's error", **UNKNOWN),
    ]
    for title, handles, side in (("shipped method", shipped, "left"), ("marks", marks, "center")):
        text: look.Ink = {"fontsize": look.SMALLEST, "title_fontsize": look.HEADING}
        text |= {"alignment": "left", "title": title, "loc": f"upper {side}"}
        figure.legend(handles=handles, **text)
