"""Pieces of panels that several figures share: letters, legends, colour bars, ticks, points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from microslip.report.figures import style as look
from microslip.report.figures.data import finite_or_nan

VISIBLE_ERROR = 0.01
"""Error estimates below this are narrower than the markers and are not drawn."""


def letter(axes: Axes, which: str, note: str = "", room: float = np.inf) -> None:
    """Head a panel with its letter and an optional note, broken into lines of `room` inches."""
    text = look.wrapped(look.heading(which, note), room, look.HEADING)
    axes.set_title(text, loc="left", pad=5, fontsize=look.HEADING)


def legend_above(axes: Axes, which: str, note: str = "", ncols: int = 2) -> None:
    """Head a panel with its letter, a note and its legend, where the legend hides no data."""
    legend = axes.legend(
        title=look.heading(which, note),
        title_fontsize=look.HEADING,
        alignment="left",
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=ncols,
        handlelength=2.2,
        handletextpad=0.6,
        columnspacing=0.8,
        borderaxespad=0.0,
        borderpad=0.0,
    )
    legend.set_gid("heading")


def legend_of_figure(
    figure: Figure, handles: Sequence[Artist], where: str = "upper center", ncols: int | None = None
) -> None:
    """One legend for all panels, outside of them."""
    if handles:
        columns = ncols or len(handles)
        place: look.Ink = {"loc": f"outside {where}", "ncols": columns}
        figure.legend(handles=handles, columnspacing=1.6, **place)


def colour_bar(
    shown: ScalarMappable, panels: Axes | Sequence[Axes], label: str, **settings: Any
) -> Colorbar:
    """A colour bar beside one or several panels."""
    figure = np.ravel(np.array(panels, dtype=object))[0].figure
    bar = figure.colorbar(shown, ax=panels, **{"pad": 0.02, "aspect": 28, **settings})
    bar.set_label(label)
    bar.ax.tick_params(direction="out")
    return bar


def ticks_outside(axes: Axes) -> None:
    """Ticks of a filled panel, below and left of it."""
    axes.tick_params(which="both", direction="out", top=False, right=False)


def logarithmic(axis: Axis) -> None:
    """Label powers of ten; on an axis with fewer than two of them, rounder numbers instead."""
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
    """Edges of cells around points, half-way between them by their ratios or their differences.

    points: ascending, shape (n,). Returns an array of shape (n + 1,); the outer edges are as far
    from the points as the inner ones.
    """
    if logarithmic:
        return np.exp(edges(np.log(points), False))
    between = (points[1:] + points[:-1]) / 2 if points.size > 1 else points + 0.5
    return np.unique([2 * points[0] - between[0], *between, 2 * points[-1] - between[-1]])


def unit_range(axes: Axes, low: float = 0.0) -> None:
    """Set the vertical range, with a margin, of a panel that shows shares from `low` to 1."""
    margin = 0.04 * (1.0 - low)
    axes.set_ylim(low - margin, 1.0 + margin)
    axes.set_yticks([i / 5 for i in range(round(5 * low), 6)])


def computed(axes: Axes, x: np.ndarray, *columns: np.ndarray, label: str, **ink: Any) -> None:
    """Draw computed points: filled if converged, hollow if not; their errors as a band.

    columns: values, error estimates, and whether each converged.
    """
    values, errors, done = columns[0], finite_or_nan(columns[1]), columns[2] != 0
    ink = {"color": look.BLACK, **look.COMPUTED, **ink}
    if np.nanmax(errors, initial=0.0) >= VISIBLE_ERROR:
        band: look.Ink = {"color": look.PALE, "lw": 0, "zorder": 1, "gid": "error-band"}
        once = _once(axes, "error estimate")
        axes.fill_between(x, values - errors, values + errors, label=once, **band)
    axes.plot(x[done], values[done], label=label, gid="computed", **ink)
    if not done.all():
        ink |= {"mfc": "white", "label": _once(axes, "not converged"), "gid": "unconverged"}
        axes.plot(x[~done], values[~done], **ink)


def _once(axes: Axes, label: str) -> str:
    """A label that the legend shows once, however often it is drawn."""
    return "_" + label if label in axes.get_legend_handles_labels()[1] else label


def after_layout(figure: Any, finish: Callable[[], None]) -> None:
    """Register a step that needs the final size of the panels; it must not move them."""
    figure.finishing = [*getattr(figure, "finishing", ()), finish]
