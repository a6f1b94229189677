"""Pieces that several figures share: computed points with their certificates."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes

from microslip.report.figures.data import finite_or_nan
from microslip.report.figures.style import COMPUTED, PALE

VISIBLE_ERROR = 0.01
"""A band narrower than this hides behind the markers and is not drawn."""


def computed(
    axes: Axes,
    x: np.ndarray,
    values: np.ndarray,
    errors: np.ndarray,
    converged: np.ndarray,
    label: str,
    **look: Any,
) -> None:
    """Draw computed points: filled if converged, hollow if not, with their error band behind."""
    look = {**COMPUTED, **look}
    errors = finite_or_nan(errors)
    if np.nanmax(errors, initial=0.0) >= VISIBLE_ERROR:
        band: dict[str, Any] = {"color": PALE, "linewidth": 0, "zorder": 1, "gid": "error-band"}
        label_band = _once(axes, "error estimate")
        axes.fill_between(x, values - errors, values + errors, label=label_band, **band)
    done = np.asarray(converged) != 0
    axes.plot(x[done], values[done], label=label, gid="computed", **look)
    if not done.all():
        axes.plot(
            x[~done],
            values[~done],
            label=_once(axes, "not converged"),
            gid="unconverged",
            **{**look, "markerfacecolor": "white"},
        )


def _once(axes: Axes, label: str) -> str:
    """A label that the legend has once, however often it is drawn."""
    return "_" + label if label in axes.get_legend_handles_labels()[1] else label
