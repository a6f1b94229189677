"""Figure of predictions over one or two ranges: coefficient of friction and friction force."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from microslip.report.figures import panels
from microslip.report.figures import style as look

FRICTION = (
    ("mu_apparent", "mu_apparent_error", "coefficient of friction\n", ""),
    ("friction_force_N", "friction_force_error_N", "friction force ", "N"),
)
DRIFT = (("speed_m_s", "speed_error_m_s", "speed ", "m/s"),)
"""Variable, error estimate, label and SI unit of each panel. FRICTION is for contacts at a speed,
DRIFT for contacts under a force."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw friction over the longest axis, with one line for each value of the other axis.

    For contacts under a force, draw the speed. A band shows the error estimate. Values that did not
    converge are omitted.
    """
    abscissa, *others = sorted(dataset.dims, key=dataset.sizes.__getitem__, reverse=True)
    x, unit = _scaled(dataset[abscissa])
    lines = [dataset]
    if others:
        lines = [dataset.isel({others[0]: index}) for index in range(dataset.sizes[others[0]])]
    forced = "force_N" in dataset and bool(dataset["force_N"].notnull().any())
    shown = DRIFT if forced else FRICTION
    figure = look.new_figure(look.SINGLE, 0.4 + 1.9 * len(shown))
    axes = figure.subplots(len(shown), 1, sharex=True, squeeze=False)[:, 0]
    for panel, (variable, error, label, si) in zip(axes, shown, strict=True):
        factor, prefixed = look.prefixed(dataset[variable].fillna(0.0).values, si)
        for line, (color, marker, ls) in zip(lines, look.LINES, strict=False):
            title = "".join(_title(line[other]) for other in others)
            y, band = (
                line[one].where(line["converged"] == 1) / factor for one in (variable, error)
            )
            panel.fill_between(x, y - band, y + band, color=color, alpha=0.2, lw=0, gid="error")
            panel.plot(x, y, color=color, ls=ls, marker=marker, ms=2.4, lw=1.0, label=title)
        panel.set_ylabel(f"{label}({prefixed or 'dimensionless'})")
        panel.set_ylim(bottom=0.0)
        if len(shown) > 1:
            panels.heading(panel)
    panels.logarithmic_if_wide(axes[-1], x)
    axes[-1].set_xlabel(f"{dataset[abscissa].attrs['long_name']} ({unit or 'dimensionless'})")
    if others:
        axes[0].legend(loc="best", fontsize=look.SMALLEST)
    return figure


def _scaled(axis: xr.DataArray) -> tuple[np.ndarray, str]:
    """Return the values of an axis in a prefixed unit, and this unit."""
    factor, unit = look.prefixed(axis.values, axis.attrs["units"].removeprefix("1"))
    return axis.values / factor, unit


def _title(value: xr.DataArray) -> str:
    """Return the title of a line, such as "load 10 N"."""
    number, unit = _scaled(value)
    return f"{value.attrs['long_name']} {float(number):.4g} {unit}".strip()
