"""Draw the figures of commands: predictions over ranges, and a fit with its residuals."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from microslip.foundation.number_text import prefixed_text
from microslip.report import selection
from microslip.report.figures import style as look
from microslip.report.selection import columns

FRICTION = (
    ("mu_apparent", "mu_apparent_error", "coefficient of friction\n", ""),
    ("friction_force_N", "friction_force_error_N", "friction force ", "N"),
)
DRIFT = (("speed_m_s", "speed_error_m_s", "speed ", "m/s"),)
"""Variable, error estimate, label and SI unit of each panel. FRICTION is used for contacts at a
speed, and DRIFT for contacts under a force."""

CONDITIONS = {
    "speed_m_s": ("speed", "m/s"),
    "amplitude_si": ("amplitude", "m"),
    "row_load_N": ("load", "N"),
    "frequency_Hz": ("frequency", "Hz"),
}
"""Name and SI unit of each condition that can differ between the rows of a fit."""
MEASURED = {"friction": ("friction force", "N"), "mu": ("coefficient of friction", "")}
PARAMETERS = (
    (r"\mu", "mu{}", ""),
    (r"u_\mathrm{lim}", "u_lim{}_m", "m"),
    ("G", "shear_modulus{}_Pa", "Pa"),
)
"""Symbol, name in the dataset and SI unit of each fitted parameter. In the name, {} stands for "",
"_low" or "_high"."""
BAND = 2.0
"""Half-width of the residual band, in standard errors. About 95 % of the residuals are inside."""


def curve(dataset: xr.Dataset) -> Figure:
    """Draw friction over the longest axis, with one line for each value of the other axis.

    For contacts under a force, the speed is drawn instead of the friction. Values that did not
    converge are hollow. If inputs are uncertain, a band shows the 95 % interval.
    """
    abscissa, lines = selection.lines(dataset, "converged")
    about = {n: (dataset[n].long_name, dataset[n].units.removeprefix("1")) for n in dataset.dims}
    size, unit = look.prefixed(dataset[abscissa].values, about[abscissa][1])
    shown = DRIFT if "force_N" in dataset and dataset["force_N"].notnull().any() else FRICTION
    figure = look.new_figure(look.SINGLE, 0.4 + 1.9 * len(shown))
    grid = look.grid(figure, len(shown), 1, sharex=True)
    for axes, (variable, error, label, si) in zip(grid, shown, strict=True):
        factor, prefixed = look.prefixed(dataset[variable].fillna(0.0).values, si)
        for k, (at, line) in enumerate(lines):
            color, marker, ls = look.LINES[k % len(look.LINES)]
            ink: look.Ink = {"color": color, "ls": ls, "marker": marker, "ms": 2.4, "lw": 1.0}
            ink["label"] = ", ".join(_value(*about[o], at[o]) for o in at)
            x, y, errors, converged = columns(line, abscissa, variable, error, "converged")
            look.computed(axes, x / size, y / factor, errors / factor, converged, **ink)
            if (name := error.replace("error", "low")) in line:
                low, high = columns(line, name, error.replace("error", "high"))
                band: look.Ink = {"label": "_" if k else "95 % interval", "gid": "uncertainty"}
                band |= {"color": color, "alpha": 0.2, "lw": 0}
                axes.fill_between(x / size, low / factor, high / factor, **band)
        axes.set_ylabel(f"{label}({prefixed or 'dimensionless'})")
        axes.set_ylim(bottom=0.0)
        if axes.get_legend_handles_labels()[0] and axes is grid[0]:
            look.legend_above(axes)
        elif len(shown) > 1:
            look.heading(axes)
    look.logarithmic_if_wide(grid[-1], dataset[abscissa].values)
    grid[-1].set_xlabel(f"{about[abscissa][0]} ({unit or 'dimensionless'})")
    return figure


def _value(name: str, unit: str, value: float) -> str:
    """Format a value with a name and a prefixed unit, such as "load 10 N"."""
    return f"{name} {prefixed_text(value, unit) if unit else f'{value:.4g}'}"


def fit(dataset: xr.Dataset) -> Figure:
    """Draw a panel with measured and fitted friction, and a panel with the residuals below it.

    The abscissa is the condition with the largest number of values. Rows that differ in another
    condition have different colours and markers. The line is the model curve, with a band for the
    model error. For a row without a model curve, a short dash marks the friction of the model.
    """
    counts = {name: len(np.unique(dataset[name])) for name in CONDITIONS}
    along, *others = sorted(counts, key=lambda name: -counts[name])
    what, si = MEASURED[dataset.attrs["quantity"]]
    unit, prefixed = look.prefixed(dataset[along].values, CONDITIONS[along][1])
    factor, friction = look.prefixed(dataset["measured"].values, si)
    figure = look.new_figure(look.SINGLE, 4.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    names = [*CONDITIONS, "measured", "measured_error", "fitted", "residual"]
    groups = list(dataset[names].to_dataframe().groupby(others))
    models = dataset[[f"curve_{name}" for name in (*CONDITIONS, "fitted", "fitted_error")]]
    models = models.to_dataframe().rename(columns=lambda name: name.removeprefix("curve_"))
    for k, (place, rows) in enumerate(groups):
        color, marker, ls = look.LINES[k % len(look.LINES)]
        at = zip(others, place, strict=True)
        texts = [_value(*CONDITIONS[name], value) for name, value in at if counts[name] > 1]
        label = ", ".join(texts) or "measured; line: model"
        ink: look.Ink = {"color": color, "marker": marker}
        ink["label"] = label if len(groups) <= len(look.LINES) else ""
        x, measured, error, fitted, residual = rows[[along, *names[len(CONDITIONS) :]]].to_numpy().T
        good = np.ones(x.size)
        look.computed(upper, x / unit, measured / factor, error / factor, good, **ink)
        lower.plot(x / unit, residual, marker, color=color, ms=3.2, gid="residual")
        line: look.Ink = {"color": color, "ls": "none", "marker": "_", "ms": 7.0, "mew": 1.0}
        model = models[(models[others].to_numpy() == place).all(axis=1)]
        if len(model):
            x, fitted, error = model[[along, "fitted", "fitted_error"]].to_numpy().T
            line = {"color": color, "ls": ls, "lw": 1.0}
            band: look.Ink = {"color": color, "alpha": 0.2, "lw": 0, "gid": "model-error"}
            low, high = (fitted - error) / factor, (fitted + error) / factor
            upper.fill_between(x / unit, low, high, **band)
        upper.plot(x / unit, fitted / factor, gid="fitted", **line)
    lower.axhspan(-BAND, BAND, color=look.PALE, lw=0, zorder=0.4)
    lower.axhline(0.0, color=look.GREY, lw=0.7, zorder=0.5)
    look.logarithmic_if_wide(upper, dataset[along].values)
    upper.set_ylabel(f"{what} ({friction or 'dimensionless'})")
    lower.set_ylabel("residual, standard\nerrors (dimensionless)")
    lower.set_xlabel(f"{CONDITIONS[along][0]} ({prefixed})")
    handles = upper.get_legend_handles_labels()[0]
    if len(handles) > 1:
        handles.append(Line2D([], [], color=look.GREY, lw=1.0, label="lines: model"))
    note = look.wrapped(_parameters(dataset), look.SINGLE - 0.6, look.HEADING)
    look.legend_above(upper, note, handles=handles)
    look.heading(lower)
    return figure


def _parameters(dataset: xr.Dataset) -> str:
    """Format the fitted parameters, each with an uncertainty. The uncertainty is the larger of the
    two half-widths of the confidence interval."""
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
