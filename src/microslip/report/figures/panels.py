"""Panels that share logarithmic axes: the scales, the page of panels, labels that look for room."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter
from matplotlib.transforms import Bbox

from microslip.report.figures import style as look

COLUMNS = 3
# The page, in inches: a panel, what is left of, between, above (by line) and under the panels.
PANEL, LEFT, BETWEEN, HEAD, FOOT = (2.0, 1.5), 0.76, 0.12, 0.145, 0.62
TITLE = look.HEADING
STRIP = 0.1
"""Width of a strip as a share of the decades on its axis."""
ROOM_FOR_ZERO = 0.12
"""Share of the axis between a zero and the next label."""
AWAY = 5.0
"""Distance of a text from its point, in points of length."""


@dataclass(frozen=True)
class Scale:
    """One axis: from low to high the part with ticks; strips, if any, on from there.

    first, last: ends of the axis. below, above: where what lies beyond low and high is drawn.
    """

    low: float
    high: float
    first: float
    last: float

    @classmethod
    def over(cls, low: float, high: float, below: bool, above: bool) -> Scale:
        """A scale from low to high, with the strips that are wanted."""
        strip = (high / low) ** STRIP
        return cls(low, high, low / strip if below else low, high * strip if above else high)

    @property
    def below(self) -> float:
        return self.low**0.6 * self.first**0.4

    @property
    def above(self) -> float:
        return np.sqrt(self.high * self.last)

    def decades(self) -> tuple[np.ndarray, np.ndarray]:
        """Exponents of the powers of ten with a label, at most five, and of all.

        The outermost parts of the axis have no labels, which would meet those of the next panel.
        """
        low, high, first, last = np.log10([self.low, self.high, self.first, self.last])
        decades = np.arange(np.ceil(low), np.floor(high) + 1)
        edge = 0.06 * (last - first)
        inner = decades[(decades > first + edge) & (decades < last - edge)]
        return inner[:: max(1, -(-inner.size // 5))], decades

    def shown(self, values: np.ndarray) -> np.ndarray:
        """Positions at which values are drawn; small values and NaN are drawn in the strips."""
        values = np.asarray(values, dtype=float)
        inside = np.where(values < self.low, self.below, np.minimum(values, self.last))
        return np.where(np.isfinite(values), inside, self.above)


def grid(titles: list[str], narrow: int, wide: int) -> tuple[Figure, list[Axes], Axes]:
    """A figure with one panel a title that all share their axes, and a place for the legends.

    narrow, wide: lines of the legends where they stand beside the last panel, and where they have
    the width of the page below the panels.
    """
    rows = -(-len(titles) // COLUMNS)
    lines = [titles[row * COLUMNS : (row + 1) * COLUMNS] for row in range(rows)]
    heads = [HEAD * (1 + max(title.count("\n") for title in row)) + 0.1 for row in lines]
    room = heads[-1] + PANEL[1]
    beside = len(titles) % COLUMNS == 1 and rows > 1 and HEAD * (narrow + 1.5) < room
    legend = room if beside else HEAD * (wide + 1.5)
    height = sum(heads) + rows * PANEL[1] + FOOT + (0.0 if beside else legend)
    figure = look.new_figure(look.DOUBLE, height, layout=None)

    def place(x: float, top: float, width: float, tall: float, **shared: Any) -> Axes:
        low = 1.0 - (top + tall) / height
        box = (x / look.DOUBLE, low, width / look.DOUBLE, tall / height)
        return figure.add_axes(box, **shared)

    panels: list[Axes] = []
    for index, title in enumerate(titles):
        row, column = divmod(index, COLUMNS)
        top = sum(heads[: row + 1]) + row * PANEL[1]
        shared: dict[str, Any] = {"sharex": panels[0], "sharey": panels[0]} if panels else {}
        panels.append(place(LEFT + column * (PANEL[0] + BETWEEN), top, *PANEL, **shared))
        panels[-1].set_title(title, loc="left", pad=4, fontsize=TITLE, linespacing=1.15)
    x = LEFT + PANEL[0] + BETWEEN if beside else 0.15
    below = place(x, height - legend, look.DOUBLE - x - 0.05, legend)
    below.set_axis_off()
    return figure, panels, below


def share_axes(axes: Axes, costs: Scale, errors: Scale) -> None:
    """Logarithmic axes with the same ticks in every panel, and a line where a strip begins."""
    axes.set(xscale="log", yscale="log")
    axes.set(xlim=(costs.first, costs.last), ylim=(errors.first, errors.last))
    for axis, scale in ((axes.xaxis, costs), (axes.yaxis, errors)):
        labelled, every = scale.decades()
        ticks = {10.0**power: f"$10^{{{power:.0f}}}$" for power in labelled}
        if axis is axes.xaxis and scale.first < scale.low:
            room = (scale.last / scale.first) ** ROOM_FOR_ZERO
            ticks = {place: text for place, text in ticks.items() if place > scale.below * room}
            ticks[scale.below] = "0"
        if axis is axes.yaxis and scale.last > scale.high:
            ticks[scale.above] = "none"
        axis.set_ticks(list(ticks), list(ticks.values()))
        axis.set_minor_locator(FixedLocator(list(10.0**every)))
        axis.set_minor_formatter(NullFormatter())
    border: dict[str, Any] = {
        "color": look.GREY,
        "linewidth": 0.5,
        "linestyle": look.DOTTED,
        "zorder": 2,
    }
    for scale, line in ((costs, axes.axvline), (errors, axes.axhline)):
        if scale.first < scale.low:
            line(scale.low, **border)
        if scale.last > scale.high:
            line(scale.high, **border)


def label_beside(
    axes: Axes, text: str, point: np.ndarray, drawn: np.ndarray, taken: list[Bbox]
) -> None:
    """Write a text beside a point where it hides nothing; leave it out if it must.

    point: in pixels. drawn: points that are not to be hidden, likewise. taken: boxes of the texts
    that are there already, to which this one is added.
    """
    label = axes.annotate(
        text,
        tuple(axes.transData.inverted().transform(point)),
        (0, 0),
        textcoords="offset points",
        fontsize=look.SMALLEST,
        zorder=10,
        gid="label",
        path_effects=[patheffects.withStroke(linewidth=1.5, foreground="white")],
    )
    label.set_in_layout(False)
    margin = 2.0 * axes.figure.dpi / 72.0  # panels still move a little when the layout settles
    for right, up in ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)):
        far = AWAY if right == 0 or up == 0 else 0.7 * AWAY
        label.set_position((right * far, up * far))
        label.set_horizontalalignment(("right", "center", "left")[right + 1])
        label.set_verticalalignment(("top", "center", "bottom")[up + 1])
        room = label.get_window_extent().padded(margin)
        inside = axes.bbox.containsx(room.x0) and axes.bbox.containsx(room.x1)
        inside = inside and axes.bbox.containsy(room.y0) and axes.bbox.containsy(room.y1)
        free = not any(room.overlaps(other) for other in taken)
        if inside and free and not room.count_contains(drawn):
            taken.append(room)
            return
    label.remove()
