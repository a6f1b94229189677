"""Draw maps over two axes: friction, its change with Poisson's ratio, error estimates, drift
velocity.

`fill` draws each panel: bands, reliable contours, the computed points if there are few, and hatched
cells where there is no result.  Every finite value of a dataset is visible as a colour or a marker.
Information that is omitted from a panel is given outside the panels, in the legend or in a heading.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.path import Path
from scipy.ndimage import maximum_filter
from scipy.spatial import KDTree

from microslip.config.quantities import MU_MACRO
from microslip.datasets.surface import Surface
from microslip.report.figures import curves
from microslip.report.figures import style as look
from microslip.report.selection import (
    at_each_poisson,
    columns,
    limit,
    moving,
    own_title,
    resampled,
    short_title,
)

FEW = 9
"""The points are drawn if an axis has fewer than this number of points."""
POINTS: look.Ink = {"ls": "none", "marker": "o", "ms": 2.6, "color": look.BLACK}
POINTS |= {"mec": "white", "mew": 0.4, "clip_on": False, "label": "computed points"}
BARE: look.Ink = {"marker": "o", "s": 22.0, "edgecolors": look.BLACK, "linewidths": 0.8}
BARE |= {"clip_on": False, "zorder": 6, "gid": "bare-points"}
"""Style of points beside cells without a colour. The colour of such a point shows its value."""
NEAR, FAR = 0.8, 2.5
"""Smallest distances of the number on a contour, divided by the height of the number. NEAR is the
distance from other contours. FAR is the distance from other numbers and from the ends of the same
contour."""
HATCHED: look.Ink = {"fc": (1.0, 1.0, 1.0, 0.45), "ec": look.BLACK, "lw": 0.0, "hatch": 6 * "/"}
REST: look.Ink = {"facecolor": look.PALE, "label": "comes to rest", "gid": "rest"}
THRESHOLD: look.Ink = {"color": look.BLACK, "label": "static limit: threshold", "gid": "mu_static"}
UNCERTAIN = "contours only where certain"
RIGID = "rigid contact, same velocities"

COLUMNS = {1: 1, 2: 2, 4: 2}
"""Number of columns for 1, 2 and 4 maps. Any other number of maps is drawn in 3 columns."""
HEIGHT = {1: 3.6, 2: 2.6, 3: 2.0, 4: 1.75}
"""Height of a row in inches, keyed by the number of columns."""
CUTS = 2.7
"""Height of the panels with cuts below a row of maps, in inches."""
FINE = 193
"""Number of coordinates along each axis at which a certified map is evaluated for drawing."""


class Panel(NamedTuple):
    """A map: its dataset at one Poisson's ratio, the drawn variable, and the heading.

    points: dataset of the computed points, which differs from the map if the map is certified.
    """

    dataset: xr.Dataset
    variable: str
    title: str
    points: xr.Dataset

    @property
    def across(self) -> str:
        """Name of the abscissa."""
        return "force" if self.variable == "velocity" else "velocity"


def draw(*datasets: xr.Dataset) -> Figure:
    """Draw the maps of one or several sweeps.

    A sweep at several Poisson's ratios has a map at the smallest ratio, and maps of the change of
    friction at larger ratios.  A certified map has a panel with its error estimates.  If the map
    comes from a single, uncertified sweep of friction, cuts along two edges of the map are added.
    """
    titles = map(short_title if datasets[1:] else own_title, datasets)
    rows = list(map(_panels, datasets, map(look.literal, titles)))
    drawn = [panel for row in rows for panel in row]
    widths = {len(row) for row in rows}
    aligned = len(widths) == 1 and widths < {2, 3, 4}
    across = len(rows[0]) if aligned else COLUMNS.get(len(drawn), 3)
    height = HEIGHT[across] * -(-len(drawn) // across) + 0.35
    if len(datasets) > 1 or drawn[-1].variable not in ("mu_macro", "mu_macro_change"):
        figure = look.new_figure(look.DOUBLE if across > 1 else 0.65 * look.DOUBLE, height)
        _fill(figure, drawn, across)
        return figure
    beside = len(drawn) == 1
    figure = look.new_figure(look.DOUBLE, 4.2 if beside else height + CUTS)
    split: Any = {"width_ratios": (1.3, 1.0)} if beside else {"height_ratios": (height, CUTS)}
    page, side = figure.subfigures(*((1, 2) if beside else (2, 1)), squeeze=False, **split).flat
    _fill(page, drawn, across)
    parts = at_each_poisson(datasets[0])
    left, top = look.grid(side, 2, 1 if beside else 2)
    curves.cut(left, parts, "amplitude", parts[0]["velocity"][0])
    curves.cut(top, parts, "velocity", parts[0]["amplitude"][-1])
    return figure


def _panels(dataset: xr.Dataset, title: str) -> list[Panel]:
    """Return the panels of a dataset. The title is above the first panel.

    A certified map has two panels, friction and errors at the smallest Poisson's ratio.
    """
    ratios = np.unique(dataset["poisson"].values)

    def headed(part: xr.Dataset, text: str = title) -> str:
        ratio = look.ratio(part) if ratios.size > 1 or ratios[0] else ""
        return ", ".join(filter(None, [text, ratio]))

    if "cell_error" in dataset:
        grid = resampled(dataset, FINE, poisson=ratios[0])
        here = np.broadcast_to(dataset["poisson"] == ratios[0], dataset.sizes["point"])
        points = dataset.assign(converged=dataset["mu_macro"].notnull()).isel(point=here)
        counts = f"{dataset.attrs['points']} points, {dataset.sizes['cell']} cells"
        errors = Panel(grid, "mu_macro_error", headed(grid, counts), points)
        return [Panel(grid, "mu_macro", headed(grid), points), errors]
    if "force" in dataset.dims:
        speed, title = dataset["velocity"], title or look.axis(look.quantity(dataset, "velocity"))
        dataset = dataset.assign(velocity=np.log10(speed.clip(SLOWEST)), rest=speed == 0.0)
        return [Panel(one, "velocity", headed(one, title), one) for one in at_each_poisson(dataset)]
    first, *others = map(moving, at_each_poisson(dataset))
    least = rf"\nu = {float(first['poisson']):g} \to"
    heads = (f"${least} {float(one['poisson']):g}$" for one in others)
    changes = [Panel(one, "mu_macro_change", next(heads), one) for one in others]
    return [Panel(first, "mu_macro", headed(first), first), *changes]


def _fill(page: Any, drawn: list[Panel], across: int) -> None:
    """Draw all maps of a page, with labels, colour bars and a legend."""
    axes: list[Any] = look.grid(page, len(drawn), across)
    # A colour bar can be on the right of each column.
    beside = 0.85 if len({panel.variable for panel in drawn}) == 1 else 1.35
    room = page.get_figure(root=True).get_size_inches()[0] / across - beside
    room = np.inf if len(drawn) == 1 else room
    for one, panel in zip(axes, drawn, strict=True):
        look.heading(one, panel.title, room)
    _label(axes, drawn, across, room)
    for variable in dict.fromkeys(panel.variable for panel in drawn):
        own = [(one, p) for one, p in zip(axes, drawn, strict=True) if p.variable == variable]
        scale = SCALES[variable]([panel.dataset for _, panel in own])
        bands = [fill(one, panel, scale) for one, panel in own]
        rows = len({one.get_subplotspec().rowspan.start for one, _ in own})
        settings: Any = {"ticks": scale.ticks, "aspect": 22 * rows, "pad": 0.03}
        bar = look.colour_bar(bands[0], [one for one, _ in own], scale.label, **settings)
        bar.set_ticklabels([scale.text(tick) for tick in scale.ticks])
    entries: dict[str, Artist] = {}
    for one in axes:
        handles, labels = one.get_legend_handles_labels()
        entries |= dict(zip(labels, handles, strict=True))
    contours = page.findobj(lambda artist: artist.get_gid() == "contours")
    is_there = any(len(path) for one in contours for path in one.get_paths())
    note = "" if is_there or not entries.pop(UNCERTAIN, None) else "no contour is certain"
    if any(panel.variable == "mu_macro_change" for panel in drawn):
        pale = matplotlib.colormaps[DIVERGING](0.5)
        entries["pale"] = Patch(fc=pale, ec=look.GREY, lw=0.5, label="change within the errors")
    points = [panel.points for panel in drawn if panel.variable != "mu_macro_error"]
    flags = np.concatenate([one["converged"].values.ravel() for one in points])
    if bad := np.count_nonzero(flags == 0):
        entries["unconverged"] = Patch(label=f"not converged ({bad} of {flags.size})", **HATCHED)
    ncols = 1 if len(drawn) == 1 else 3
    look.legend_of_figure(page, entries.values(), "lower center", ncols=ncols, title=note)


def _label(axes: list[Axes], drawn: list[Panel], across: int, room: float) -> None:
    """Label the axes. If all panels have the same label and range, the label is written once for
    each column or row. Otherwise, each panel has a label."""
    for name, dims in (("x", [p.across for p in drawn]), ("y", len(drawn) * ["amplitude"])):
        places = [panel.dataset[dim] for panel, dim in zip(drawn, dims, strict=True)]
        ranges = {(float(place.min()), float(place.max())) for place in places}
        quantities = map(look.quantity, (panel.dataset for panel in drawn), dims)
        # On a small panel, a label with a symbol would be longer than the axis.
        texts = [look.axis(one, short=len(drawn) > 2) for one in quantities]
        for index, (one, text) in enumerate(zip(axes, texts, strict=True)):
            outer = index + across >= len(axes) if name == "x" else index % across == 0
            if outer or len(set(texts)) > 1 or len(ranges) > 1:
                wide = look.wrapped(text, room if name == "x" else max(room, 1.5), look.LABEL)
                one.set(**{f"{name}label": wide})


def fill(axes: Axes, panel: Panel, scale: Scale) -> ContourSet:
    """Fill a panel with a variable, interpolated as in `microslip.at`.

    Contours end where the interpolation is too uncertain (see `Surface.supported`). If a contour
    ends in this way, or if the map is coarse, the computed points are drawn as well. Points beside
    a cell without a colour are always drawn. The colour of such a point shows the value at the
    point. Returns the bands for the colour bar.
    """
    shown = panel.dataset.transpose("amplitude", panel.across, ...)
    x, amplitude, values = columns(shown, panel.across, "amplitude", panel.variable)
    surface = Surface(x, amplitude, values)
    grid, ends = (surface.velocity, surface.amplitude), scale.fills[[0, -1]]
    colours: look.Ink = {"cmap": scale.colours, "norm": scale.norm}
    # Values that rounding moves outside the levels would be white.
    filled = axes.contourf(*grid, surface.values.clip(*ends), scale.fills, **colours)
    filled.set(edgecolor="face", linewidth=0.3)  # without white hairlines in a PDF
    complete = True
    if scale.lines.size:
        supported = surface.supported(scale.lines)
        complete = np.ma.count(supported) == np.ma.count(surface.values)
        contours = axes.contour(*grid, supported, scale.lines, **scale.contours())
        if not complete:
            axes.plot([], [], color=look.BLACK, lw=0.7, label=UNCERTAIN)
        contours.set_gid("contours")
        number_contours(axes, contours, filled, scale)
    axes.set(ylim=amplitude[[0, -1]], xlim=x[[0, -1]], gid="map")
    right, top = look.edges(x, panel.across == "velocity"), look.edges(amplitude, False)
    if panel.across == "velocity":
        look.logarithmic(axes)
    else:
        _rest(axes, shown, scale, right, top)
    look.ticks_outside(axes)
    known = np.isfinite(values)
    row, column = np.nonzero(known)
    if panel.variable == "mu_macro_error":
        axes.plot(*columns(panel.points, "velocity", "amplitude"), gid="points", **POINTS)
    elif min(values.shape) < FEW or not (complete and known.all()):
        axes.plot(x[column], amplitude[row], gid="points", **POINTS)
    bare = known & maximum_filter(~known, 3, mode="nearest")
    row, column = np.nonzero(bare)
    axes.scatter(x[column], amplitude[row], c=values[bare].clip(*ends), **colours, **BARE)
    bad = shown["converged"].values == 0
    look.cells(axes, right, top, bad, gid="unconverged", zorder=4, **HATCHED)
    return filled


def number_contours(axes: Axes, contours: ContourSet, filled: ContourSet, scale: Scale) -> None:
    """Write numbers on contours after the layout has determined the final size of the panel.

    A number is placed as far as possible from other contours and from the ends of its own contour,
    because the end of a contour next to a number could be read as a minus sign. If there is no room
    for a number on a contour, the contour has no number. Behind each number is a box in the colour
    of the band, so that the number is readable on top of points.
    """
    height = look.SMALLEST * look.DPI / 72.0

    def write() -> None:
        paths, places = contours.get_paths(), list[np.ndarray]()
        lines = [axes.transData.transform(path.vertices) for path in paths]
        low, high = axes.bbox.get_points() + 2.0 * height * np.array([[1.0], [-1.0]])
        for k, vertices in enumerate(lines):
            line = vertices[((vertices > low) & (vertices < high)).all(axis=1)]
            if not len(line):
                continue
            starts = np.flatnonzero(paths[k].codes == Path.MOVETO)
            ends = vertices[np.concatenate([starts, starts - 1])]
            far = np.vstack([ends, *places])
            near = np.vstack([far, *lines[:k], *lines[k + 1 :]])
            room = np.minimum(KDTree(far).query(line)[0] / FAR, KDTree(near).query(line)[0] / NEAR)
            if room.max() > height:
                places.append(line[room.argmax()])
                (x, y), level = axes.transData.inverted().transform(places[-1]), scale.lines[k]
                ink: look.Ink = {"color": contours.get_edgecolor()[k], "ha": "center"}
                ink |= {"va": "center", "fontsize": look.SMALLEST, "zorder": 5}
                behind = {"facecolor": filled.to_rgba(level), "edgecolor": "none", "pad": 0.4}
                axes.text(x, y, scale.text(level), bbox=behind, **ink)

    look.after_layout(axes.get_figure(root=True), write)


def _rest(axes: Axes, shown: xr.Dataset, scale: Scale, x: np.ndarray, y: np.ndarray) -> None:
    """Draw the region in which a contact under a force comes to rest, and the velocities of a rigid
    contact. Without a closed form, the region consists of cells.

    x, y: edges of the cells around the points.
    """
    if "mu_static" in shown:
        line = limit(shown, "mu_static")
        across = line[line.dims[0]].values
        axes.plot(line.values, across, zorder=4, **THRESHOLD)
        axes.fill_betweenx(across, 0.0, line.values, zorder=3, **REST)
    else:
        look.cells(axes, x, y, shown["rest"].values, zorder=1.5, **REST)
    if "velocity_large_amplitude" in shown:
        force, amplitude, rigid = columns(shown, "force", "amplitude", "velocity_large_amplitude")
        color, ls = look.LIMITS["mu_large_amplitude"]
        ink: look.Ink = {"colors": color, "linestyles": [ls], "linewidths": 1.0}
        axes.contour(force, amplitude, np.log10(rigid), scale.lines, gid="rigid", **ink)
        axes.plot([], [], color=color, ls=ls, lw=1.0, gid="rigid", label=RIGID)


# Scales: colours, contours and ticks of the quantities

BELOW = "Reds_r"
"""Colour map for friction from 0 to -1. At the value 0, this map is as dark as
`style.COLOURMAP`."""
DARK = 0.5
"""Lines are white on a band whose luminance is below this value. On lighter bands, lines are
black."""
BEYOND = 0.01
"""The points have errors, so friction may leave the range from 0 to 1 by at most this distance."""
DIVERGING = "PuOr"
"""Colour map for differences. This map is pale in the middle."""
MOST_BANDS = 12
"""Maximum number of bands on each side of 0 in a map of differences."""
FEW_BANDS = 6
"""Largest number of bands on each side of 0. With more bands, the labels of the two levels next to
0 would overlap."""
SLOWEST = 1e-3
"""Lower end of the scale of velocities."""


class Scale(NamedTuple):
    """Colours and contours of a quantity.

    Attributes
    ----------
    label : str
        Label of the colour bar.
    fills, ticks : ndarray
        Levels of the bands, and ticks of the colour bar, in ascending order.
    text : callable
        Function that formats a level of a contour or a tick.
    lines : ndarray
        Levels of the contours, in ascending order.
    colours : Colormap
        Colours of the values.
    signed : bool
        If True, contours below 0 are dashed.
    """

    label: str
    fills: np.ndarray
    ticks: np.ndarray
    text: Callable[[float], str]
    lines: np.ndarray = np.empty(0)
    colours: Colormap = matplotlib.colormaps[look.COLOURMAP]
    signed: bool = False

    @property
    def norm(self) -> Normalize:
        """Range of the colours."""
        return Normalize(*self.fills[[0, -1]])

    def contours(self) -> look.Ink:
        """Return the colours and the line styles of the contours. The colours contrast with the
        bands."""
        weights = (0.2126, 0.7152, 0.0722, 0.0)  # luminance by Rec. 709
        shades = self.colours(self.norm(self.lines)) @ weights
        return {
            "colors": [*np.where(shades < DARK, "white", "black")],
            "linestyles": ["dashed" if self.signed and one < 0 else "solid" for one in self.lines],
            "linewidths": [1.1 if self.signed and one == 0 else 0.7 for one in self.lines],
        }


def friction(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of friction. The scale covers the range from 0 to 1 and all values of the
    datasets.

    All datasets use the same colours from 0 to 1, except datasets with values above 1.
    """
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    high = max(float(dataset["mu_macro"].max()) for dataset in datasets)
    low = np.floor(10 * low) / 10 if low < -BEYOND else 0.0
    high = np.ceil(10 * high) / 10 if high > 1 + BEYOND else 1.0
    fills, values = (
        np.linspace(low, high, count) for count in (round(20 * (high - low)) + 1, 1024)
    )
    ticks = np.round(fills[np.isclose(np.round(5 * fills), 5 * fills)], 1) + 0.0  # no "-0.0"
    lines = np.linspace(0.1, 0.9, 9 if len(datasets) == 1 else 5)
    lines = np.array([*-lines[::-1], 0.0, *lines]) if low else lines
    above, below = (matplotlib.colormaps[name] for name in (look.COLOURMAP, BELOW))
    shades = ListedColormap(np.where(values[:, None] < 0.0, below(-values), above(values / high)))
    lines = lines[lines > low]
    return Scale(look.FRICTION, fills, ticks, "{:.1f}".format, lines, shades, signed=True)


def change(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale for differences in friction. Differences within twice the tolerance are not
    significant and have the palest colour."""
    most = max(float(np.abs(dataset["mu_macro_change"]).max()) for dataset in datasets)
    errors = [float(dataset["mu_macro_error"].max()) for dataset in datasets]
    allowed = [float(dataset.attrs.get("tolerance", np.nan)) for dataset in datasets]
    step = 2.0 * max(np.where(np.array(allowed) > 0, allowed, np.fmax(errors, 1e-3)))
    step *= max(1, int(np.ceil(most / step / MOST_BANDS)))
    count = max(2, int(np.ceil(most / step)))
    levels = step * np.array([k for k in range(-count, count + 1) if k])
    inner = levels[[count - 1, count]] if count < FEW_BANDS else [0.0]
    label = f"change of {MU_MACRO.math} with $\\nu$\n(dimensionless)"
    ticks, colours = np.array([levels[0], *inner, levels[-1]]), matplotlib.colormaps[DIVERGING]
    return Scale(label, levels, ticks, "{:.3g}".format, colours=colours)


def error(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of error estimates, from 0 to the error of the certified maps."""
    most = [float(dataset["mu_macro_error"].where(np.isfinite).max()) for dataset in datasets]
    most += [dataset.attrs["error"] for dataset in datasets]
    fills = np.linspace(0.0, np.nanmax(most), 101)
    return Scale("error estimate\n(dimensionless)", fills, fills[::25], "{:.3g}".format)


def drift(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of decimal logarithms of velocities, from -3 to 1."""
    fills, lines = np.linspace(np.log10(SLOWEST), 1.0, 17), np.array([-2.0, -1.0, 0.0])
    label = "mean velocity\n(dimensionless)"
    return Scale(label, fills, fills[::4], lambda x: f"${look.number(10**x)}$", lines)


SCALES = {
    "mu_macro": friction,
    "mu_macro_change": change,
    "mu_macro_error": error,
    "velocity": drift,
}
"""Function that returns the scale for each variable."""
