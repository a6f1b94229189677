"""Scales of the quantities in maps: colours, contours and ticks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import matplotlib
import numpy as np
import xarray as xr
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, TwoSlopeNorm, to_rgb

from microslip.config.quantities import MU_MACRO
from microslip.report.figures import style as look

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


@dataclass(frozen=True, eq=False)
class Scale:
    """Colours and contours of a quantity.

    Attributes
    ----------
    label : str
        Label of the colour bar.
    fills, lines, ticks : ndarray
        Levels of the bands, levels of the contours, and ticks of the colour bar, in ascending
        order.
    colours, norm : Colormap, Normalize
        Colours of the values.
    text : callable
        Function that formats a level of a contour or a tick.
    """

    label: str
    fills: np.ndarray
    lines: np.ndarray
    ticks: np.ndarray
    colours: Colormap
    norm: Normalize
    text: Callable[[float], str] = field(default="{:.1f}".format)

    def inks(self) -> list[str]:
        """Return colours of the contours that contrast with the bands."""
        weights = (0.2126, 0.7152, 0.0722)  # luminance by Rec. 709
        shades = [np.dot(weights, to_rgb(self.colours(self.norm(level)))) for level in self.lines]
        return ["white" if luminance < DARK else "black" for luminance in shades]


def friction(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of friction: 0 to 1, extended to the smallest and the largest value.

    The colours for 0 to 1 are the same for all datasets, unless the largest value is above 1.
    """
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    high = max(float(dataset["mu_macro"].max()) for dataset in datasets)
    low = np.floor(10 * low) if low < -BEYOND else 0.0
    high = np.ceil(10 * high) if high > 1 + BEYOND else 10.0
    fills = np.linspace(low / 10, high / 10, round(2 * (high - low)) + 1)
    lines = np.linspace(0.1, 0.9, 9) if len(datasets) == 1 else np.linspace(0.1, 0.9, 5)
    if low < 0:
        lines = np.array([*-lines[::-1], 0.0, *lines])
    ticks = fills[np.isclose(np.round(5 * fills), 5 * fills)]
    above, norm = matplotlib.colormaps[look.COLOURMAP], Normalize(0.0, high / 10)
    if low < 0:
        shades = np.linspace(0.0, 1.0, 201)
        below = LinearSegmentedColormap.from_list("below", BELOW)(shades[:0:-1])
        colours = [*below, *above(shades)]
        above = LinearSegmentedColormap.from_list("signed", colours, N=1024)
        norm = TwoSlopeNorm(0.0, -1.0, high / 10)
    return Scale(look.FRICTION, fills, lines[lines > fills[0]], ticks, above, norm)


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
    label = f"change of {MU_MACRO.math} with $\\nu$\n(dimensionless)"
    ticks = (
        levels[[0, count - 1, count, -1]]
        if count < FEW_BANDS
        else np.array([levels[0], 0, levels[-1]])
    )
    colours, norm = matplotlib.colormaps[DIVERGING], Normalize(levels[0], levels[-1])
    return Scale(label, levels, np.empty(0), ticks, colours, norm, "{:.3g}".format)


def error(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of error estimates, from 0 to the error of the certified maps."""
    most = max(float(dataset["mu_macro_error"].where(np.isfinite).max()) for dataset in datasets)
    fills = np.linspace(0.0, max([most, *(dataset.attrs["error"] for dataset in datasets)]), 101)
    label = "error estimate\n(dimensionless)"
    colours, norm = matplotlib.colormaps[look.COLOURMAP], Normalize(0.0, fills[-1])
    return Scale(label, fills, np.empty(0), fills[::25], colours, norm, "{:.2g}".format)


def drift(datasets: Sequence[xr.Dataset]) -> Scale:
    """Return the scale of decimal logarithms of velocities, from -3 to 1."""
    label = "mean velocity  (dimensionless)"
    fills, lines = np.linspace(-3.0, 1.0, 17), np.array([-2.0, -1.0, 0.0])
    colours, norm = matplotlib.colormaps[look.COLOURMAP], Normalize(-3.0, 1.0)
    powers = np.arange(-3.0, 2.0)
    return Scale(label, fills, lines, powers, colours, norm, lambda x: f"${look.number(10**x)}$")


SCALES = {
    "mu_macro": friction,
    "mu_macro_change": change,
    "mu_macro_error": error,
    "velocity": drift,
}
"""Function that makes the scale of each variable."""
