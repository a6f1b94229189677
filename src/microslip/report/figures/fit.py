"""Figure of a fit: measured friction, friction of the fitted contact, and residuals."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns, finite_or_nan
from microslip.si.fit import abscissa as abscissa_of

CONDITIONS = {
    "speed_m_s": ("speed", "m/s"),
    "amplitude_si": ("amplitude", "m"),
    "row_load_N": ("load", "N"),
    "frequency_Hz": ("frequency", "Hz"),
}
"""Name and SI unit of the conditions that can differ between rows."""
MEASURED = {"friction": ("friction force", "N"), "mu": ("coefficient of friction", "")}
PARAMETERS = (
    (r"\mu", "mu{}", ""),
    (r"u_\mathrm{lim}", "u_lim{}_m", "m"),
    ("G", "shear_modulus{}_Pa", "Pa"),
)
"""Fitted parameters: symbol, name in the dataset (with "", "_low" or "_high" for {}), SI unit."""
BAND = 2.0
"""Half-width of the residual band, in standard errors. About 95 % of the residuals are inside."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw measured and fitted friction above, residuals below.

    The abscissa is the condition with the most values. Rows that differ in another condition have
    different colours and markers. The line is the model curve, with a band for the model error. A
    row without a model curve has a short dash at the model's friction.
    """
    abscissa = abscissa_of({each: dataset[each].values for each in CONDITIONS})
    figure = look.new_figure(look.SINGLE, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    unit, prefixed = look.prefixed(dataset[abscissa].values, _unit(abscissa, dataset))
    along = dataset[abscissa].values / unit
    what, si = MEASURED[dataset.attrs["quantity"]]
    factor, friction = look.prefixed(dataset["measured"].values, si)
    for (title, chosen), ink in zip(_series(dataset, abscissa), look.LINES, strict=False):
        rows = dataset.isel(row=chosen)
        color, marker, _ = ink
        measured, error = columns(rows, "measured", "measured_error")
        mark: look.Ink = {"color": color, "ms": 3.2, "gid": "measured", **look.ERROR_BARS}
        error = finite_or_nan(error) / factor
        label = title or "measured; line: model"
        x, y = along[chosen], measured / factor
        upper.errorbar(x, y, yerr=error, fmt=marker, label=label, **mark)
        _model(upper, dataset, rows, abscissa, unit, factor, ink=ink)
        residual = dataset["residual"].values[chosen]
        lower.plot(along[chosen], residual, marker, color=color, ms=3.2, gid="residual")
    lower.axhspan(-BAND, BAND, color=look.PALE, lw=0, zorder=0.4)
    lower.axhline(0.0, color=look.GREY, lw=0.7, zorder=0.5)
    panels.logarithmic_if_wide(lower, along)
    upper.set_ylabel(f"{what} ({friction or 'dimensionless'})")
    lower.set_ylabel("residual, standard\nerrors (dimensionless)")
    lower.set_xlabel(f"{CONDITIONS[abscissa][0]} ({prefixed})")
    handles = upper.get_legend_handles_labels()[0]
    if len(handles) > 1:
        handles.append(Line2D([], [], color=look.GREY, lw=1.0, label="lines: model"))
    upper.legend(handles=handles, loc="best", fontsize=look.SMALLEST)
    panels.heading(upper, _parameters(dataset), look.SINGLE - 0.6)
    panels.heading(lower)
    return figure


def _model(
    axes: Axes,
    dataset: xr.Dataset,
    rows: xr.Dataset,
    abscissa: str,
    unit: float,
    factor: float,
    *,
    ink: tuple[str, str, Any],
) -> None:
    """Draw a model curve if the rows differ in the abscissa only, else a dash for each row."""
    color, _, ls = ink
    others = [each for each in CONDITIONS if each != abscissa]
    here = np.ones(dataset[f"curve_{abscissa}"].shape, bool)
    for each in others:
        values = np.unique(rows[each].values)
        here &= len(values) == 1 and dataset[f"curve_{each}"].values == values[0]
    if here.any():
        names = (f"curve_{each}" for each in (abscissa, "fitted", "fitted_error"))
        along, fitted, error = (values[here] for values in columns(dataset, *names))
        x, low, high = along / unit, (fitted - error) / factor, (fitted + error) / factor
        axes.fill_between(x, low, high, color=color, alpha=0.2, lw=0, gid="model-error")
        axes.plot(x, fitted / factor, color=color, ls=ls, lw=1.0, gid="fitted")
    else:
        x, y = rows[abscissa].values / unit, rows["fitted"].values / factor
        axes.plot(x, y, "_", color=color, ms=7.0, mew=1.0, gid="fitted")


def _series(dataset: xr.Dataset, abscissa: str) -> list[tuple[str, np.ndarray]]:
    """Return the titles and the row indices of the series.

    Rows of different series differ in a condition other than the abscissa. If there are more series
    than line styles, all rows are one series.
    """
    others = [
        each for each in CONDITIONS if each != abscissa and len(np.unique(dataset[each].values)) > 1
    ]
    table = np.stack([np.zeros(dataset.sizes["row"]), *columns(dataset, *others)], axis=1)
    kinds, which = np.unique(table, axis=0, return_inverse=True)
    if len(kinds) > len(look.LINES):
        return [("", np.arange(dataset.sizes["row"]))]
    titles = [
        ", ".join(_value(each, value, dataset) for each, value in zip(others, kind, strict=True))
        for kind in kinds[:, 1:]
    ]
    return [(title, np.flatnonzero(which.ravel() == k)) for k, title in enumerate(titles)]


def _unit(condition: str, dataset: xr.Dataset) -> str:
    """Return the SI unit of a condition. The amplitude of a bore is an angle."""
    if condition == "amplitude_si" and dataset.attrs.get("motion") == "bore":
        return "rad"
    return CONDITIONS[condition][1]


def _value(condition: str, value: float, dataset: xr.Dataset) -> str:
    factor, unit = look.prefixed(value, _unit(condition, dataset))
    return f"{CONDITIONS[condition][0]} {value / factor:.3g} {unit}"


def _parameters(dataset: xr.Dataset) -> str:
    """Format the fitted parameters, each with the larger half of its interval."""
    parts = []
    for symbol, name, unit in PARAMETERS:
        names = [name.format(part) for part in ("", "_low", "_high")]
        if not all(each in dataset for each in names):
            continue
        value, low, high = (float(dataset[each]) for each in names)
        if np.isfinite([value, low, high]).all():
            factor, prefixed = look.prefixed(value, unit)
            half = float(f"{max(high - value, value - low) / factor:.2g}")
            parts.append(rf"${symbol} = {value / factor:.3g} \pm {half:g}$ {prefixed}".strip())
    return ", ".join(parts)
