"""Figures of the accuracy study: performance profiles."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.report.figures import panels
from microslip.report.figures import style as look

NAMES = {"auto": "chosen by tolerance", "paper": "paper's run"}
"""Labels of competitors whose names need an explanation."""
LEAST_RANGE = 10.0
"""The axis of a profile extends at least to this ratio."""


def profile(name: str, dataset: xr.Dataset) -> Figure:
    """Draw performance profiles at the tightest tolerance, with a panel for each contest.

    A profile is the fraction of points that a competitor solves within a cost.
    """
    dataset = dataset.isel(map_tolerance=int(np.argmin(dataset["map_tolerance"].values)))
    of_contest = dataset["competitor_contest"].values.astype(str)
    contests = list(dict.fromkeys(of_contest))
    figure = look.new_figure(look.DOUBLE, 3.1 * -(-len(contests) // 2))
    grid = panels.grid(figure, len(contests), 2)
    tolerance = look.power_of_ten(float(dataset["map_tolerance"]))
    for axes, contest in zip(grid, contests, strict=True):
        _profile(axes, dataset.isel(competitor=of_contest == contest), contest == contests[0])
        panels.legend_above(axes, rf"{contest}, error within ${tolerance}$")
    return figure


def _profile(axes: Axes, contest: xr.Dataset, of_models: bool) -> None:
    """Draw a line for each competitor: fraction of points against ratio of cost to smallest
    cost."""
    ratios = contest["profile_ratio"].transpose("competitor", "point").values
    high = 1.3 * max(ratios[np.isfinite(ratios)].max(initial=1.0), LEAST_RANGE)
    names = contest["competitor"].values.astype(str)
    # The default method is first and black; the others follow in the order of the dataset.
    order = np.argsort(names != "shipped", kind="stable")
    for place, index in enumerate(order):
        name, at = names[index], np.sort(ratios[index][np.isfinite(ratios[index])])
        color = look.LINES[place % len(look.LINES)][0]
        ls = look.LINES[(place + place // len(look.LINES)) % len(look.LINES)][2]
        if of_models and name in look.MODELS:
            color = look.model(name)[0]
            ls = look.DOTTED if color == look.BLACK else ls  # solid black is the line of "auto"
        if name == "auto":
            color, ls = look.BLACK, look.SOLID
        shares = np.array([0, *range(1, at.size + 1), at.size]) / ratios.shape[1]
        ink: look.Ink = {"color": color, "ls": ls, "drawstyle": "steps-post"}
        ink |= {"lw": 1.8 if name in ("shipped", "auto") else 1.3, "gid": f"profile {name}"}
        label = NAMES.get(name, name) + ("" if at.size else ": never")
        axes.plot([1.0, *at, high], shares, label=label, **ink)
    axes.set_ylabel("fraction of points  (dimensionless)")
    axes.set_xlabel(r"CPU time divided by the smallest  $t/t_\mathrm{best}$")
    panels.logarithmic(axes, (1.0, high))
    panels.unit_range(axes)
