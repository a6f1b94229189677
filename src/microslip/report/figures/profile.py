"""Performance profiles of models and methods: the share of points that each does at what cost."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.report.figures import style as look
from microslip.report.figures import ticks
from microslip.report.figures.data import require
from microslip.report.figures.lines import LOOKS

VARIABLES = ("competitor", "competitor_contest", "profile_ratio", "map_tolerance")
NAMES = {"auto": "chosen by tolerance", "paper": "paper's run"}
"""Labels of the competitors that have a name of their own."""
COLUMNS, ROW = 2, 3.1
LEAST_RANGE = 10.0
"""End of the axis if nothing is more expensive than the best."""


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw a panel for each contest, at the tightest of the tolerances."""
    require(name, "accuracy_cost", dataset, VARIABLES)
    if not dataset.sizes["point"] or not dataset.sizes["competitor"]:
        raise ValueError(f"figure {name}: the dataset holds no points or no trials")
    tightest = int(np.argmin(dataset["map_tolerance"].values))
    dataset = dataset.isel(map_tolerance=tightest)
    of_contest = dataset["competitor_contest"].values.astype(str)
    contests = list(dict.fromkeys(of_contest))
    rows = -(-len(contests) // COLUMNS)
    figure = look.new_figure(look.DOUBLE, ROW * rows)
    panels = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    letters = look.letters(len(contests))
    tolerance = look.power_of_ten(float(dataset["map_tolerance"]))
    for axes, letter, contest in zip(panels, letters, contests, strict=False):
        _panel(axes, dataset.isel(competitor=of_contest == contest), contest == contests[0])
        note = rf"{contest}, error within ${tolerance}$"
        look.legend_above(axes, letter, note)
    for axes in panels[len(contests) :]:
        axes.remove()
    return figure


def _panel(axes: Axes, contest: xr.Dataset, of_models: bool) -> None:
    """A rising line for each competitor: the share of points within a ratio of the best."""
    ratios = contest["profile_ratio"].transpose("competitor", "point").values
    high = 1.3 * max(ratios[np.isfinite(ratios)].max(initial=1.0), LEAST_RANGE)
    names = contest["competitor"].values.astype(str)
    # What ships first, in black; then as the dataset has them.
    order = np.argsort(names != "shipped", kind="stable")
    for place, index in enumerate(order):
        at = np.sort(ratios[index][np.isfinite(ratios[index])])
        label = NAMES.get(names[index], names[index])
        color, _, _ = LOOKS[place % len(LOOKS)]
        linestyle = LOOKS[(place + place // len(LOOKS)) % len(LOOKS)][2]
        if of_models and names[index] in look.MODELS:
            color, *_ = look.model(names[index])
            linestyle = look.DOTTED if color == look.BLACK else linestyle  # solid is what is chosen
        if names[index] == "auto":
            color, linestyle = look.BLACK, look.SOLID
        axes.plot(
            [1.0, *at, high],
            np.array([0, *range(1, at.size + 1), at.size]) / ratios.shape[1],
            drawstyle="steps-post",
            color=color,
            linestyle=linestyle,
            linewidth=1.8 if names[index] in ("shipped", "auto") else 1.3,
            label=label if at.size else f"{label}: never",
            gid=f"profile {names[index]}",
        )
    axes.set(xscale="log", xlim=(1.0, high))
    ticks.logarithmic(axes.xaxis, 8)
    axes.set_xlabel(r"CPU time over the least  $t/t_\mathrm{best}$")
    axes.set_ylabel("share of points  (dimensionless)")
    look.unit_range(axes)
