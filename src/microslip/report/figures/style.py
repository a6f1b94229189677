"""The style of all figures: sizes, fonts, colours, labels of quantities and numbers in labels."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import AbstractContextManager
from html import unescape
from string import ascii_lowercase
from typing import Any

import matplotlib.style
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.textpath import TextPath
from matplotlib.ticker import EngFormatter

from microslip.config.quantities import AMPLITUDE, DRIVES, MU_MACRO, VELOCITY, Quantity

Ink = dict[str, Any]
"""Keyword arguments of a matplotlib artist."""

SINGLE, DOUBLE = 3.39, 7.09
"""Journal column widths in inches (86 mm and 180 mm)."""

# Colours of Okabe and Ito, which can be distinguished with all common kinds of colour vision.
BLACK, BLUE, VERMILLION = "#000000", "#0072B2", "#D55E00"
GREEN, ORANGE, PURPLE = "#009E73", "#E69F00", "#CC79A7"
GREY, PALE, SKY = "#6E6E6E", "#D4D4D4", "#56B4E9"

COLOURMAP = "cividis"
"""Colour map for values from 0 to 1, perceptually uniform and readable in grey. The module `scales`
extends it to negative friction."""

# Line styles distinguish curves that are printed without colour.
SOLID = "-"
DASHED = (0, (5.0, 2.0))
DASHDOT = (0, (6.0, 1.6, 1.2, 1.6))
DOTTED = (0, (1.0, 1.6))

LINES = (
    (BLACK, "o", SOLID),
    (BLUE, "s", DASHED),
    (VERMILLION, "^", DASHDOT),
    (GREEN, "D", DOTTED),
    (ORANGE, "v", SOLID),
    (PURPLE, "P", DASHED),
    (SKY, "X", DASHDOT),
    (GREY, "*", DOTTED),
)
"""Colour, marker and line style of each line in a panel, in the order of the lines."""

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
"""Colour and line style of each closed form, by the name of its variable."""

MODELS = {
    "rigid": (BLACK, "h", "Ri"),
    "slider": (ORANGE, "<", "Sl"),
    "dahl": (PURPLE, ">", "Da"),
    "mdr": (SKY, "^", "Md"),
    "radial": (GREEN, "v", "Ra"),
    "polar": (BLUE, "o", "Po"),
    "cartesian": (VERMILLION, "s", "Ca"),
}
"""Colour, marker and two-letter abbreviation of each contact model, coarsest first."""

SMALLEST, HEADING, LABEL = 7.0, 8.0, 8.5
"""Font sizes in points: the smallest size, the size of panel headings, and the size of axis
labels."""
LONGEST = 100
"""Maximum number of characters of a title from the configuration."""
DPI = 300

RC = {
    "figure.dpi": DPI,  # the layout is computed for the resolution of the PNG file
    "savefig.dpi": "figure",
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # ships with matplotlib: the same on every machine
    "mathtext.fontset": "dejavusans",
    "font.size": 8,
    "axes.labelsize": LABEL,
    "axes.titlesize": HEADING,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "legend.borderaxespad": 0.4,
    "legend.labelspacing": 0.35,
    "axes.linewidth": 0.7,
    "lines.linewidth": 1.3,
    "xtick.top": True,
    "ytick.right": True,
    "hatch.linewidth": 0.6,
    "pdf.fonttype": 42,
    "figure.constrained_layout.h_pad": 0.04,
    "figure.constrained_layout.w_pad": 0.05,
}
for _axis in ("xtick", "ytick"):
    RC |= {f"{_axis}.labelsize": 8, f"{_axis}.direction": "in"}
    RC |= {f"{_axis}.major.width": 0.7, f"{_axis}.minor.width": 0.5}

# The label of an axis has words, a symbol and a unit. A symbol that is a ratio needs no unit. Other
# dimensionless symbols have the label "(dimensionless)".
FRICTION = f"{MU_MACRO.text}  {MU_MACRO.math}\n(dimensionless)"


def style() -> AbstractContextManager[None]:
    """Return a context in which the figures' settings replace the user's settings."""
    return matplotlib.style.context(RC, after_reset=True)


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure with a size in inches and a layout in which panels do not overlap."""
    return Figure(figsize=(width, height), layout="constrained")


def quantity(dataset: xr.Dataset, dim: str) -> Quantity:
    """Return the description of an axis of a dataset. Axes of the paper have a symbol."""
    tables = {"velocity": VELOCITY, "amplitude": AMPLITUDE}
    one = tables[dim].get(dataset.attrs.get("motion", "")) if dim in tables else DRIVES.get(dim)
    name = "forward velocity" if dim == "velocity" else dim
    formula = dataset[dim].attrs.get("formula", "") if dim in dataset else ""
    return one or Quantity(name, "", formula)


def symbol(dataset: xr.Dataset, dim: str) -> str:
    """Return the symbol of an axis of a dataset in LaTeX, or else its name."""
    name = rf"\mathrm{{{dim}}}" if dim != "poisson" else r"\nu"
    return quantity(dataset, dim).latex or name


def axis(one: Quantity, short: bool = False) -> str:
    """Return the label of an axis: words, the symbol, and the ratio that defines the symbol.

    short: True to leave out a symbol that a ratio defines.
    """
    ratio = mathtext(one.unit)
    if not one.latex or (short and ratio):
        return f"{one.text}  {ratio or '(dimensionless)'}"
    return f"{one.text}  ${one.latex}{' = ' + ratio[1:-1] if ratio else ''}$"


def number(value: float) -> str:
    """Format a number as mathtext with three digits, and a power of ten if it is large or small."""
    text = f"{value:.3g}"
    if "e" not in text:
        return text
    mantissa, exponent = text.split("e")
    power = f"10^{{{int(exponent)}}}"
    return power if mantissa == "1" else rf"{mantissa}\times {power}"


def prefixed(values: np.ndarray | float, unit: str) -> tuple[float, str]:
    """Return the factor of an SI prefix that suits the values, and the unit with this prefix.

    Without a unit, the factor is 1.
    """
    largest = float(np.max(np.abs(values), initial=0.0)) * (1.0 + 1e-9)
    power = 3 * int(np.clip(np.floor(np.log10(largest) / 3), -3, 3)) if largest and unit else 0
    return 10.0**power, EngFormatter.ENG_PREFIXES[power] + unit


def conditions(pairs: Iterable[tuple[str, float]]) -> str:
    """Format the conditions of a panel as mathtext, such as "v = 0.1, A = 2".

    pairs: LaTeX symbols and their values.
    """
    return ", ".join(f"${symbol} = {number(value)}$" for symbol, value in pairs)


def ratio(dataset: xr.Dataset) -> str:
    """Format the Poisson's ratio of a dataset as mathtext."""
    return conditions([(r"\nu", float(dataset["poisson"]))])


def model(name: str) -> tuple[str, str, str]:
    """Return the colour, marker and abbreviation of a contact model. An unknown model is grey."""
    return MODELS.get(name, (GREY, "p", name[:2].capitalize()))


def in_order(names: set[str]) -> list[str]:
    """Sort the names of contact models, coarsest first. Unknown models come last."""
    return [name for name in MODELS if name in names] + sorted(names - MODELS.keys())


def literal(text: object) -> str:
    """Escape a title from the configuration so that matplotlib draws it verbatim.

    Dollar signs are escaped, white space becomes single spaces, and a text of more than `LONGEST`
    characters ends in an ellipsis.
    """
    plain = "".join(sign if sign.isprintable() else " " for sign in str(text))
    plain = " ".join(plain.split())
    if len(plain) > LONGEST:
        plain = plain[: LONGEST - 1] + "\N{HORIZONTAL ELLIPSIS}"
    return plain.replace("$", r"\$")


def width(text: str, size: float) -> float:
    """Return the width in inches of a text at a font size in points. The text can have mathtext."""
    return TextPath((0, 0), text, size=size).get_extents().width / 72.0


def wrapped(text: str, room: float, size: float) -> str:
    """Break a text into lines at most `room` inches wide, at a font size in points.

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


def power_of_ten(value: float) -> str:
    """Format a tolerance as mathtext, with 10^{-3} instead of 0.001."""
    power = np.log10(value) if value > 0 else np.nan
    return f"10^{{{power:.0f}}}" if np.isclose(power, np.round(power)) else number(value)


def letter(index: int) -> str:
    """Return the letter of a panel: a, b, ..., z, aa, ab, ..."""
    return (letter(index // 26 - 1) if index >= 26 else "") + ascii_lowercase[index % 26]


# Formulas in plain text, such as "v0 / (omega u_lim)"

GREEK = {
    name: rf"\{name}" for name in ("alpha", "beta", "delta", "kappa", "mu", "nu", "omega", "Omega")
} | {"phi": r"\varphi", "theta": r"\vartheta"}
"""Names of Greek letters and their LaTeX commands."""

_WORD = re.compile(r"([A-Za-z]+)(\d*)(?:_([A-Za-z0-9]+))?")


def mathtext(formula: str) -> str:
    """Convert a formula to mathtext. If it contains words, only its symbols are mathtext.

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
    """Return the LaTeX symbol of a match of _WORD, or "" for a word."""
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
