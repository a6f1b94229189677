"""Maps over two axes: friction, its change with Poisson's ratio, error estimates, drift velocity.

Every panel is drawn by `fill`: bands, contours where they are certain, points where they are few,
and hatched cells without a result.  Every finite value of a dataset is visible, as a colour or as a
marker.  What a panel leaves out is an entry of the legend or a heading, outside of the panels.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.path import Path
from matplotlib.patheffects import withStroke
from matplotlib.ticker import LogLocator
from scipy.ndimage import maximum_filter
from scipy.spatial import KDTree

from microslip.datasets.surface import Surface
from microslip.report.figures import curves, panels
from microslip.report.figures import style as look
from microslip.report.figures.data import at_each_poisson, columns, limit, moving
from microslip.report.figures.scales import SCALES, Scale

FEW = 9
"""The points are drawn if an axis has fewer points than this."""
POINTS: look.Ink = {"ls": "none", "marker": "o", "ms": 3.0, "color": look.BLACK}
POINTS |= {"mec": "white", "mew": 0.4, "clip_on": False, "gid": "points"}
BARE: look.Ink = {"marker": "o", "s": 22.0, "edgecolors": look.BLACK, "linewidths": 0.8}
BARE |= {"clip_on": False, "zorder": 6, "gid": "bare-points"}
"""Points beside cells without a colour. The colour of such a point shows its value."""
OUTLINE = 3.0
"""Width of the outline of a number, in points. Half of this width is outside the digits."""
LONG = 3.0
"""Distance of a number from the ends of its contour, divided by its distance from other
contours."""
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
    has_cuts = len(datasets) == 1 and drawn[-1].variable in ("mu_macro", "mu_macro_change")
    height = HEIGHT[across] * -(-len(drawn) // across) + 0.35
    if not has_cuts:
        figure = look.new_figure(look.DOUBLE if across > 1 else 0.65 * look.DOUBLE, height)
        page: Any = figure
    elif len(drawn) == 1:
        figure = look.new_figure(look.DOUBLE, 4.2)
        page, side = figure.subfigures(1, 2, width_ratios=(1.3, 1.0), squeeze=False).flat
    else:
        figure = look.new_figure(look.DOUBLE, height + 2.7)
        page, side = figure.subfigures(2, 1, height_ratios=(height, 2.7), squeeze=False).flat
    _fill(page, panels.grid(page, len(drawn), across), drawn, across, aligned)
    if has_cuts:
        parts = at_each_poisson(datasets[0])
        left, top = panels.grid(side, 2, 1 if len(drawn) == 1 else 2)
        _cut(left, parts, "amplitude", parts[0]["velocity"][0])
        _cut(top, parts, "velocity", parts[0]["amplitude"][-1])
    return figure


def _panels(dataset: xr.Dataset, titled: bool) -> list[Panel]:
    """Return the panels of a dataset. titled: True to write its title above them."""
    title = look.literal(dataset.attrs.get("title", "")) if titled else ""
    if "cell_error" in dataset:
        return _certified(dataset, title)
    if "force" in dataset.dims:
        return [
            Panel(one, "velocity", _joined(title or look.axis(look.quantity(one, "velocity")), one))
            for one in at_each_poisson(dataset)
        ]
    parts = at_each_poisson(dataset)
    first, *others = parts
    titles = [
        _joined(title, first) if others or float(first["poisson"]) else title,
        *(f"{look.ratio(one)} less ${float(first['poisson']):g}$" for one in others),
    ]
    variables = ["mu_macro", *len(others) * ["mu_macro_change"]]
    return [Panel(*one) for one in zip(parts, variables, titles, strict=True)]


def _joined(title: str, dataset: xr.Dataset) -> str:
    """Return a title with the Poisson's ratio of the dataset."""
    return ", ".join(filter(None, (title, look.ratio(dataset))))


def _certified(dataset: xr.Dataset, title: str) -> list[Panel]:
    """Return two panels of a certified map at its smallest Poisson's ratio: friction and errors."""
    ends = {dim: (float(dataset[dim].min()), float(dataset[dim].max())) for dim in curves.PLANE}
    deep = "poisson" in dataset.coords and dataset["poisson"].ndim > 0
    nu = float(dataset["poisson"].min())
    grid = dataset.microslip.at(
        velocity=np.geomspace(*ends["velocity"], FINE).clip(*ends["velocity"]),
        amplitude=np.linspace(*ends["amplitude"], FINE),
        poisson=nu,
    )
    about = {name: dataset.attrs[name] for name in ("motion", "error")}
    grid = grid.assign(converged=np.isfinite(grid["mu_macro"])).assign_attrs(about)
    for dim in curves.PLANE:
        grid[dim].attrs = dataset[dim].attrs
    at = look.ratio(grid) if deep or nu else ""
    points = dataset.isel(point=dataset["poisson"].values == nu) if deep else dataset
    counts = f"{dataset.attrs['points']} points, {dataset.sizes['cell']} cells"
    titles = [", ".join(filter(None, one)) for one in ((title, at), (counts, at))]
    return [
        Panel(grid, "mu_macro", titles[0]),
        Panel(grid, "mu_macro_error", titles[1], points[[*curves.PLANE]]),
    ]


def _fill(page: Any, axes: list[Axes], drawn: list[Panel], across: int, aligned: bool) -> None:
    """Draw all maps of a page, with labels, colour bars and a legend."""
    groups: dict[str, list[tuple[Axes, ContourSet]]] = {}
    of_variable: dict[str, list[xr.Dataset]] = {}
    for panel in drawn:
        of_variable.setdefault(panel.variable, []).append(panel.dataset)
    scales = {name: SCALES[name](every) for name, every in of_variable.items()}
    entries: dict[str, Artist] = {}
    room = page.get_figure(root=True).get_size_inches()[0] / across - 0.85
    room = np.inf if len(drawn) == 1 else room
    for one, panel in zip(axes, drawn, strict=True):
        filled, handles = fill(one, panel, scales[panel.variable])
        for name, handle in handles.items():  # the longest label of each kind
            known = entries.setdefault(name, handle)
            if len(str(handle.get_label())) > len(str(known.get_label())):
                entries[name] = handle
        groups.setdefault(panel.variable, []).append((one, filled))
        panels.heading(one, panel.title, room)
    _label(axes, drawn, across, room)
    shared = aligned or len(scales) == 1
    for one in axes:
        if not shared and across > 2 and one.get_xscale() == "log":  # beside colour bars
            one.xaxis.set_major_locator(LogLocator(numticks=4))
    for name, group in groups.items():
        for part in [group] if shared else [[one] for one in group]:
            label = scales[name].label
            flat = len(axes) > 1 and -(-len(axes) // across) == 1
            label = label.replace("  (", "\n(") if flat or not shared else label
            rows = 1 if len(part) == 1 else -(-len(axes) // across)
            ticks: Any = {"ticks": scales[name].ticks, "aspect": 22 * rows, "pad": 0.03}
            bar = panels.colour_bar(part[0][1], [one for one, _ in part], label, **ticks)
            bar.set_ticklabels([scales[name].text(tick) for tick in scales[name].ticks])
    if "unconverged" in entries:
        good = [moving(panel.dataset)["converged"].values != 0 for panel in drawn]
        bad = sum(int((~one).sum()) for one in good)
        size = sum(panel.dataset["converged"].size for panel in drawn)
        entries["unconverged"].set_label(f"not converged ({bad} of {size})")
    ncols = 1 if len(drawn) == 1 else 3
    panels.legend_of_figure(page, entries.values(), "lower center", ncols=ncols)


def _label(axes: list[Axes], drawn: list[Panel], across: int, room: float) -> None:
    """Label the axes: once in each column and row if all panels have the same label, else on each
    panel."""
    abscissae = ["force" if panel.variable == "velocity" else "velocity" for panel in drawn]
    for dims, name in ((abscissae, "x"), (len(drawn) * ["amplitude"], "y")):
        every = [look.quantity(p.dataset, dim) for p, dim in zip(drawn, dims, strict=True)]
        if len(drawn) > 2:  # with the symbol, the label is longer than the axis
            every = [replace(one, latex="") if one.unit else one for one in every]
        texts = [look.axis(one) for one in every]
        for index, (one, text) in enumerate(zip(axes, texts, strict=True)):
            outer = index + across >= len(axes) if name == "x" else index % across == 0
            if outer or len(set(texts)) > 1:
                wide = look.wrapped(text, room if name == "x" else max(room, 1.5), look.LABEL)
                one.set(**{f"{name}label": wide})


def fill(axes: Axes, panel: Panel, scale: Scale) -> tuple[ContourSet, dict[str, Artist]]:
    """Fill a panel with a variable, interpolated as in `microslip.at`.

    Contours end where the interpolation is too uncertain, see `Surface.supported`. In this case,
    and on coarse maps, the computed points are drawn as well. Points beside a cell without a colour
    are always drawn, in the colour of their value.

    Returns the bands, for a colour bar, and the legend entries by name.
    """
    is_drift, size = panel.variable == "velocity", look.SMALLEST
    across = "force" if is_drift else "velocity"
    shown = panel.dataset if is_drift else moving(panel.dataset)
    shown = shown.transpose("amplitude", across, ...)
    x, amplitude, values = columns(shown, across, "amplitude", panel.variable)
    if is_drift:
        values = np.log10(np.fmax(values, 10.0 ** scale.fills[0]))
    surface = Surface(x, amplitude, values)
    grid, ends = (surface.velocity, surface.amplitude), scale.fills[[0, -1]]
    colours: look.Ink = {"levels": scale.fills, "cmap": scale.colours, "norm": scale.norm}
    # Values that are outside the levels due to rounding would be white.
    filled = axes.contourf(*grid, np.clip(surface.values, *ends), **colours)
    filled.set(edgecolor="face", linewidth=0.3)  # without white hairlines in a PDF
    complete = True
    if scale.lines.size:
        supported = surface.supported(scale.lines)
        complete = bool(np.ma.count(supported) == np.ma.count(surface.values))
        ink: look.Ink = {"levels": scale.lines, "colors": scale.inks()}
        ink["linestyles"] = [
            "dashed" if one < 0 and not is_drift else "solid" for one in scale.lines
        ]
        ink["linewidths"] = [1.1 if one == 0 and not is_drift else 0.7 for one in scale.lines]
        contours = axes.contour(*grid, supported, **ink)
        contours.set_gid("contours")
        number_contours(axes, contours, filled, scale, size)
    axes.set_ylim(*amplitude[[0, -1]])
    if is_drift:
        axes.set_xlim(*x[[0, -1]])
    else:
        panels.logarithmic(axes, x[[0, -1]])
    panels.ticks_outside(axes)
    axes.set_gid("map")
    handles: dict[str, Artist] = _rest(axes, shown, scale) if is_drift else {}
    row, column = np.nonzero(np.isfinite(values))
    places: tuple = x[column], amplitude[row]
    if panel.points is not None:
        places = columns(panel.points, "velocity", "amplitude")
    if (
        panel.points is not None
        or min(values.shape) < FEW
        or row.size < values.size
        or not complete
    ):
        axes.plot(*places, **POINTS | ({"ms": 2.2} if panel.points is not None else {}))
        note = "" if complete else "; contours only where certain"
        handles["points"] = Line2D([], [], label=f"computed points{note}", **POINTS)
    bare = np.isfinite(values) & maximum_filter(~np.isfinite(values), 3, mode="nearest")
    row, column = np.nonzero(bare)
    ink = {"cmap": scale.colours, "norm": scale.norm, **BARE}
    axes.scatter(x[column], amplitude[row], c=np.clip(values[bare], *ends), **ink)
    good = shown["converged"].values != 0
    if not good.all():
        right, top = panels.edges(x, not is_drift), panels.edges(amplitude, False)
        cells = [
            [(right[k], top[n]) for k, n in ((j, i), (j + 1, i), (j + 1, i + 1), (j, i + 1))]
            for i, j in np.argwhere(~good)
        ]
        hatched = PolyCollection(cells, gid="unconverged", zorder=4, **HATCHED)
        axes.add_collection(hatched, autolim=False)
        handles["unconverged"] = Patch(label="not converged", **HATCHED)
    return filled, handles


def number_contours(
    axes: Axes, contours: ContourSet, filled: ContourSet, scale: Scale, size: float
) -> None:
    """Write numbers on contours after the layout has given the panel its final size.

    A number is placed as far as possible from other contours and from the ends of its own contour.
    Beside a number, the end of a contour could be read as a minus sign. A contour without enough
    space has no number. Numbers are outlined in the colour of their band, so that they can be read
    above points. size: font size in points.
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
            room = KDTree(ends).query(line)[0] / LONG
            if others := [*lines[:k], *lines[k + 1 :]]:
                room = np.fmin(room, KDTree(np.concatenate(others)).query(line)[0])
            if places:
                room[KDTree(places).query(line)[0] < 3.0 * height] = 0.0
            if room.max() > 0.7 * height:
                places.append(line[room.argmax()])
        if places:
            texts = {level: scale.text(level) for level in scale.lines}
            ink: look.Ink = {"fmt": texts, "fontsize": size, "inline_spacing": 2}
            ink |= {"manual": axes.transData.inverted().transform(places).tolist()}
            levels = {text: level for level, text in texts.items()}
            for text in axes.clabel(contours, **ink):
                behind = filled.to_rgba(np.array(levels[text.get_text()]))
                text.set_path_effects([withStroke(linewidth=OUTLINE, foreground=behind)])

    panels.after_layout(axes.get_figure(root=True), write)


def _rest(axes: Axes, shown: xr.Dataset, scale: Scale) -> dict[str, Artist]:
    """Draw where a contact under a force comes to rest, and a rigid contact. Returns the legend
    entries."""
    handles: dict[str, Artist] = {}
    if "mu_static" in shown:
        line = limit(shown, "mu_static")
        across, threshold = line[line.dims[0]].values, line.values
        axes.fill_betweenx(across, 0.0, threshold, zorder=3, **REST)
        axes.plot(threshold, across, zorder=4, **THRESHOLD)
        handles["limit"] = Line2D([], [], label="static limit: threshold", **THRESHOLD)
        handles["rest"] = Patch(label="comes to rest", **REST)
    if "velocity_large_amplitude" in shown:
        force, amplitude, rigid = columns(shown, "force", "amplitude", "velocity_large_amplitude")
        ink: look.Ink = {"colors": RIGID["color"], "linestyles": [RIGID["ls"]], "linewidths": 1.0}
        axes.contour(force, amplitude, np.log10(rigid), scale.lines, gid="rigid", **ink)
        label = "rigid contact, same velocities"
        handles["rigid"] = Line2D([], [], label=label, gid="rigid", **RIGID)
    return handles


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
    note = f"{'left' if dim == 'amplitude' else 'top'} edge, {look.conditions([(symbol, value)])}"
    if dim == "amplitude" and forms and value > 0:
        note = (
            rf"{note.replace('edge,', 'edge, markers:')},{chr(10)}lines: limit for ${symbol} \to 0$"
        )
    for index, part in enumerate(parts):
        ink: look.Ink = {"clip_on": False}
        ratio = f", {look.ratio(part)}" if len(parts) > 1 else ""
        if len(parts) > 1:
            color, marker, _ = look.LINES[ORDER[index % len(ORDER)]]
            # Later markers are smaller and in front, so that all markers at one place can be seen.
            ink |= {
                "color": color,
                "marker": marker,
                "ms": 3.2 + min(1.3, 3.9 / len(parts)) * (len(parts) - 1 - index),
            }
        points = moving(part) if dim == "velocity" else part
        points = points.sel({other: at})
        names = ("mu_macro", "mu_macro_error", "converged")
        x, *values = columns(points, dim, *names)
        panels.computed(axes, x, *values, label=f"computed{ratio}", **ink)
    panels.legend_above(axes, note)
    every = np.concatenate([part["mu_macro"].sel({other: at}).values for part in parts])
    panels.unit_range(axes, np.nanmin(every, initial=0.0), np.nanmax(every, initial=1.0))
    axes.set(xlabel=look.axis(look.quantity(parts[0], dim)), ylabel=look.FRICTION_IN_TWO_LINES)
    axes.margins(x=0.0)
    if dim == "velocity":
        panels.logarithmic(axes, x[[0, -1]])
