"""Parts of panels: letters, legends, colour bars, ticks, computed points and hatched cells; and
parts of datasets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure, SubFigure
from matplotlib.patches import Circle, Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter

from microslip.report.figures import style as look

WIDE = 10.0
"""An axis is logarithmic if the ratio of its largest to its smallest value exceeds this number."""
VISIBLE_ERROR = 0.01
"""Smallest error estimate that is drawn, relative to the largest value. The markers hide smaller
error estimates."""
POINTS = ("computed", "unconverged")
"""Ids of the markers of computed points."""


def grid(figure: Figure | SubFigure, count: int, across: int, **shared: Any) -> list[Axes]:
    """Return `count` new panels in rows of `across` panels. shared: arguments of `subplots`."""
    axes = list(figure.subplots(-(-count // across), across, squeeze=False, **shared).flat)
    for empty in axes[count:]:
        empty.remove()
    return axes[:count]


def lettered(axes: Axes, note: str = "") -> str:
    """Return the heading of a panel: the next letter of its figure, bold and in brackets, and an
    optional note."""
    figure: Any = axes.get_figure(root=True)
    figure.letters = getattr(figure, "letters", -1) + 1
    return rf"$\bf{{({look.letter(figure.letters)})}}$" + (rf"$\;$ {note}" if note else "")


def heading(axes: Axes, note: str = "", room: float = np.inf) -> None:
    """Write a letter and a note above a panel, in lines at most `room` inches wide."""
    text = look.wrapped(lettered(axes, note), room, look.HEADING)
    axes.set_title(text, loc="left", pad=5, fontsize=look.HEADING)


def legend_above(axes: Axes, note: str = "", ncols: int = 2, **more: Any) -> None:
    """Write a letter, a note and a legend above a panel. more: other arguments of `legend`."""
    place: look.Ink = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.02), "alignment": "left"}
    place |= {"handletextpad": 0.6, "columnspacing": 0.8, "borderaxespad": 0.0, "borderpad": 0.0}
    more |= {"title": lettered(axes, note), "title_fontsize": look.HEADING}
    # An empty legend has a title, too.
    more = {"handles": axes.get_legend_handles_labels()[0]} | more
    axes.legend(ncols=ncols, **place, **more).set_gid("heading")


def legend_of_figure(
    figure: Figure | SubFigure, handles: Iterable[Artist], where: str = "upper center", **more: Any
) -> None:
    """Add one legend outside the panels."""
    if entries := list(handles):
        more = {"ncols": len(entries), "columnspacing": 1.6} | more
        place: Any = f"outside {where}"
        figure.legend(handles=entries, loc=place, **more)


def colour_bar(shown: Any, panels: Axes | Sequence[Axes], label: str, **settings: Any) -> Colorbar:
    """Add a colour bar beside one or several panels. shown: artist with colours in one of them."""
    bar = shown.axes.figure.colorbar(shown, ax=panels, **{"pad": 0.02, "aspect": 28, **settings})
    bar.set_label(label)
    bar.ax.tick_params(direction="out")
    return bar


def ticks_outside(axes: Axes) -> None:
    """Move the ticks of a filled panel to its outside, at the bottom and the left."""
    axes.tick_params(which="both", direction="out", top=False, right=False)


def logarithmic_if_wide(axes: Axes) -> None:
    """Make the abscissa logarithmic if those of all computed points are positive and the ratio of
    the largest to the smallest exceeds WIDE."""
    x = _points(axes, 0)
    if x.size and x.min() > 0.0 and x.max() > WIDE * x.min():
        logarithmic(axes)


def _points(axes: Axes, which: int) -> np.ndarray:
    """Return the finite abscissae (0) or ordinates (1) of all computed points in a panel."""
    lines = [line for line in axes.get_lines() if line.get_gid() in POINTS]
    values = np.concatenate([np.zeros(0), *(np.ravel(line.get_data()[which]) for line in lines)])
    return values[np.isfinite(values)]


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


def cells(axes: Axes, x: np.ndarray, y: np.ndarray, which: np.ndarray, **ink: Any) -> None:
    """Draw a rectangle for each cell that is True.

    x, y: edges of the cells, shapes (n + 1,) and (m + 1,). which: shape (m, n).
    """
    for i, j in np.argwhere(which):
        size = x[j + 1] - x[j], y[i + 1] - y[i]
        axes.add_patch(Rectangle((x[j], y[i]), *size, **ink))


def rim(axes: Axes) -> None:
    """Draw the edge of the contact, a circle with radius 1."""
    axes.add_patch(Circle((0, 0), 1.0, fill=False, lw=0.9))


def unit_range(axes: Axes) -> None:
    """Set the vertical range of a panel to 0 to 1, extended to all computed points."""
    y = _points(axes, 1)
    low, high = np.floor(5 * y.min(initial=0.0)) / 5, np.ceil(5 * y.max(initial=1.0)) / 5
    margin = 0.04 * (high - low)
    axes.set_ylim(low - margin, high + margin)
    axes.set_yticks(np.arange(round(5 * low), round(5 * high) + 1) / 5)


def computed(axes: Axes, x: np.ndarray, *points: np.ndarray, label: str = "", **ink: Any) -> None:
    """Draw computed points with error bars. Unconverged points are hollow.

    points: values, error estimates, and flags that are nonzero for converged points.
    """
    values, errors, converged = points[0], points[1], points[2] != 0
    errors = np.where(np.isfinite(errors), errors, np.nan)
    marks: look.Ink = {"color": look.BLACK, "ls": "none", "marker": "o", "ms": 3.2, "mew": 0.7}
    marks |= {"zorder": 5, **ink}
    bars: look.Ink = {"fmt": "none", "ecolor": marks["color"], "elinewidth": 0.7, "capsize": 1.8}
    if np.nanmax(errors, initial=0.0) >= VISIBLE_ERROR * np.nanmax(np.abs(values), initial=1e-300):
        axes.errorbar(x, values, yerr=errors, **bars).lines[2][0].set_gid("error")
    axes.plot(x[converged], values[converged], gid="computed", label=label, **marks)
    if not converged.all():
        # A label that begins with "_" is not in the legend.
        known = "not converged" in axes.get_legend_handles_labels()[1]
        marks |= {"mfc": "white", "ls": "none", "label": "_" if known else "not converged"}
        axes.plot(x[~converged], values[~converged], gid="unconverged", **marks)


def after_layout(figure: Any, finish: Callable[[], None]) -> None:
    """Register a function that is called after the layout. The function must not move panels."""
    figure.finishing = [*getattr(figure, "finishing", ()), finish]


# Parts of datasets


def at_each_poisson(dataset: xr.Dataset) -> list[xr.Dataset]:
    """Split a dataset by Poisson's ratio, in ascending order."""
    if "poisson" not in dataset.dims:
        return [dataset]
    return [dataset.sel(poisson=nu) for nu in np.sort(dataset["poisson"].values)]


def moving(dataset: xr.Dataset) -> xr.Dataset:
    """Select the velocities above 0."""
    if "velocity" not in dataset.dims:
        return dataset
    return dataset.isel(velocity=dataset["velocity"].values > 0)


def resampled(dataset: xr.Dataset, **coordinates: Any) -> xr.Dataset:
    """Return a certified map at coordinates. Its values outside unsolved cells are converged."""
    fine = dataset.microslip.at(**coordinates).squeeze().assign_attrs(dataset.attrs)
    for name in ("velocity", "amplitude"):
        fine[name].attrs = dataset[name].attrs
    return fine.assign(converged=np.isfinite(fine["mu_macro"]))


def limit(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Return a theoretical limit, on a fine axis if the dataset has one."""
    return dataset[f"{name}_curve"] if f"{name}_curve" in dataset else dataset[name]


def columns(dataset: xr.Dataset, *names: str) -> tuple[np.ndarray, ...]:
    """Return the values of several variables as arrays."""
    return tuple(dataset[name].values for name in names)
