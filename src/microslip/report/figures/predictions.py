"""Figures that commands draw: predictions over ranges, and a fit with its residuals."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.panels import columns

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
    about = {
        name: (dataset[name].attrs["long_name"], _unit(dataset[name])) for name in dataset.dims
    }
    size, unit = look.prefixed(dataset[abscissa].values, about[abscissa][1])
    forced = "force_N" in dataset and bool(dataset["force_N"].notnull().any())
    shown = DRIFT if forced else FRICTION
    figure = look.new_figure(look.SINGLE, 0.4 + 1.9 * len(shown))
    axes = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (variable, error, label, si) in zip(axes, shown, strict=True):
        factor, prefixed = look.prefixed(dataset[variable].fillna(0.0).values, si)
        lines = [dataset.isel({o: k}) for o in others for k in range(dataset.sizes[o])] or [dataset]
        for line, (color, marker, ls) in zip(lines, look.LINES, strict=False):
            ink: look.Ink = {"color": color, "ls": ls, "marker": marker, "ms": 2.4, "lw": 1.0}
            ink["label"] = "".join(_value(*about[o], float(line[o]), 4) for o in others)
            x, y, errors, converged = columns(line, abscissa, variable, error, "converged")
            panels.computed(panel, x / size, y / factor, errors / factor, converged, **ink)
        panel.set_ylabel(f"{label}({prefixed or 'dimensionless'})")
        panel.set_ylim(bottom=0.0)
        if others and panel is axes[0]:
            panels.legend_above(panel)
        elif len(shown) > 1:
            panels.heading(panel)
    panels.logarithmic_if_wide(axes[-1])
    axes[-1].set_xlabel(f"{about[abscissa][0]} ({unit or 'dimensionless'})")
    return figure


def _unit(axis: xr.DataArray) -> str:
    """Return the SI unit of an axis, "" if it is dimensionless."""
    return axis.attrs["units"].removeprefix("1")


def _value(name: str, si: str, value: float, digits: int = 3) -> str:
    """Format a value with its name and a prefixed unit, such as "load 10 N"."""
    factor, unit = look.prefixed(value, si)
    return f"{name} {value / factor:.{digits}g} {unit}".strip()


def fit(dataset: xr.Dataset) -> Figure:
    """Draw measured and fitted friction above, residuals below.

    The abscissa is the condition with the most values. Rows that differ in another condition have
    different colours and markers. The line is the model curve, with a band for the model error. A
    row without a model curve has a short dash at the model's friction.
    """
    about = dict(CONDITIONS)
    if dataset.attrs.get("motion") == "bore":
        about["amplitude_si"] = ("amplitude", "rad")
    counts = {name: len(np.unique(dataset[name])) for name in about}
    along = max(counts, key=lambda name: counts[name])
    others = [name for name in about if name != along]
    what, si = MEASURED[dataset.attrs["quantity"]]
    unit, prefixed = look.prefixed(dataset[along].values, about[along][1])
    factor, friction = look.prefixed(dataset["measured"].values, si)
    figure = look.new_figure(look.SINGLE, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    every = np.stack(columns(dataset, *others), axis=1)
    kinds, which = np.unique(every, axis=0, return_inverse=True)
    several = 1 < len(kinds) <= len(look.LINES)
    which = which.ravel() if several else np.zeros(len(every), int)
    for k, (color, marker, ls) in zip(np.unique(which), look.LINES, strict=False):
        rows = dataset.isel(row=which == k)
        texts = [_value(*about[n], float(rows[n][0])) for n in others if several and counts[n] > 1]
        ink: look.Ink = {"color": color, "marker": marker}
        ink["label"] = ", ".join(texts) or "measured; line: model"
        x, measured, error = columns(rows, along, "measured", "measured_error")
        good = np.ones(x.size)
        panels.computed(upper, x / unit, measured / factor, error / factor, good, **ink)
        near = [
            dataset[f"curve_{n}"].values == every[which == k][0, i] for i, n in enumerate(others)
        ]
        here = np.all(near, axis=0) & (several or len(kinds) == 1)
        names = (f"curve_{name}" for name in (along, "fitted", "fitted_error"))
        x, fitted, error = (values[here] for values in columns(dataset, *names))
        line: look.Ink = {"color": color, "ls": ls, "lw": 1.0}
        if not here.any():
            x, fitted = columns(rows, along, "fitted")
            line = {"color": color, "ls": "none", "marker": "_", "ms": 7.0, "mew": 1.0}
        else:
            low, high = (fitted - error) / factor, (fitted + error) / factor
            band: look.Ink = {"color": color, "alpha": 0.2, "lw": 0, "gid": "model-error"}
            upper.fill_between(x / unit, low, high, **band)
        upper.plot(x / unit, fitted / factor, gid="fitted", **line)
        lower.plot(
            rows[along] / unit, rows["residual"], marker, color=color, ms=3.2, gid="residual"
        )
    lower.axhspan(-BAND, BAND, color=look.PALE, lw=0, zorder=0.4)
    lower.axhline(0.0, color=look.GREY, lw=0.7, zorder=0.5)
    panels.logarithmic_if_wide(upper)
    upper.set_ylabel(f"{what} ({friction or 'dimensionless'})")
    lower.set_ylabel("residual, standard\nerrors (dimensionless)")
    lower.set_xlabel(f"{about[along][0]} ({prefixed})")
    handles = upper.get_legend_handles_labels()[0]
    if len(handles) > 1:
        handles.append(Line2D([], [], color=look.GREY, lw=1.0, label="lines: model"))
    note = look.wrapped(_parameters(dataset), look.SINGLE - 0.6, look.HEADING)
    panels.legend_above(upper, note, handles=handles)
    panels.heading(lower)
    return figure


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
