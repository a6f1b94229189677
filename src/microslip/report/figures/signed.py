"""Colour scale of friction, with the colour map of Figure 2 from 0 to 1 and another hue below 0."""

from __future__ import annotations

import matplotlib
import numpy as np
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, TwoSlopeNorm, to_rgb

from microslip.report.figures import style as look

BELOW = (
    "#00224E", "#24204A", "#371D46", "#471B43", "#571941", "#671840", "#77183F",
    "#871C3E", "#97243D", "#A72E3B", "#B7393B", "#C9463C", "#E05846", "#ED6E59",
    "#F07F6A", "#F18E7A", "#F29D8A", "#F4AE9C", "#F6BEAF", "#F6CEC1", "#F5DED3",
)  # fmt: skip
"""Colours of friction 0, -0.05, ..., -1. They start at the first colour of `style.COLOURMAP`, have
equal distances in CIELAB, and become lighter away from 0. From 0 to -0.5, they differ from all
colours of `style.COLOURMAP` for all common kinds of colour vision."""
LOWEST = -1.0
DARK = 0.5
"""Lines are white on bands with a luminance below this value, and black on all others."""


def scale(levels: np.ndarray) -> tuple[Colormap, Normalize]:
    """Return the colour map and the norm for bands between ascending levels.

    The colours for 0 to 1 do not depend on the levels, unless the largest level is above 1.
    """
    top = max(float(levels[-1]), 1.0)
    above = matplotlib.colormaps[look.COLOURMAP]
    if levels[0] >= 0:
        return above, Normalize(0.0, top)
    shades = np.linspace(0.0, 1.0, 201)
    below = LinearSegmentedColormap.from_list("below", BELOW)(shades[:0:-1])
    both = LinearSegmentedColormap.from_list("signed", [*below, *above(shades)], N=1024)
    return both, TwoSlopeNorm(0.0, LOWEST, top)


def inks(levels: np.ndarray, fills: np.ndarray) -> list[str]:
    """Return line colours for `levels` that contrast with the bands between `fills`."""
    colours, norm = scale(fills)
    weights = (0.2126, 0.7152, 0.0722)  # luminance by Rec. 709
    luminances = [np.dot(weights, to_rgb(colours(norm(level)))) for level in levels]
    return ["white" if luminance < DARK else "black" for luminance in luminances]
