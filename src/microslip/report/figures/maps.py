"""Maps over two axes: friction, its change with Poisson's ratio, error estimates, drift velocity.

Every panel is drawn by `fill`: bands, contours where they are certain, points where they are few,
and hatched cells without a result.  Every finite value of a dataset is visible, as a colour or as a
marker.  What a panel leaves out is an entry of the legend or a heading, outside of the panels.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, TwoSlopeNorm, to_rgb
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator
from scipy.ndimage import maximum_filter
from scipy.spatial import KDTree

from microslip.config.quantities import MU_MACRO
from microslip.datasets.surface import Surface
from microslip.report.figures import curves, panels
from microslip.report.figures import style as look
from microslip.report.figures.panels import at_each_poisson, columns, limit, moving, resampled

FEW = 9
"""The points are drawn if an axis has fewer points than this."""
POINTS: look.Ink = {"ls": "none", "marker": "o", "ms": 3.0, "color": look.BLACK}
POINTS |= {"mec": "white", "mew": 0.4, "clip_on": False, "gid": "points"}
BARE: look.Ink = {"marker": "o", "s": 22.0, "edgecolors": look.BLACK, "linewidths": 0.8}
BARE |= {"clip_on": False, "zorder": 6, "gid": "bare-points"}
"""Points beside cells without a colour. The colour of such a point shows its value."""
OUTLINE = 3.0
"""Width of the outline of a number, in points. Half of this width is outside the digits."""
NEAR, LONG, APART = 0.7, 3.0, 3.0
"""Smallest distances of a number, divided by its height. NEAR: from other contours. NEAR * LONG:
from the ends of its contour. APART: from other numbers."""
HATCHED: look.Ink = {"fc": (1.0, 1.0, 1.0, 0.45), "ec": look.BLACK, "lw": 0.0, "hatch": 6 * "/"}
REST: look.Ink = {"facecolor": look.PALE, "edgecolor": "none", "gid": "rest"}
THRESHOLD: look.Ink = {"color": look.BLACK, "lw": 1.3, "gid": "mu_static"}
RIGID: look.Ink = {"color": look.VERMILLION, "ls": look.DASHED, "lw": 1.0}

COLUMNS = {1: 1, 2: 2, 4: 2}
"""Number of columns for 1, 2 and 4 maps. Any other number of maps is drawn in 3 columns."""
HEIGHT = {1: 3.6, 2: 2.6, 3: 2.0, 4: 1.75}
"""Height of a row in inches, by the number of columns."""
ORDER = (0, 5, 7, 6, 1, 2, 3, 4)
"""Order of the colours in cuts: neighbours differ even if their markers cover each other."""
FINE = 193
"""Number of coordinates along each axis of a certified map that is drawn."""


class Panel(NamedTuple):
    """A map: the dataset at one Poisson's ratio, the variable that is drawn, and the heading.

    points: velocities and amplitudes of the computed points of a certified map, else None.
    """

    dataset: xr.Dataset
    variable: str
    title: str
    points: xr.Dataset | None = None

    @property
    def across(self) -> str:
        """Name of the abscissa."""
        return "force" if self.variable == "velocity" else "velocity"


def draw(*datasets: xr.Dataset) -> Figure:
    """Draw the maps of one or several sweeps.

    A sweep at several Poisson's ratios has a map at the smallest ratio, and maps of the change of
    friction at larger ratios.  A certified map has a panel with its error estimates.  A figure of
    one other sweep of friction has cuts along two edges of the map.
    """
    rows = [_panels(dataset, len(datasets) > 1) for dataset in datasets]
    drawn = [panel for row in rows for panel in row]
    variables = [panel.variable for panel in rows[0]]
    aligned = len(variables) in (2, 3, 4)
    aligned &= all([one.variable for one in row] == variables for row in rows)
    across = len(variables) if aligned else COLUMNS.get(len(drawn), 3)
    height = HEIGHT[across] * -(-len(drawn) // across) + 0.35
    if len(datasets) > 1 or drawn[-1].variable not in ("mu_macro", "mu_macro_change"):
        figure = look.new_figure(look.DOUBLE if across > 1 else 0.65 * look.DOUBLE, height)
        _fill(figure, drawn, across, aligned)
        return figure
    beside = len(drawn) == 1
    figure = look.new_figure(look.DOUBLE, 4.2 if beside else height + 2.7)
    split: Any = {"width_ratios": (1.3, 1.0)} if beside else {"height_ratios": (height, 2.7)}
    page, side = figure.subfigures(*((1, 2) if beside else (2, 1)), squeeze=False, **split).flat
    _fill(page, drawn, across, aligned)
    parts = at_each_poisson(datasets[0])
    left, top = panels.grid(side, 2, 1 if beside else 2)
    _cut(left, parts, "amplitude", parts[0]["velocity"][0])
    _cut(top, parts, "velocity", parts[0]["amplitude"][-1])
    return figure


def _panels(dataset: xr.Dataset, titled: bool) -> list[Panel]:
    """Return the panels of a dataset. titled: True to write its title above them."""
    title = look.literal(dataset.attrs.get("title", "")) if titled else ""
    if "cell_error" in dataset:
        return _certified(dataset, title)
    parts = at_each_poisson(dataset)
    if "force" in dataset.dims:
        title = title or look.axis(look.quantity(dataset, "velocity"))
        slow = [part.assign(velocity=np.log10(part["velocity"].clip(SLOWEST))) for part in parts]
        return [Panel(one, "velocity", _joined(title, look.ratio(one))) for one in slow]
    first, *others = map(moving, parts)
    ratio = look.ratio(first) if others or float(first["poisson"]) else ""
    less = f"less ${float(first['poisson']):g}$"
    return [
        Panel(first, "mu_macro", _joined(title, ratio)),
        *(Panel(one, "mu_macro_change", f"{look.ratio(one)} {less}") for one in others),
    ]


def _joined(*texts: str) -> str:
    return ", ".join(filter(None, texts))


def _certified(dataset: xr.Dataset, title: str) -> list[Panel]:
    """Return two panels of a certified map at its smallest Poisson's ratio: friction and errors."""
    ends = {dim: (float(dataset[dim].min()), float(dataset[dim].max())) for dim in curves.PLANE}
    deep = "poisson" in dataset.coords and dataset["poisson"].ndim > 0
    nu = float(dataset["poisson"].min())
    grid = resampled(
        dataset,
        velocity=np.geomspace(*ends["velocity"], FINE).clip(*ends["velocity"]),
        amplitude=np.linspace(*ends["amplitude"], FINE),
        poisson=nu,
    )
    ratio = look.ratio(grid) if deep or nu else ""
    points = dataset.isel(point=dataset["poisson"].values == nu) if deep else dataset
    counts = f"{dataset.attrs['points']} points, {dataset.sizes['cell']} cells"
    return [
        Panel(grid, "mu_macro", _joined(title, ratio)),
        Panel(grid, "mu_macro_error", _joined(counts, ratio), points),
    ]


def _fill(page: Any, drawn: list[Panel], across: int, aligned: bool) -> None:
    """Draw all maps of a page, with labels, colour bars and a legend."""
    axes, rows = panels.grid(page, len(drawn), across), -(-len(drawn) // across)
    room = page.get_figure(root=True).get_size_inches()[0] / across - 0.85
    room = np.inf if len(drawn) == 1 else room
    for one, panel in zip(axes, drawn, strict=True):
        panels.heading(one, panel.title, room)
    _label(axes, drawn, across, room)
    entries: dict[str, Artist] = {}
    variables = list(dict.fromkeys(panel.variable for panel in drawn))
    shared = aligned or len(variables) == 1
    for variable in variables:
        own = [(one, p) for one, p in zip(axes, drawn, strict=True) if p.variable == variable]
        scale = SCALES[variable]([panel.dataset for _, panel in own])
        bands = [fill(one, panel, scale, entries) for one, panel in own]
        places = [one for one, _ in own]
        for group in [places] if shared else [[one] for one in places]:
            height = rows if len(group) > 1 else 1
            settings: Any = {"ticks": scale.ticks, "aspect": 22 * height, "pad": 0.03}
            bar = panels.colour_bar(bands[places.index(group[0])], group, scale.label, **settings)
            bar.set_ticklabels([scale.text(tick) for tick in scale.ticks])
    for one in axes:
        if not shared and across > 2 and one.get_xscale() == "log":  # beside colour bars
            one.xaxis.set_major_locator(LogLocator(numticks=4))
    flags = [panel.dataset["converged"].values for panel in drawn]
    if bad := sum(np.count_nonzero(one == 0) for one in flags):
        label = f"not converged ({bad} of {sum(one.size for one in flags)})"
        entries["unconverged"] = Patch(label=label, **HATCHED)
    ncols = 1 if len(drawn) == 1 else 3
    panels.legend_of_figure(page, entries.values(), "lower center", ncols=ncols)


def _label(axes: list[Axes], drawn: list[Panel], across: int, room: float) -> None:
    """Label the axes: once in each column and row if all panels have the same label, else on each
    panel."""
    for name, dims in (("x", [p.across for p in drawn]), ("y", len(drawn) * ["amplitude"])):
        quantities = [look.quantity(p.dataset, dim) for p, dim in zip(drawn, dims, strict=True)]
        # With the symbol, a label is longer than the axis of a small panel.
        texts = [look.axis(one, short=len(drawn) > 2) for one in quantities]
        for index, (one, text) in enumerate(zip(axes, texts, strict=True)):
            outer = index + across >= len(axes) if name == "x" else index % across == 0
            if outer or len(set(texts)) > 1:
                wide = look.wrapped(text, room if name == "x" else max(room, 1.5), look.LABEL)
                one.set(**{f"{name}label": wide})


def fill(axes: Axes, panel: Panel, scale: Scale, entries: dict[str, Artist]) -> ContourSet:
    """Fill a panel with a variable, interpolated as in `microslip.at`.

    Contours end where the interpolation is too uncertain, see `Surface.supported`. In this case,
    and on coarse maps, the computed points are drawn as well. Points beside a cell without a colour
    are always drawn, in the colour of their value.

    entries: legend entries by name, to which those of the panel are added. Returns the bands, for a
    colour bar.
    """
    shown = panel.dataset.transpose("amplitude", panel.across, ...)
    x, amplitude, values = columns(shown, panel.across, "amplitude", panel.variable)
    surface = Surface(x, amplitude, values)
    grid, ends = (surface.velocity, surface.amplitude), scale.fills[[0, -1]]
    colours: look.Ink = {"cmap": scale.colours, "norm": scale.norm}
    # Values that are outside the levels due to rounding would be white.
    filled = axes.contourf(*grid, surface.values.clip(*ends), scale.fills, **colours)
    filled.set(edgecolor="face", linewidth=0.3)  # without white hairlines in a PDF
    complete = True
    if scale.lines.size:
        supported = surface.supported(scale.lines)
        complete = np.ma.count(supported) == np.ma.count(surface.values)
        contours = axes.contour(*grid, supported, gid="contours", **scale.contours())
        contours.set_gid("contours")
        number_contours(axes, contours, filled, scale)
    axes.set(ylim=amplitude[[0, -1]], xlim=x[[0, -1]], gid="map")
    if panel.across == "velocity":
        panels.logarithmic(axes)
    else:
        _rest(axes, shown, scale, entries)
    panels.ticks_outside(axes)
    known = np.isfinite(values)
    row, column = np.nonzero(known)
    places: tuple = (x[column], amplitude[row])
    few = min(values.shape) < FEW or not (complete and known.all())
    size = 3.0
    if panel.points is not None:
        few, size, places = True, 2.2, columns(panel.points, "velocity", "amplitude")
    if few:
        axes.plot(*places, **POINTS | {"ms": size})
    if few and not (complete and "points" in entries):
        note = "" if complete else "; contours only where certain"
        entries["points"] = Line2D([], [], label=f"computed points{note}", **POINTS)
    bare = known & maximum_filter(~known, 3, mode="nearest")
    row, column = np.nonzero(bare)
    axes.scatter(x[column], amplitude[row], c=values[bare].clip(*ends), **colours, **BARE)
    right, top = panels.edges(x, panel.across == "velocity"), panels.edges(amplitude, False)
    bad = shown["converged"].values == 0
    panels.cells(axes, right, top, bad, gid="unconverged", zorder=4, **HATCHED)
    return filled


def number_contours(axes: Axes, contours: ContourSet, filled: ContourSet, scale: Scale) -> None:
    """Write numbers on contours after the layout has given the panel its final size.

    A number is placed as far as possible from other contours and from the ends of its own contour.
    Beside a number, the end of a contour could be read as a minus sign. A contour without enough
    space has no number. Numbers are outlined in the colour of their band, so that they can be read
    above points.
    """
    height = look.SMALLEST * look.DPI / 72.0

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
            others = lines[:k] + lines[k + 1 :]
            obstacles = ([ends], NEAR * LONG), (others, NEAR), (places, APART)
            room = np.min(
                [KDTree(np.vstack(them)).query(line)[0] / far for them, far in obstacles if them],
                axis=0,
            )
            if room.max() > height:
                places.append(line[room.argmax()])
        if places:
            texts = {level: scale.text(level) for level in scale.lines}
            ink: look.Ink = {"fmt": texts, "fontsize": look.SMALLEST, "inline_spacing": 2}
            ink |= {"manual": axes.transData.inverted().transform(places).tolist()}
            levels = {text: level for level, text in texts.items()}
            for text in axes.clabel(contours, **ink):
                behind = filled.to_rgba(np.array(levels[text.get_text()]))
                text.set_path_effects([withStroke(linewidth=OUTLINE, foreground=behind)])

    panels.after_layout(axes.get_figure(root=True), write)


def _rest(axes: Axes, shown: xr.Dataset, scale: Scale, entries: dict[str, Artist]) -> None:
    """Draw where a contact under a force comes to rest, and a rigid contact."""
    if "mu_static" in shown:
        line = limit(shown, "mu_static")
        across = line[line.dims[0]].values
        axes.fill_betweenx(across, 0.0, line.values, zorder=3, **REST)
        axes.plot(line.values, across, zorder=4, **THRESHOLD)
        entries["limit"] = Line2D([], [], label="static limit: threshold", **THRESHOLD)
        entries["rest"] = Patch(label="comes to rest", **REST)
    if "velocity_large_amplitude" in shown:
        force, amplitude, rigid = columns(shown, "force", "amplitude", "velocity_large_amplitude")
        ink: look.Ink = {"colors": RIGID["color"], "linestyles": [RIGID["ls"]], "linewidths": 1.0}
        axes.contour(force, amplitude, np.log10(rigid), scale.lines, gid="rigid", **ink)
        label = "rigid contact, same velocities"
        entries["rigid"] = Line2D([], [], label=label, gid="rigid", **RIGID)


def _cut(axes: Axes, parts: Sequence[xr.Dataset], dim: str, at: xr.DataArray) -> None:
    """Draw friction along an edge of a map, with the closed forms for this edge.

    dim: the axis along the edge. at: coordinate of the edge on the other axis.
    """
    other = str(at.name)
    symbol, value = look.symbol(parts[0], other), float(at)
    forms = [
        form
        for form in curves.closed_forms(parts[0])
        if dim in form.arguments and (dim == "velocity" or len(form.arguments) == 1)
    ]
    for form in forms:
        curves.closed_form(axes, parts, form, **{other: value})
    note = f"top edge, {look.conditions([(symbol, value)])}"
    if dim == "amplitude":
        mark = " markers:" if forms and value > 0 else ""
        note = note.replace("top edge,", f"left edge,{mark}")
        note += f",\nlines: limit for ${symbol} \\to 0$" if mark else ""
    for index, part in enumerate(parts):
        ink: look.Ink = {"label": "computed"}
        if len(parts) > 1:
            color, marker, _ = look.LINES[ORDER[index % len(ORDER)]]
            # Later markers are smaller and in front, so that all markers at one place can be seen.
            size = 3.2 + min(1.3, 3.9 / len(parts)) * (len(parts) - 1 - index)
            ink = {"label": f"computed, {look.ratio(part)}"}
            ink |= {"color": color, "marker": marker, "ms": size}
        points = (moving(part) if dim == "velocity" else part).sel({other: at})
        names = (dim, "mu_macro", "mu_macro_error", "converged")
        panels.computed(axes, *columns(points, *names), clip_on=False, **ink)
    panels.legend_above(axes, note)
    panels.unit_range(axes)
    axes.set(xlabel=look.axis(look.quantity(parts[0], dim)), ylabel=look.FRICTION)
    axes.margins(x=0.0)
    if dim == "velocity":
        panels.logarithmic(axes, points[dim].values[[0, -1]])


# Scales: colours, contours and ticks of the quantities

BELOW = (
    "#00224E", "#24204A", "#371D46", "#471B43", "#571941", "#671840", "#77183F",
    "#871C3E", "#97243D", "#A72E3B", "#B7393B", "#C9463C", "#E05846", "#ED6E59",
    "#F07F6A", "#F18E7A", "#F29D8A", "#F4AE9C", "#F6BEAF", "#F6CEC1", "#F5DED3",
)  # fmt: skip
"""Colours of friction 0, -0.05, ..., -1. They start at the first colour of `style.COLOURMAP`, have
equal distances in CIELAB, and become lighter away from 0. From 0 to -0.5, they differ from all
colours of `style.COLOURMAP` for all common kinds of colour vision."""
DARK = 0.5
"""Lines are white on bands with a luminance below this value, and black on all others."""
BEYOND = 0.01
"""Largest excess below 0 or above 1 that is attributed to the errors of the points."""
DIVERGING = "PuOr"
"""Colour map of differences. It is pale in the middle."""
MOST_BANDS = 12
"""Maximum number of bands on each side of 0 in a map of differences."""
FEW_BANDS = 6
"""With more bands on each side of 0, the labels of the two levels next to 0 would overlap."""
SLOWEST = 1e-3
"""Lower end of the scale of velocities."""


@dataclass(frozen=True, eq=False)
class Scale:
    """Colours and contours of a quantity.

    Attributes
    ----------
    label : str
        Label of the colour bar.
    fills, ticks : ndarray
        Levels of the bands, and ticks of the colour bar, in ascending order.
    norm : Normalize
        Range of the colours.
    text : callable
        Function that formats a level of a contour or a tick.
    colours : Colormap
        Colours of the values.
    lines : ndarray
        Levels of the contours, in ascending order.
    signed : bool
        True to dash the contours below 0.
    """

    label: str
    fills: np.ndarray
    ticks: np.ndarray
    norm: Normalize
    text: Callable[[float], str] = "{:.1f}".format
    colours: Colormap = field(default_factory=lambda: matplotlib.colormaps[look.COLOURMAP])
    lines: np.ndarray = field(default_factory=lambda: np.empty(0))
    signed: bool = False

    def contours(self) -> look.Ink:
        """Return levels, colours that contrast with the bands, and styles of the contours."""
        weights = (0.2126, 0.7152, 0.0722)  # luminance by Rec. 709
        shades = [np.dot(weights, to_rgb(self.colours(self.norm(level)))) for level in self.lines]
        return {
            "levels": self.lines,
            "colors": ["white" if luminance < DARK else "black" for luminance in shades],
            "linestyles": ["dashed" if self.signed and one < 0 else "solid" for one in self.lines],
            "linewidths": [1.1 if self.signed and one == 0 else 0.7 for one in self.lines],
        }


def friction(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of friction: 0 to 1, extended to the smallest and the largest value.

    The colours for 0 to 1 are the same for all datasets, unless the largest value is above 1.
    """
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    high = max(float(dataset["mu_macro"].max()) for dataset in datasets)
    low = np.floor(10 * low) if low < -BEYOND else 0.0
    high = np.ceil(10 * high) if high > 1 + BEYOND else 10.0
    fills = np.linspace(low / 10, high / 10, round(2 * (high - low)) + 1)
    ticks = fills[np.isclose(np.round(5 * fills), 5 * fills)]
    lines = np.linspace(0.1, 0.9, 9 if len(datasets) == 1 else 5)
    if not low:
        return Scale(look.FRICTION, fills, ticks, Normalize(0.0, high / 10), lines=lines)
    lines = np.array([*-lines[::-1], 0.0, *lines])
    shades = np.linspace(0.0, 1.0, 201)
    below = LinearSegmentedColormap.from_list("below", BELOW)(shades[:0:-1])
    colours = [*below, *matplotlib.colormaps[look.COLOURMAP](shades)]
    return Scale(
        *(look.FRICTION, fills, ticks, TwoSlopeNorm(0.0, -1.0, high / 10)),
        colours=LinearSegmentedColormap.from_list("signed", colours, N=1024),
        lines=lines[lines > fills[0]],
        signed=True,
    )


def change(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of differences of friction. Differences within twice the tolerance are not
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
    ticks, norm = np.array([levels[0], *inner, levels[-1]]), Normalize(*levels[[0, -1]])
    return Scale(label, levels, ticks, norm, "{:.3g}".format, matplotlib.colormaps[DIVERGING])


def error(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of error estimates, from 0 to the error of the certified maps."""
    most = [float(dataset["mu_macro_error"].where(np.isfinite).max()) for dataset in datasets]
    most += [dataset.attrs["error"] for dataset in datasets]
    fills, label = np.linspace(0.0, np.nanmax(most), 101), "error estimate\n(dimensionless)"
    return Scale(label, fills, fills[::25], Normalize(0.0, fills[-1]), "{:.2g}".format)


def drift(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of decimal logarithms of velocities, from -3 to 1."""
    fills, lines = np.linspace(np.log10(SLOWEST), 1.0, 17), np.array([-2.0, -1.0, 0.0])
    label, norm = "mean velocity\n(dimensionless)", Normalize(*fills[[0, -1]])
    return Scale(label, fills, fills[::4], norm, lambda x: f"${look.number(10**x)}$", lines=lines)


SCALES = {
    "mu_macro": friction,
    "mu_macro_change": change,
    "mu_macro_error": error,
    "velocity": drift,
}
"""Function that makes the scale of each variable."""
