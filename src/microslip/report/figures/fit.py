"""A fit: measured friction and what the fitted contact has, and what is left between them."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.data import finite_or_nan, require
from microslip.report.figures.lines import LOOKS
from microslip.si.fitting.curves import abscissa as abscissa_of

CONDITIONS = {
    "speed_m_s": ("speed", "m/s"),
    "amplitude_si": ("amplitude", "m"),
    "row_load_N": ("load", "N"),
    "frequency_Hz": ("frequency", "Hz"),
}
"""Conditions that can differ from row to row: name and SI unit."""
MEASURED = {"friction": ("friction force", "N"), "mu": ("coefficient of friction", "")}
PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
VARIABLES = ("measured", "measured_error", "fitted", "fitted_error", "residual", *CONDITIONS)
CURVE = tuple(f"curve_{name}" for name in ("fitted", "fitted_error", *CONDITIONS))
BAND = 2.0
"""Standard errors within which about 95 % of the residuals are."""
WIDE = 10.0
"""Ratio of the ends of an axis from which on it is logarithmic."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw measured and fitted friction above, residuals below.

    The abscissa is the condition with the most values; rows that differ in another one have a look
    of their own.  The line is the model curve, with a band for the error of the model; a row that
    no curve passes through has a short dash there.
    """
    require(name, "fit", dataset, (*VARIABLES, *CURVE))
    abscissa = abscissa_of({each: dataset[each].values for each in CONDITIONS})
    figure = look.new_figure(look.SINGLE, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    along, label = _scaled(abscissa, dataset)
    what, unit = MEASURED[dataset.attrs["quantity"]]
    factor, unit = _prefix(dataset["measured"].values, unit) if unit else (1.0, "dimensionless")
    for (title, chosen), style in zip(_series(dataset, abscissa), LOOKS, strict=False):
        rows = dataset.isel(row=chosen)
        _rows(upper, rows, along[chosen], factor, style, title)
        _model(upper, dataset, rows, abscissa, factor, style)
        color, marker, _ = style
        left = dataset["residual"].values[chosen]
        lower.plot(along[chosen], left, marker, color=color, markersize=3.2, gid="residual")
    lower.axhspan(-BAND, BAND, color=look.PALE, linewidth=0, zorder=0.4)
    lower.axhline(0.0, color=look.GREY, linewidth=0.7, zorder=0.5)
    if along.min() > 0.0 and along.max() > WIDE * along.min():
        lower.set_xscale("log")
        ticks.logarithmic(lower.xaxis)
    upper.set_ylabel(f"{what} ({unit})")
    lower.set_ylabel("residual, standard\nerrors (dimensionless)")
    lower.set_xlabel(label)
    handles = upper.get_legend_handles_labels()[0]
    if len(handles) > 1:
        handles.append(Line2D([], [], color=look.GREY, linewidth=1.0, label="lines: model"))
    upper.legend(handles=handles, loc="best", fontsize=look.SMALLEST)
    look.letter(upper, "a", _found(dataset), look.SINGLE - 0.6)
    look.letter(lower, "b")
    return figure


def _rows(
    axes: Axes,
    rows: xr.Dataset,
    along: np.ndarray,
    factor: float,
    style: tuple,
    title: str,
) -> None:
    """Marks with error bars for the measured friction."""
    color, marker, _ = style
    axes.errorbar(
        along,
        rows["measured"].values / factor,
        yerr=finite_or_nan(rows["measured_error"].values) / factor,
        color=color,
        marker=marker,
        markersize=3.2,
        linestyle="none",
        elinewidth=0.7,
        capsize=1.5,
        label=title or "measured; line: model",
        gid="measured",
    )


def _model(
    axes: Axes, dataset: xr.Dataset, rows: xr.Dataset, abscissa: str, factor: float, style: tuple
) -> None:
    """The model curve of rows that share all conditions but the abscissa, else a dash at each."""
    color, _, linestyle = style
    others = [each for each in CONDITIONS if each != abscissa]
    along, fitted, off = (
        dataset[f"curve_{each}"].values for each in (abscissa, "fitted", "fitted_error")
    )
    own = [np.unique(rows[each].values) for each in others]
    here = np.zeros(len(along), bool)
    if all(len(values) == 1 for values in own):
        conditions = [dataset[f"curve_{each}"].values for each in others]
        here = np.logical_and.reduce([a == b for a, b in zip(conditions, own, strict=True)])
    unit, _ = _prefix(dataset[abscissa].values, "")
    if here.any():
        x, y, error = along[here] / unit, fitted[here] / factor, off[here] / factor
        band: dict[str, Any] = {"color": color, "alpha": 0.2, "linewidth": 0, "gid": "model-error"}
        axes.fill_between(x, y - error, y + error, **band)
        axes.plot(x, y, color=color, linestyle=linestyle, linewidth=1.0, gid="fitted")
    else:
        x, y = rows[abscissa].values / unit, rows["fitted"].values / factor
        axes.plot(x, y, "_", color=color, markersize=7.0, markeredgewidth=1.0, gid="fitted")


def _series(dataset: xr.Dataset, abscissa: str) -> list[tuple[str, np.ndarray]]:
    """Titles and rows of the series that differ in another condition than the abscissa.

    If there are more series than line styles, all rows are one series.
    """
    others = [
        each for each in CONDITIONS if each != abscissa and len(np.unique(dataset[each].values)) > 1
    ]
    everything = [("", np.arange(dataset.sizes["row"]))]
    if not others:
        return everything
    table = np.stack([dataset[each].values for each in others], axis=1)
    kinds, which = np.unique(table, axis=0, return_inverse=True)
    if len(kinds) > len(LOOKS):
        return everything
    which = which.reshape(-1)
    titles = [
        ", ".join(_value(each, value, dataset) for each, value in zip(others, kind, strict=True))
        for kind in kinds
    ]
    return [(title, np.flatnonzero(which == k)) for k, title in enumerate(titles)]


def _unit(condition: str, dataset: xr.Dataset) -> str:
    """SI unit of a condition; the amplitude may be an angle."""
    if condition == "amplitude_si" and dataset.attrs.get("motion") == "bore":
        return "rad"
    return CONDITIONS[condition][1]


def _scaled(condition: str, dataset: xr.Dataset) -> tuple[np.ndarray, str]:
    """Values of a condition in the unit that suits them, and their label."""
    values = dataset[condition].values
    factor, unit = _prefix(values, _unit(condition, dataset))
    return values / factor, f"{CONDITIONS[condition][0]} ({unit})"


def _value(condition: str, value: float, dataset: xr.Dataset) -> str:
    factor, unit = _prefix(np.array([value]), _unit(condition, dataset))
    return f"{CONDITIONS[condition][0]} {value / factor:.3g} {unit}"


def _prefix(values: np.ndarray, unit: str) -> tuple[float, str]:
    """A power of ten that suits the values, and the unit with its prefix."""
    largest = float(np.max(np.abs(values), initial=0.0))
    fitting = [one for one in PREFIXES if one[0] <= largest * (1.0 + 1e-9)]
    factor, prefix = fitting[0] if fitting else PREFIXES[-1] if largest else (1.0, "")
    return factor, f"{prefix}{unit}"


def _found(dataset: xr.Dataset) -> str:
    """Both numbers with the larger halves of their intervals."""
    parts = []
    for symbol, name, unit in (
        (r"\mu", "mu{}", ""),
        (r"u_\mathrm{lim}", "u_lim{}_m", "m"),
        ("G", "shear_modulus{}_Pa", "Pa"),
    ):
        names = [name.format(part) for part in ("", "_low", "_high")]
        if not all(each in dataset for each in names):
            continue
        value, low, high = (float(dataset[each]) for each in names)
        if np.isfinite([value, low, high]).all():
            factor, unit = _prefix(np.array([value]), unit) if unit else (1.0, "")
            half = float(f"{max(high - value, value - low) / factor:.2g}")
            parts.append(rf"${symbol} = {value / factor:.3g} \pm {half:g}$ {unit}".strip())
    return ", ".join(parts)
