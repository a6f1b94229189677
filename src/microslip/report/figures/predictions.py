"""Figures that commands draw: predictions over ranges, and a fit with its residuals."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

FRICTION = (
    ("mu_apparent", "mu_apparent_error", "coefficient of friction\n", ""),
    ("friction_force_N", "friction_force_error_N", "friction force ", "N"),
)
DRIFT = (("speed_m_s", "speed_error_m_s", "speed ", "m/s"),)
"""Variable, error estimate, label and SI unit of each panel. FRICTION is for contacts at a speed,
DRIFT for contacts under a force."""

CONDITIONS = {
    "speed_m_s": ("speed", "m/s"),
    "amplitude_si": ("amplitude", "m"),
    "row_load_N": ("load", "N"),
    "frequency_Hz": ("frequency", "Hz"),
}
"""Name and SI unit of the conditions that can differ between the rows of a fit."""
MEASURED = {"friction": ("friction force", "N"), "mu": ("coefficient of friction", "")}
PARAMETERS = (
    (r"\mu", "mu{}", ""),
    (r"u_\mathrm{lim}", "u_lim{}_m", "m"),
    ("G", "shear_modulus{}_Pa", "Pa"),
)
"""Fitted parameters: symbol, name in the dataset (with "", "_low" or "_high" for {}), SI unit."""
BAND = 2.0
"""Half-width of the residual band, in standard errors. About 95 % of the residuals are inside."""


def curve(dataset: xr.Dataset) -> Figure:
    """Draw friction over the longest axis, with one line for each value of the other axis.

    For contacts under a force, draw the speed. Values that did not converge are hollow.
    """
    abscissa, *others = sorted(dataset.dims, key=dataset.sizes.__getitem__, reverse=True)
    x, unit = _scaled(dataset[abscissa])
    forced = "force_N" in dataset and bool(dataset["force_N"].notnull().any())
    shown = DRIFT if forced else FRICTION
    figure = look.new_figure(look.SINGLE, 0.4 + 1.9 * len(shown))
    axes = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (variable, error, label, si) in zip(axes, shown, strict=True):
        factor, prefixed = look.prefixed(dataset[variable].fillna(0.0).values, si)
        lines = [dataset.isel({o: k}) for o in others for k in range(dataset.sizes[o])] or [dataset]
        for line, (color, marker, ls) in zip(lines, look.LINES, strict=False):
            title = "".join(_title(line[other]) for other in others)
            y, band = line[variable].values / factor, line[error].values / factor
            ink: look.Ink = {"color": color, "ls": ls, "marker": marker, "ms": 2.4, "lw": 1.0}
            panels.computed(panel, x, y, band, line["converged"].values, label=title, **ink)
        panel.set_ylabel(f"{label}({prefixed or 'dimensionless'})")
        panel.set_ylim(bottom=0.0)
        if len(shown) > 1 and not others:
            panels.heading(panel)
    if others:
        panels.legend_above(axes[0])
        for panel in axes[1:]:
            panels.heading(panel)
    panels.logarithmic_if_wide(axes[-1], x)
    axes[-1].set_xlabel(f"{dataset[abscissa].attrs['long_name']} ({unit or 'dimensionless'})")
    return figure


def _scaled(axis: xr.DataArray) -> tuple[np.ndarray, str]:
    """Return the values of an axis in a prefixed unit, and this unit."""
    factor, unit = look.prefixed(axis.values, axis.attrs["units"].removeprefix("1"))
    return axis.values / factor, unit


def _title(value: xr.DataArray) -> str:
    """Return the title of a line, such as "load 10 N"."""
    number, unit = _scaled(value)
    return f"{value.attrs['long_name']} {float(number):.4g} {unit}".strip()


def fit(dataset: xr.Dataset) -> Figure:
    """Draw measured and fitted friction above, residuals below.

    The abscissa is the condition with the most values. Rows that differ in another condition have
    different colours and markers. The line is the model curve, with a band for the model error. A
    row without a model curve has a short dash at the model's friction.
    """
    units = {name: unit for name, (_, unit) in CONDITIONS.items()}
    units["amplitude_si"] = "rad" if dataset.attrs.get("motion") == "bore" else "m"
    counts = {name: len(np.unique(dataset[name])) for name in CONDITIONS}
    along = max(counts, key=lambda name: counts[name])
    others = [name for name in CONDITIONS if name != along]
    what, si = MEASURED[dataset.attrs["quantity"]]
    unit, prefixed = look.prefixed(dataset[along].values, units[along])
    factor, friction = look.prefixed(dataset["measured"].values, si)
    figure = look.new_figure(look.SINGLE, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    every = np.stack(columns(dataset, *others), axis=1)
    kinds, which = np.unique(every, axis=0, return_inverse=True)
    if len(kinds) > len(look.LINES):
        which = np.zeros(dataset.sizes["row"], int)
    differ = [name for name in others if counts[name] > 1 and which.any()]
    for k, ink in zip(np.unique(which), look.LINES, strict=False):
        rows = dataset.isel(row=which.ravel() == k)
        texts = (_value(name, float(rows[name][0]), units[name]) for name in differ)
        title = ", ".join(texts) or "measured; line: model"
        x, residual, measured, error = columns(
            rows, along, "residual", "measured", "measured_error"
        )
        mark: look.Ink = {"color": ink[0], "marker": ink[1], "label": title}
        good = np.ones(x.size)
        panels.computed(upper, x / unit, measured / factor, error / factor, good, **mark)
        _model(upper, dataset, rows, along, unit, factor, ink=ink)
        lower.plot(x / unit, residual, ink[1], color=ink[0], ms=3.2, gid="residual")
    lower.axhspan(-BAND, BAND, color=look.PALE, lw=0, zorder=0.4)
    lower.axhline(0.0, color=look.GREY, lw=0.7, zorder=0.5)
    panels.logarithmic_if_wide(lower, dataset[along].values)
    upper.set_ylabel(f"{what} ({friction or 'dimensionless'})")
    lower.set_ylabel("residual, standard\nerrors (dimensionless)")
    lower.set_xlabel(f"{CONDITIONS[along][0]} ({prefixed})")
    handles = upper.get_legend_handles_labels()[0]
    if len(handles) > 1:
        handles.append(Line2D([], [], color=look.GREY, lw=1.0, label="lines: model"))
    note = look.wrapped(_parameters(dataset), look.SINGLE - 0.6, look.HEADING)
    panels.legend_above(upper, note, handles=handles)
    panels.heading(lower)
    return figure


def _model(
    axes: Axes, dataset: xr.Dataset, rows: xr.Dataset, along: str, unit: float, factor: float,
    *, ink: tuple[str, str, Any],
) -> None:  # fmt: skip
    """Draw a model curve if the rows differ in the abscissa only, else a dash for each row."""
    here = np.ones(dataset[f"curve_{along}"].shape, bool)
    for name in CONDITIONS:
        if name != along:
            values = np.unique(rows[name])
            here &= len(values) == 1 and dataset[f"curve_{name}"].values == values[0]
    if here.any():
        names = (f"curve_{name}" for name in (along, "fitted", "fitted_error"))
        x, fitted, error = (values[here] for values in columns(dataset, *names))
        low, high = (fitted - error) / factor, (fitted + error) / factor
        band: look.Ink = {"color": ink[0], "alpha": 0.2, "lw": 0, "gid": "model-error"}
        axes.fill_between(x / unit, low, high, **band)
        axes.plot(x / unit, fitted / factor, color=ink[0], ls=ink[2], lw=1.0, gid="fitted")
    else:
        x, y = rows[along].values / unit, rows["fitted"].values / factor
        axes.plot(x, y, "_", color=ink[0], ms=7.0, mew=1.0, gid="fitted")


def _value(condition: str, value: float, si: str) -> str:
    factor, unit = look.prefixed(value, si)
    return f"{CONDITIONS[condition][0]} {value / factor:.3g} {unit}"


def _parameters(dataset: xr.Dataset) -> str:
    """Format the fitted parameters, each with the larger half of its interval."""
    parts = []
    for symbol, name, unit in PARAMETERS:
        names = [name.format(part) for part in ("", "_low", "_high")]
        if all(each in dataset for each in names):
            value, low, high = (float(dataset[each]) for each in names)
            if np.isfinite([value, low, high]).all():
                factor, prefixed = look.prefixed(value, unit)
                half = float(f"{max(high - value, value - low) / factor:.2g}")
                parts.append(rf"${symbol} = {value / factor:.3g} \pm {half:g}$ {prefixed}".strip())
    return ", ".join(parts)
