"""A panel with a map: bands, contours, computed points, and hatched cells without a result.

Every finite value of the dataset is visible, as a colour or as a marker.  What a panel leaves out
is an entry of its legend, which is drawn outside of the panel.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.contour import ContourSet
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from scipy.ndimage import maximum_filter
from scipy.spatial import KDTree

from microslip.datasets.surface import Surface
from microslip.report.figures import panels, signed
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

FILL_LEVELS = np.linspace(0.0, 1.0, 21)
LINE_LEVELS = np.linspace(0.1, 0.9, 9)
FEW = len(LINE_LEVELS)
"""The points are drawn if an axis has fewer points than this."""
POINTS: look.Ink = {"ls": "none", "marker": "o", "ms": 3.0, "color": look.BLACK}
POINTS |= {"mec": "white", "mew": 0.4, "clip_on": False, "gid": "points"}
BARE: look.Ink = {"marker": "o", "s": 22.0, "edgecolors": look.BLACK, "linewidths": 0.8}
BARE |= {"clip_on": False, "zorder": 6, "gid": "bare-points"}
"""Points beside cells without a colour. Their own colour is that of their value."""
OUTLINE = 3.0
"""Line width of the outline of numbers, in points. Half of the line is outside the digits."""
HATCHED: look.Ink = {"fc": (1.0, 1.0, 1.0, 0.45), "ec": look.BLACK, "lw": 0.0, "hatch": 6 * "/"}


def bands(axes: Axes, *table: np.ndarray, **settings: Any) -> ContourSet:
    """Draw filled contours without white hairlines between the bands in a PDF."""
    filled = axes.contourf(*table, **settings)
    filled.set(edgecolor="face", linewidth=0.3)
    return filled


def number_contours(
    axes: Axes, contours: ContourSet, size: float, filled: ContourSet | None = None
) -> None:
    """Write numbers on contours after the layout has given the panel its final size.

    A number is placed as far as possible from other contours and from the ends of its own contour.
    Beside a number, the end of a contour could be read as a minus sign. A contour without enough
    space has no number.

    Parameters
    ----------
    size : float
        Font size in points.
    filled : ContourSet or None
        Bands behind the contours. Numbers are outlined in the colour of their band, so that they
        can be read above points. If None, there is no outline.
    """
    height = size * look.DPI / 72.0

    def write() -> None:
        paths = contours.get_paths()
        lines = [axes.transData.transform(path.vertices) for path in paths]
        low, high = axes.bbox.get_points() + 2.0 * height * np.array([[1.0], [-1.0]])
        places: list[np.ndarray] = []
        for k, vertices in enumerate(lines):
            line = vertices[((vertices > low) & (vertices < high)).all(axis=1)]
            if not len(line):
                continue
            starts = np.flatnonzero(paths[k].codes == Path.MOVETO)
            ends = vertices[np.concatenate([starts, starts - 1])]
            room, _ = KDTree(np.concatenate([*lines[:k], *lines[k + 1 :], ends])).query(line)
            if places:
                room[KDTree(places).query(line)[0] < 3.0 * height] = 0.0
            if room.max() > 0.7 * height:
                places.append(line[room.argmax()])
        if places:
            ink: look.Ink = {"fmt": "%.1f", "fontsize": size, "inline_spacing": 2}
            ink |= {"manual": axes.transData.inverted().transform(places).tolist()}
            for text in axes.clabel(contours, **ink):
                if filled is not None:
                    behind = filled.to_rgba(np.array(float(text.get_text())))
                    text.set_path_effects([withStroke(linewidth=OUTLINE, foreground=behind)])

    panels.after_layout(axes.get_figure(root=True), write)


def fill(
    axes: Axes,
    dataset: xr.Dataset,
    fills: np.ndarray = FILL_LEVELS,
    lines: np.ndarray = LINE_LEVELS,
    size: float = 7.5,
) -> tuple[ContourSet, list[Artist], int]:
    """Fill a panel with `mu_macro` over velocity and amplitude, interpolated as in `microslip.at`.

    Contours end where the interpolation is too uncertain, see `Surface.supported`. In this case,
    and on coarse maps, the computed points are drawn as well. Points beside a cell without a colour
    are always drawn, in the colour of their value.

    Parameters
    ----------
    fills, lines : ndarray
        Levels of the bands and of the contours (dashed below 0, heavier at 0), ascending.
    size : float
        Font size of the numbers in points.

    Returns
    -------
    tuple
        The bands, for a colour bar; the legend entries; the number of hatched cells.
    """
    shown = dataset.isel(velocity=dataset["velocity"].values > 0)
    shown = shown.transpose("amplitude", "velocity", ...)
    velocity, amplitude, mu = columns(shown, "velocity", "amplitude", "mu_macro")
    surface = Surface(velocity, amplitude, mu)
    colours, norm = signed.scale(fills)
    # Values that are outside the levels due to rounding would be white.
    inside = np.clip(surface.values, fills[0], fills[-1])
    grid = surface.velocity, surface.amplitude
    filled = bands(axes, *grid, inside, levels=fills, cmap=colours, norm=norm)
    dashes = ["dashed" if level < 0 else "solid" for level in lines]
    contours, complete = draw_contours(axes, surface, fills, lines, linestyles=dashes)
    number_contours(axes, contours, size, filled)
    axes.set_ylim(*amplitude[[0, -1]])
    panels.logarithmic(axes, velocity[[0, -1]])
    panels.ticks_outside(axes)
    handles: list[Artist] = []
    if min(mu.shape) < FEW or not (complete and np.isfinite(mu).all()):
        handles.append(draw_points(axes, velocity, amplitude, mu))
        if not complete:
            handles[0].set_label("computed points; contours only where certain")
    draw_bare_points(axes, velocity, amplitude, mu, filled)
    hatched = _hatch(axes, velocity, amplitude, shown["converged"].values != 0)
    if hatched:
        handles.append(Patch(label="not converged", **HATCHED))
    return filled, handles, hatched


def draw_contours(
    axes: Axes, surface: Surface, fills: np.ndarray, lines: np.ndarray, **ink: Any
) -> tuple[ContourSet, bool]:
    """Draw contours where they are reliable. fills: levels of the bands behind them.

    Returns the contours, and whether they are drawn wherever the surface is known.
    """
    supported = surface.supported(lines)
    ink = {"linewidths": [1.1 if level == 0 else 0.7 for level in lines], **ink}
    colours = signed.inks(lines, fills)
    grid = surface.velocity, surface.amplitude
    contours = axes.contour(*grid, supported, levels=lines, colors=colours, **ink)
    contours.set_gid("contours")
    return contours, bool(np.ma.count(supported) == np.ma.count(surface.values))


def draw_points(
    axes: Axes, velocity: np.ndarray, amplitude: np.ndarray, values: np.ndarray
) -> Artist:
    """Draw dots at the points with a finite value. Returns the legend entry."""
    row, column = np.nonzero(np.isfinite(values))
    axes.plot(velocity[column], amplitude[row], **POINTS)
    return Line2D([], [], label="computed points", **POINTS)


def draw_bare_points(
    axes: Axes,
    velocity: np.ndarray,
    amplitude: np.ndarray,
    values: np.ndarray,
    filled: ContourSet,
) -> None:
    """Draw the points beside a cell without a colour, in the colour that `filled` has for them."""
    bare = np.isfinite(values) & maximum_filter(~np.isfinite(values), 3, mode="nearest")
    row, column = np.nonzero(bare)
    ends = np.sort(np.array(filled.levels))[[0, -1]]
    ink: look.Ink = {"cmap": filled.cmap, "norm": filled.norm, **BARE}
    axes.scatter(velocity[column], amplitude[row], c=np.clip(values[bare], *ends), **ink)


def _hatch(axes: Axes, velocity: np.ndarray, amplitude: np.ndarray, converged: np.ndarray) -> int:
    """Hatch the cell around every unconverged point and return the number of cells."""
    x, y = panels.edges(velocity, True), panels.edges(amplitude, False)
    cells = [
        [(x[j], y[i]), (x[j + 1], y[i]), (x[j + 1], y[i + 1]), (x[j], y[i + 1])]
        for i, j in np.argwhere(~converged)
    ]
    axes.add_collection(
        PolyCollection(cells, gid="unconverged", zorder=4, **HATCHED), autolim=False
    )
    return len(cells)
