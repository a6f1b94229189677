"""Maps of several sweeps side by side, with one scale of colours."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from microslip.report.figures import style as look
from microslip.report.figures.formulas import mathtext
from microslip.report.figures.map_panel import computed_points, fill, shows_points, unconverged

COLUMNS = {1: 1, 2: 2, 4: 2}
"""Columns of panels by their number; more than these have three."""
HEIGHT, AROUND = {1: 3.4, 2: 2.5, 3: 1.75}, 0.45
"""Height in inches of a row of panels, by the number of columns, and of what is around them."""
CONTOURS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
"""Fewer than on a large map, and fewer with a number, which would hide the others."""
LABELLED = np.array([0.1, 0.5, 0.9])
BEYOND = 0.01
"""Friction below 0 or above 1 by more than this is no error of the points."""
MOST = 12
"""Maps that a figure has room for, as `load.MOST_PANELS`."""


def spans_a_map(dataset: xr.Dataset) -> bool:
    """Whether there is an area to draw."""
    positive = int((dataset["velocity"] > 0).sum())
    return dataset.sizes.get("amplitude", 0) > 1 and positive > 1


def draw(name: str, datasets: Sequence[xr.Dataset], titles: Sequence[str]) -> Figure:
    """Draw a panel for each dataset, headed by its title, which may hold mathtext."""
    if len(datasets) > MOST:
        raise ValueError(f"figure {name}: {len(datasets)} maps; allowed: up to {MOST}")
    columns = COLUMNS.get(len(datasets), 3)
    rows = -(-len(datasets) // columns)
    width = look.DOUBLE if columns > 1 else 0.65 * look.DOUBLE
    height = rows * HEIGHT[columns] + AROUND
    figure = look.new_figure(width, height)
    fills, contours, labelled = levels_of(datasets)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    hatched = 0
    letters = look.letters(len(datasets))
    for axes, letter, dataset, title in zip(panels, letters, datasets, titles, strict=False):
        # Where the contact drives itself, the contour of 0 is next to that of 0.1, and worth more.
        spare = 0.1 if float(dataset["mu_macro"].min()) < -BEYOND else None
        numbered = labelled[labelled != spare]
        filled, unsure = fill(axes, dataset, fills, contours, numbered, look.SMALLEST)
        hatched += unsure
        axes.set_gid("map")
        room = 0.8 * width / columns - 0.1
        look.letter(axes, letter, title, room)
    for axes in panels[len(datasets) :]:
        axes.remove()
    used = list(panels[: len(datasets)])
    _label(figure, used, datasets, columns, height / rows)
    ticks = fills[np.isclose(np.round(5 * fills), 5 * fills)]
    bar = figure.colorbar(filled, ax=used, pad=0.02, aspect=20 * rows, ticks=ticks)
    bar.set_label(look.FRICTION if rows > 1 or columns < 3 else look.FRICTION.replace("  (", "\n("))
    bar.ax.tick_params(direction="out")
    handles: list[Artist] = [computed_points()] if any(map(shows_points, used)) else []
    handles += [unconverged("not converged")] if hatched else []
    if handles:
        figure.legend(handles=handles, loc="outside lower right", ncols=len(handles))
    return figure


def levels_of(datasets: Sequence[xr.Dataset]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Levels of bands that hold all values, from 0 to 1 and as far beyond as there are any; of
    contours; of contours with a number."""
    low = min(float(dataset["mu_macro"].min()) for dataset in datasets)
    high = max(float(dataset["mu_macro"].max()) for dataset in datasets)
    low = np.floor(10 * low) if low < -BEYOND else 0.0
    high = np.ceil(10 * high) if high > 1 + BEYOND else 10.0
    fills = np.linspace(low / 10, high / 10, round(2 * (high - low)) + 1)
    if low == 0:
        return fills, CONTOURS, LABELLED
    contours = np.concatenate([-CONTOURS[::-1], [0.0], CONTOURS])
    contours = contours[contours > fills[0]]
    return fills, contours, contours[np.isin(contours, [-0.7, -0.3, 0.0, *LABELLED])]


def _label(
    figure: Figure, panels: list[Axes], datasets: Sequence[xr.Dataset], columns: int, height: float
) -> None:
    """Name an axis once where all panels have the same, and at each of them where not."""
    for dim, quantity in (("velocity", "forward velocity"), ("amplitude", "amplitude")):
        texts = [mathtext(dataset[dim].attrs.get("formula", "")) for dataset in datasets]
        shared = len(set(texts)) == 1
        setter = "set_xlabel" if dim == "velocity" else "set_ylabel"
        if shared:
            write = figure.supxlabel if dim == "velocity" else figure.supylabel
            write(f"{quantity}  {texts[0]}".strip(), fontsize=look.RC["axes.labelsize"])
            continue
        room = look.DOUBLE / columns - 0.7 if dim == "velocity" else height - 0.5
        for axes, text in zip(panels, texts, strict=True):
            getattr(axes, setter)(look.wrapped(text or quantity, room, 7.5), fontsize=7.5)
