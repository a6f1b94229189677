"""Draw parts of panels: letters, legends, colour bars, ticks and points."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from microslip.report.figures import style as look
from microslip.report.figures.data import finite_or_nan

WIDE = 10.0
"""An axis is logarithmic if the ratio of its largest to its smallest value exceeds this number."""
VISIBLE_ERROR = 0.01
"""Smallest error estimate that is drawn, relative to the largest value. The markers hide smaller
error estimates."""


def grid(figure: Figure | SubFigure, count: int, across: int, **shared: Any) -> list[Axes]:
    """Return `count` new panels in rows of `across` panels. shared: arguments of `subplots`."""
    rows = -(-count // across)
    axes = list(figure.subplots(rows, across, squeeze=False, **shared).flat)
    for empty in axes[count:]:
        empty.remove()
    return axes[:count]


def lettered(axes: Axes, note: str = "") -> str:
    """Return the heading of a panel: the next letter of its figure, bold and in brackets, and an
    optional note."""
    figure: Any = axes.get_figure(root=True)
    figure.letters = [*getattr(figure, "letters", ()), axes]
    letter = look.letters(len(figure.letters))[-1]
    return rf"$\bf{{({letter})}}$" + (rf"$\;$ {note}" if note else "")


def heading(axes: Axes, note: str = "", room: float = np.inf) -> None:
    """Write a letter and a note above a panel, in lines at most `room` inches wide."""
    text = look.wrapped(lettered(axes, note), room, look.HEADING)
    axes.set_title(text, loc="left", pad=5, fontsize=look.HEADING)


def legend_above(
    axes: Axes, note: str = "", ncols: int = 2, handles: Sequence[Artist] | None = None
) -> None:
    """Write a letter, a note and a legend above a panel. handles: replace the panel's entries."""
    legend = axes.legend(
        handles=axes.get_legend_handles_labels()[0] if handles is None else handles,
        title=lettered(axes, note),
        title_fontsize=look.HEADING,
        alignment="left",
        loc="lower left",
        bbox_to_anchor=(0.0, 1.02),
        ncols=ncols,
        handletextpad=0.6,
        columnspacing=0.8,
        borderaxespad=0.0,
        borderpad=0.0,
    )
    legend.set_gid("heading")


def legend_of_figure(
    figure: Figure | SubFigure, handles: Iterable[Artist], where: str = "upper center", **more: Any
) -> None:
    """Add one legend outside the panels."""
    if entries := list(handles):
        more = {"ncols": len(entries), "columnspacing": 1.6} | more
        place: Any = f"outside {where}"
        figure.legend(handles=entries, loc=place, **more)


def colour_bar(
    shown: ScalarMappable, panels: Axes | Sequence[Axes], label: str, **settings: Any
) -> Colorbar:
    """Add a colour bar beside one or several panels."""
    figure = np.ravel(np.array(panels, dtype=object))[0].figure
    bar = figure.colorbar(shown, ax=panels, **{"pad": 0.02, "aspect": 28, **settings})
    bar.set_label(label)
    bar.ax.tick_params(direction="out")
    return bar


def ticks_outside(axes: Axes) -> None:
    """Move the ticks of a filled panel to its outside, at the bottom and the left."""
    axes.tick_params(which="both", direction="out", top=False, right=False)


def logarithmic_if_wide(axes: Axes, values: np.ndarray) -> None:
    """Make the abscissa logarithmic if all values are positive and their ratio exceeds WIDE."""
    if values.min() > 0.0 and values.max() > WIDE * values.min():
        logarithmic(axes)


def logarithmic(axes: Axes, limits: Sequence[float] | np.ndarray | None = None) -> None:
    """Make the abscissa of a panel logarithmic. limits: its first and last value."""
    axes.set(xscale="log")
    if limits is not None:
        axes.set_xlim(*limits)
    logarithmic_ticks(axes.xaxis)


def logarithmic_ticks(axis: Axis) -> None:
    """Label an axis at powers of ten, or at round numbers if it contains fewer than two powers."""
    low, high = np.sort(axis.get_view_interval())
    powers = np.floor(np.log10(high) + 1e-9) - np.ceil(np.log10(low) - 1e-9) + 1
    axis.set_minor_formatter(NullFormatter())
    if powers >= 2:
        axis.set_major_locator(LogLocator(numticks=6 if powers <= 5 else None))
        return
    wide = high > 8.0 * low
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)) if wide else MaxNLocator(3, steps=[1, 2, 5]))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:.6g}"))


def edges(points: np.ndarray, logarithmic: bool) -> np.ndarray:
    """Return the edges, shape (n + 1,), of cells around n points.

    The edges are half-way between neighbouring points. The first and the last point are in the
    middle of their cells. points: ascending; logarithmic: True for geometric means, False for
    arithmetic means.
    """
    if logarithmic:
        return np.exp(edges(np.log(points), False))
    between = (points[1:] + points[:-1]) / 2 if points.size > 1 else points + 0.5
    return np.unique([2 * points[0] - between[0], *between, 2 * points[-1] - between[-1]])


def unit_range(axes: Axes, low: float = 0.0, high: float = 1.0) -> None:
    """Set the vertical range of a panel to 0 to 1, extended to `low` and `high`."""
    low, high = np.floor(5 * min(low, 0.0)) / 5, np.ceil(5 * max(high, 1.0)) / 5
    margin = 0.04 * (high - low)
    axes.set_ylim(low - margin, high + margin)
    axes.set_yticks(np.arange(round(5 * low), round(5 * high) + 1) / 5)


def computed(axes: Axes, x: np.ndarray, *points: np.ndarray, label: str = "", **ink: Any) -> None:
    """Draw computed points with error bars. Unconverged points are hollow.

    points: values, error estimates, and flags that are nonzero for converged points.
    """
    values, errors, converged = points[0], finite_or_nan(points[1]), points[2] != 0
    marks: look.Ink = {"color": look.BLACK, "ls": "none", "marker": "o", "ms": 3.2, "mew": 0.7}
    marks |= {"zorder": 5, **ink}
    bars: look.Ink = {"fmt": "none", "ecolor": marks["color"], "elinewidth": 0.7, "capsize": 1.8}
    if np.nanmax(errors, initial=0.0) >= VISIBLE_ERROR * np.nanmax(np.abs(values), initial=1e-300):
        axes.errorbar(x, values, yerr=errors, **bars).lines[2][0].set_gid("error")
    axes.plot(x[converged], values[converged], gid="computed", label=label, **marks)
    if not converged.all():
        marks |= {"mfc": "white", "ls": "none", "gid": "unconverged"}
        text = once(axes, "not converged")
        axes.plot(x[~converged], values[~converged], label=text, **marks)


def once(axes: Axes, label: str) -> str:
    """Return the label, prefixed with "_" (hidden in legends) if the panel already has this
    label."""
    return "_" + label if label in axes.get_legend_handles_labels()[1] else label


def after_layout(figure: Any, finish: Callable[[], None]) -> None:
    """Register a function that is called after the layout. The function must not move panels."""
    figure.finishing = [*getattr(figure, "finishing", ()), finish]
