"""Style of all figures: sizes, fonts, colours, text formats, and parts of panels."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import AbstractContextManager
from html import unescape
from string import ascii_lowercase
from typing import Any

import matplotlib.style
import numpy as np
import xarray as xr
from matplotlib import ticker
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.figure import Figure
from matplotlib.patches import Circle, Rectangle
from matplotlib.textpath import TextPath
from scipy.interpolate import griddata

from microslip.config.quantities import DRIVES, LATERAL, MU_MACRO, TABLE, Quantity
from microslip.foundation import number_text
from microslip.report.selection import is_wide

Ink = dict[str, Any]
"""Keyword arguments of a matplotlib artist."""

SINGLE, DOUBLE = 3.39, 7.09
"""Journal column widths in inches (86 mm and 180 mm)."""

# Colours of Okabe and Ito, which can be distinguished with all common types of colour vision.
BLACK, BLUE, VERMILLION = "#000000", "#0072B2", "#D55E00"
GREEN, ORANGE, PURPLE = "#009E73", "#E69F00", "#CC79A7"
GREY, PALE, SKY = "#6E6E6E", "#D4D4D4", "#56B4E9"

COLOURMAP = "cividis"
"""Colour map for values from 0 to 1, perceptually uniform and readable in grey."""

# Line styles distinguish curves when they are printed without colour.
SOLID = "-"
DASHED = (0, (5.0, 2.0))
DASHDOT = (0, (6.0, 1.6, 1.2, 1.6))
DOTTED = (0, (1.0, 1.6))

COLOURS = BLACK, BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, GREY
STYLES = 2 * (SOLID, DASHED, DASHDOT, DOTTED)
LINES = tuple(zip(COLOURS, "os^DvPX*", STYLES, strict=True))
"""Colour, marker and style of the first, second, ... line in a panel."""


def line(index: int) -> tuple[str, str, Any]:
    """Return the colour, marker and style of a line. The first 64 lines differ in colour or
    marker, and lines of the same colour in style."""
    _, marker, ls = LINES[(index + index // len(LINES)) % len(LINES)]
    return COLOURS[index % len(LINES)], marker, ls


LIMITS: dict[str, tuple[str, Any]] = {
    "mu_large_amplitude": (VERMILLION, DASHED),
    "mu_static_slider": (ORANGE, DASHDOT),
    "mu_static_stick_zone": (GREEN, DASHED),
    "mu_static_stick_zone_printed": (PURPLE, DOTTED),
    "mu_static": (BLUE, SOLID),
    "mu_closed_form": (GREEN, DASHDOT),
    "mu_forward_theory": (BLUE, SOLID),
    "mu_torque_theory": (VERMILLION, DASHED),
}
"""Colour and line style of each closed form, keyed by the name of the variable."""

MODELS = {
    "rigid": (BLACK, "h"),
    "slider": (ORANGE, "<"),
    "dahl": (PURPLE, ">"),
    "mdr": (SKY, "^"),
    "radial": (GREEN, "v"),
    "polar": (BLUE, "o"),
    "cartesian": (VERMILLION, "s"),
}
"""Colour and marker of each contact model, coarsest first."""

SMALLEST, HEADING, LABEL = 7.0, 8.0, 8.5
"""Font sizes in points: the smallest size, the size of panel headings, and the size of axis
labels."""
LONGEST = 100
"""Maximum number of characters of a title from the configuration."""
DPI = 300

RC = {
    "figure.dpi": DPI,  # the layout is computed for the resolution of the PNG file
    "font.size": 8,
    "axes.labelsize": LABEL,
    "axes.titlesize": HEADING,
    "legend.title_fontsize": HEADING,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "legend.labelspacing": 0.35,
    "lines.linewidth": 1.3,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "hatch.linewidth": 0.6,
    "pdf.fonttype": 42,
}
"""Settings that differ from matplotlib's defaults. The default font is kept, because it is the same
on every machine."""

# The label of an axis consists of words, a symbol and a unit. A ratio needs no unit. Any other
# dimensionless quantity is labelled "(dimensionless)".
FRICTION = f"{MU_MACRO.text}  {MU_MACRO.math}\n(dimensionless)"


def style() -> AbstractContextManager[None]:
    """Return a context in which the figures' settings replace the user's settings."""
    return matplotlib.style.context(RC, after_reset=True)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure, with a layout in which panels do not overlap. The size is in
    inches."""
    return Figure(figsize=(width, height), layout="constrained")


def quantity(dataset: xr.Dataset, dim: str) -> Quantity:
    """Return the description of an axis of a dataset. Only drives, Poisson's ratio and the axes of
    the paper have a symbol."""
    own, motion = TABLE.get(dim, {}), dataset.attrs.get("motion", "")
    name = "forward velocity" if dim == "velocity" else dim
    formula = dataset[dim].attrs.get("formula", "") if dim in dataset else ""
    return own.get(motion) or own.get("") or DRIVES.get(dim) or Quantity(name, "", formula)


def symbol(motion: str, dim: str) -> str:
    """Return the LaTeX symbol of an axis for a motion, or the name of the axis if there is no
    symbol."""
    return quantity(xr.Dataset(attrs={"motion": motion}), dim).latex or rf"\mathrm{{{dim}}}"


def axis(one: Quantity, short: bool = False) -> str:
    """Return the label of an axis: words, the symbol, and the ratio that defines the symbol.

    short: if True, omit a symbol that is defined by a ratio.
    """
    ratio = mathtext(one.unit)
    if not one.latex or (short and ratio):
        # A unit with spaces is a ratio, or words that explain the number.
        return f"{one.text}  {ratio if ' ' in one.unit else f'{ratio} (dimensionless)'.strip()}"
    return f"{one.text}  ${one.latex}{' = ' + ratio[1:-1] if ratio else ''}$"


def number(value: float) -> str:
    """Format a number as mathtext with three digits, and with a power of ten if the number is large
    or small."""
    mantissa, _, exponent = f"{value:.3g}".partition("e")
    if not exponent:
        return mantissa
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa}\times {power}"


def prefixed(values: np.ndarray | float, unit: str) -> tuple[float, str]:
    """Return the factor of an SI prefix that suits the values, and the unit with this prefix.

    Without a unit, the factor is 1.
    """
    largest = float(np.max(np.abs(values), initial=0.0)) * (1.0 + 1e-9)
    name, size = number_text.prefixed(largest, unit)
    return (size, name.replace("u", "\N{MICRO SIGN}", 1)) if unit else (1.0, "")


def conditions(motion: str, values: Mapping[str, float]) -> str:
    """Format the values on axes as mathtext, such as "v = 0.1, A = 2". NaN is omitted."""
    finite = {dim: value for dim, value in values.items() if np.isfinite(value)}
    return ", ".join(f"${symbol(motion, dim)} = {number(finite[dim])}$" for dim in finite)


def ratio(dataset: xr.Dataset) -> str:
    """Format the Poisson's ratio of a dataset as mathtext."""
    return conditions("", {"poisson": float(dataset["poisson"])})


def model(name: str) -> tuple[str, str]:
    """Return the colour and the marker of a contact model. An unknown model is grey."""
    return MODELS.get(name, (GREY, "p"))


def in_order(names: set[str]) -> list[str]:
    """Sort the names of contact models, coarsest first. Unknown models come last."""
    return [name for name in MODELS if name in names] + sorted(names - MODELS.keys())


def literal(text: object) -> str:
    """Escape a title from the configuration, so that matplotlib draws it literally.

    Dollar signs are escaped, white space is replaced by single spaces, and a title of more than
    `LONGEST` characters is shortened with an ellipsis.
    """
    plain = "".join(sign if sign.isprintable() else " " for sign in str(text))
    plain = " ".join(plain.split())
    if len(plain) > LONGEST:
        plain = plain[: LONGEST - 1] + "\N{HORIZONTAL ELLIPSIS}"
    return plain.replace("$", r"\$")


def width(text: str, size: float) -> float:
    """Return the width in inches of a string at a font size in points. The string can contain
    mathtext."""
    return TextPath((0, 0), text, size=size).get_extents().width / 72.0


def wrapped(text: str, room: float, size: float) -> str:
    """Break a string into lines that are at most `room` inches wide, at a font size in points.

    Lines are broken at spaces outside mathtext, and inside words that are wider than a line.
    """
    lines = [""]
    for word in re.findall(r"(?:\\\$|\$(?:\\\$|[^$])*\$|[^\s$])+|\$", text):
        fits = re.search(r"(?<!\\)\$", word) or width(word, size) <= room
        for index, part in enumerate([word] if fits else re.findall(r"\\\$|.", word)):
            longer = lines[-1] + ("" if index or not lines[-1] else " ") + part
            if lines[-1] and width(longer, size) > room:
                lines.append(part)
            else:
                lines[-1] = longer
    return "\n".join(lines)


def letter(index: int) -> str:
    """Return the letter of a panel: a, b, ..., z, aa, ab, ..."""
    return (letter(index // 26 - 1) if index >= 26 else "") + ascii_lowercase[index % 26]


# Formulas in plain text, such as "v0 / (omega u_lim)"

GREEK = {
    name: rf"\{name}" for name in ("alpha", "beta", "delta", "kappa", "mu", "nu", "omega", "Omega")
} | {"phi": r"\varphi", "theta": r"\vartheta"}
"""LaTeX commands of Greek letters, keyed by the name of the letter."""

_WORD = re.compile(r"([A-Za-z]+)(\d*)(?:_([A-Za-z0-9]+))?")


def mathtext(formula: str) -> str:
    """Convert a formula to mathtext. If the formula contains words, only the symbols are converted.

    A symbol is a letter or the name of a Greek letter, with an optional number or index: x, v0,
    u_lim, phi_lk. Other sequences of letters are words.
    """
    if any(not _symbol(match) for match in _WORD.finditer(formula)):
        return _WORD.sub(_in_words, formula)
    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(_symbol, formula).strip())
    text = re.sub(r"\s+", r"\\,", text)
    return f"${text}$" if text else ""


def html(formula: str) -> str:
    """Convert a formula to HTML with italic letters and subscripts."""

    def symbol(match: re.Match[str]) -> str:
        letters, number, index = match.groups()
        below = number + (index or "")
        letter = unescape(f"&{letters};") if letters in GREEK else letters
        return f"<i>{letter}</i>" + (f"<sub>{below}</sub>" if below else "")

    text = re.sub(r"\s*([/()])\s*", r"\1", _WORD.sub(symbol, formula))
    return text.replace("</sub> <i>", "</sub><i>").replace("</i> <i>", " ")


def _symbol(match: re.Match[str]) -> str:
    """Return the LaTeX symbol for a match of the pattern _WORD, or "" if the match is a word."""
    letters, number, index = match.groups()
    if letters not in GREEK and len(letters) > 1:
        return ""
    base = GREEK.get(letters, letters)
    below = number + (rf"\mathrm{{{index}}}" if index else "")
    return f"{base}_{{{below}}}" if below else base


def _in_words(match: re.Match[str]) -> str:
    # A single letter can be a word, such as an article.
    plain = len(match[0]) == 1 or not _symbol(match)
    return match[0] if plain else f"${_symbol(match)}$"


# Parts of panels

VISIBLE_ERROR = 0.01
"""Smallest error estimate that is drawn, as a fraction of the largest value. Smaller error bars
would be hidden by the markers."""
PIXELS = 401
"""Number of pixels along each side of a contact's image."""


def grid(figure: Any, count: int, across: int, **shared: Any) -> list[Axes]:
    """Return a list of new panels. `count` is the number of panels, `across` is the number of
    panels in a row, and `shared` contains arguments of `subplots`."""
    axes = list(figure.subplots(-(-count // across), across, squeeze=False, **shared).flat)
    for empty in axes[count:]:
        empty.remove()
    return axes[:count]


def lettered(axes: Axes, note: str = "") -> str:
    """Return the heading of a panel: the next letter in the figure, bold and in brackets, followed
    by an optional note."""
    figure: Any = axes.get_figure(root=True)
    figure.letters = getattr(figure, "letters", -1) + 1
    return rf"$\bf{{({letter(figure.letters)})}}$" + (rf"$\;$ {note}" if note else "")


def heading(axes: Axes, note: str = "", room: float = np.inf) -> None:
    """Write a letter and a note above a panel, in lines that are at most `room` inches wide."""
    lines = lettered(axes, note).split("\n")
    text = "\n".join(wrapped(line, room, HEADING) for line in lines)
    axes.set_title(text, loc="left", y=1.0, pad=5)


def legend_above(axes: Axes, note: str = "", **more: Any) -> None:
    """Write a letter, a note and a legend above a panel. `more` contains arguments of `legend`."""
    place: Ink = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.02), "alignment": "left"}
    place |= {"handletextpad": 0.6, "columnspacing": 0.8, "borderaxespad": 0.0, "borderpad": 0.0}
    # The title is also drawn if the legend is empty.
    place |= {"handles": axes.get_legend_handles_labels()[0], "ncols": 2}
    axes.legend(title=lettered(axes, note), **place | more)


def legend_of_figure(figure: Any, handles: Iterable, where: str, ncols: int, **more: Any) -> None:
    """Add one legend outside the panels."""
    if entries := list(handles):
        place = {"loc": f"outside {where}", "columnspacing": 1.6}
        figure.legend(handles=entries, ncols=ncols, **place, **more)


def colour_bar(shown: Any, panels: Axes | Sequence[Axes], label: str, **settings: Any) -> Colorbar:
    """Add a colour bar beside one or several panels. `shown` is the coloured artist in one of the
    panels."""
    bar = shown.axes.figure.colorbar(shown, ax=panels, label=label, **settings)
    bar.ax.tick_params(direction="out")
    return bar


def ticks_outside(axes: Axes) -> None:
    """Draw the ticks of a filled panel outside the panel, at the bottom and the left."""
    axes.tick_params(which="both", direction="out", top=False, right=False)


def logarithmic_if_wide(axes: Axes, values: np.ndarray) -> None:
    """Make the abscissa logarithmic if the values are positive and span a wide range."""
    if is_wide(values):
        logarithmic(axes)


def logarithmic(axes: Axes, limits: Sequence[float] | np.ndarray | None = None) -> None:
    """Make the abscissa of a panel logarithmic. `limits` are the first and the last value of the
    abscissa."""
    axes.set(xscale="log")
    if limits is not None:
        axes.set_xlim(*limits)
    logarithmic_ticks(axes.xaxis)


def logarithmic_ticks(axis: Axis) -> None:
    """Label an axis at powers of ten, or at round numbers if the axis contains fewer than two
    powers of ten."""
    low, high = np.sort(axis.get_view_interval())
    powers = np.floor(np.log10(high) + 1e-9) - np.ceil(np.log10(low) - 1e-9) + 1
    axis.set_minor_formatter(ticker.NullFormatter())
    if powers >= 2:
        axis.set_major_locator(ticker.LogLocator(numticks=6 if powers <= 5 else None))
        return
    locator: ticker.Locator = ticker.MaxNLocator(3, steps=[1, 2, 5])
    axis.set_major_locator(ticker.LogLocator(subs=(1, 2, 5)) if high > 8.0 * low else locator)
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:.6g}"))


def edges(points: np.ndarray, logarithmic: bool) -> np.ndarray:
    """Return the edges of cells around n points, as an array of shape (n + 1,).

    The edges are half-way between neighbouring points. The first and the last point are in the
    middle of their cells. The coordinates `points` must be in ascending order. If `logarithmic` is
    True, geometric means are used; otherwise, arithmetic means are used.
    """
    if logarithmic:
        return np.exp(edges(np.log(points), False))
    between = (points[1:] + points[:-1]) / 2 if points.size > 1 else points + 0.5
    return np.unique([2 * points[0] - between[0], *between, 2 * points[-1] - between[-1]])


def cells(axes: Axes, x: np.ndarray, y: np.ndarray, which: np.ndarray, **ink: Any) -> None:
    """Draw a rectangle for each cell whose entry in `which` is True.

    x, y: edges of the cells, as arrays of shape (n + 1,) and (m + 1,). which: array of shape (m,
    n).
    """
    for i, j in np.argwhere(which):
        size = x[j + 1] - x[j], y[i + 1] - y[i]
        axes.add_patch(Rectangle((x[j], y[i]), *size, **ink))


def disc(
    axes: Axes, x: np.ndarray, y: np.ndarray, values: np.ndarray, method: str, **ink: Any
) -> ScalarMappable:
    """Draw an image of the contact, with a circle of radius 1 as the edge.

    x, y, values: lateral position, forward position and value of each point. NaN is white. `method`
    is the method of scipy.interpolate.griddata.
    """
    line = np.linspace(-1.0, 1.0, PIXELS)
    places = np.meshgrid(line, line)
    image = griddata((x, y), values, tuple(places), method=method)
    image[np.hypot(*places) >= 1.0] = np.nan
    axes.add_patch(Circle((0, 0), 1.0, fill=False, lw=0.9))
    axes.set(aspect="equal", xlabel=axis(LATERAL))
    return axes.pcolormesh(line, line, image, vmin=0.0, rasterized=True, zorder=0, **ink)


def unit_range(axes: Axes) -> None:
    """Set the vertical range of a panel. This range extends from 0 to 1, or further to include all
    lines and points that have an id."""
    lines = [np.ravel(line.get_ydata()) for line in axes.get_lines() if line.get_gid()]
    values = np.concatenate([np.array([0.0, 1.0]), *lines])
    values = values[np.isfinite(values)]
    low, high = np.floor(5 * values.min()) / 5, np.ceil(5 * values.max()) / 5
    margin = 0.04 * (high - low)
    axes.set_ylim(low - margin, high + margin)
    axes.yaxis.set_major_locator(ticker.MultipleLocator(0.2))


def closed_form(axes: Axes, x: Any, y: Any, name: str, label: str) -> None:
    """Draw a closed form in its colour and line style. `name` is the name of the closed form's
    variable in datasets."""
    color, ls = LIMITS[name]
    axes.plot(x, y, color=color, ls=ls, label=label, gid=name)


def computed(axes: Axes, x: np.ndarray, *points: np.ndarray, of: str = "y", **ink: Any) -> None:
    """Draw computed points with error bars. Points that did not converge are hollow.

    points: values, error estimates, and flags that are nonzero for converged points. of: direction
    of the error bars, "x" or "y".
    """
    values, errors, converged = points[0], points[1], points[2] != 0
    errors = np.where(np.isfinite(errors), errors, np.nan)
    marks: Ink = {"color": BLACK, "ls": "none", "marker": "o", "ms": 3.2, "mew": 0.7}
    marks |= {"zorder": 5, **ink}
    bars: Ink = {"fmt": "none", "ecolor": marks["color"], "elinewidth": 0.7, "capsize": 1.8}
    bars[f"{of}err"] = errors
    size = x if of == "x" else np.nanmax(np.abs(values), initial=1e-300)
    if np.nanmax(errors / size, initial=0.0) >= VISIBLE_ERROR:
        axes.errorbar(x, values, **bars).lines[2][0].set_gid("error")
    axes.plot(x[converged], values[converged], gid="computed", **marks)
    if not converged.all():
        if "not converged" not in axes.get_legend_handles_labels()[1]:  # of the lines so far
            axes.plot([], [], "o", mfc="white", mec=GREY, ms=3.2, mew=0.7, label="not converged")
        marks |= {"mfc": "white", "ls": "none", "label": ""}
        axes.plot(x[~converged], values[~converged], gid="unconverged", **marks)


def certified(axes: Axes, x: np.ndarray, *points: np.ndarray, **ink: Any) -> None:
    """Draw a line of a certified map, with a band for the error estimate.

    points: values, error estimates, and flags.
    """
    values, error, _ = points
    axes.plot(x, values, gid="certified", **{name: ink[name] for name in ("color", "ls", "label")})
    error = np.where(np.isfinite(error), error, np.nan)
    label = "_" if axes.collections else "band: error estimate"
    axes.fill_between(x, values - error, values + error, color=ink["color"], alpha=0.3, label=label)


def after_layout(figure: Any, finish: Callable[[], None]) -> None:
    """Register a function to be called after the layout. This function must not move panels."""
    figure.finishing = [*getattr(figure, "finishing", ()), finish]
