"""The atlas of stability: what became of every method in every case, square by square.

One block a quantity that is varied. Blocks side by side share the names of the methods. The page
is laid out in millimetres, since every square must have room for its letter.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from microslip.report.figures import style as look
from microslip.report.figures.atlas_layout import (
    GAP,
    LINE,
    MARGIN,
    MM,
    SIZE,
    SWATCH,
    WIDTH,
    Block,
    layout,
)
from microslip.report.figures.data import require

VARIABLES = ("method", "outcome", "case_axis", "case_label", "axis", "axis_label", "axis_note")
OUTCOMES = {
    1: ("converged", "#CDE7DC", "\N{CHECK MARK}", "#00664A", "as near the reference as it claims"),
    2: ("slow", "#F0B84B", "S", look.BLACK, "gives up within its budget, and says so"),
    3: ("wrong", "#C04F00", "W", "white", "claims to have converged, but misses the reference"),
    4: ("diverged", "#222222", "D", "white", "tractions blew up, or no number came out"),
}
"""Outcomes by their code: name, fill, sign and its colour, meaning. The fills darken from good to
bad, so that they differ in grey as well."""
BLANK = "blank: the method does not apply"


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the atlas, with so many blocks side by side that it fits the page."""
    require(name, "stability", dataset, VARIABLES)
    methods, blocks = _read(name, dataset)
    meanings = [f"{name}: {meaning}" for name, _, _, _, meaning in OUTCOMES.values()]
    plan = layout(methods, blocks, [*meanings, BLANK])
    page = Page(look.new_figure(WIDTH * MM, plan.height * MM, layout=None), plan.height)
    top = MARGIN
    for band in plan.bands:
        start, x = top, plan.left
        top += band.heading_height
        names = [methods[i] for i in band.rows]
        for block in band.blocks:
            axes = page.axes(x, top, plan.column * len(block.labels), plan.row * len(names))
            _squares(axes, block.outcome[band.rows])
            _labels(axes, block, names, first=block is band.blocks[0])
            page.text(x, start, block.title, fontsize=look.HEADING)
            page.text(x, start + block.title_height, block.note, color=look.GREY)
            x += block.width + GAP
        top += plan.row * len(names) + GAP
    corner = (x + GAP, start) if plan.beside else (MARGIN, top)
    _legend(page, *corner, plan.legend)
    return page.figure


def _read(name: str, dataset: xr.Dataset) -> tuple[list[str], list[Block]]:
    """The methods, the shipped one first, and a block for every axis that has cases."""
    outcome = dataset["outcome"].transpose("method", "case").values.astype(int)
    if unknown := sorted(set(outcome.ravel().tolist()) - {0, *OUTCOMES}):
        raise ValueError(f"figure {name}: outcome {unknown[0]} is none of 0 to {max(OUTCOMES)}")
    methods = dataset["method"].values.astype(str)
    first = np.argsort(methods != "shipped", kind="stable")
    of_case = dataset["case_axis"].values.astype(str)
    axes = dataset["axis"].values.astype(str)
    if strays := sorted(set(of_case) - set(axes)):
        raise ValueError(
            f"figure {name}: case_axis {str(strays[0])!r} is not on the dimension 'axis'"
        )
    blocks = []
    for index, axis in enumerate(axes):
        mine = np.flatnonzero(of_case == axis)
        if not mine.size:
            continue
        title, note = (str(dataset[f"axis_{n}"].values[index]) for n in ("label", "note"))
        labels = dataset["case_label"].values.astype(str)[mine].tolist()
        blocks.append(Block(title, note, labels, outcome[np.ix_(first, mine)]))
    if not blocks or not methods.size:
        raise ValueError(f"figure {name}: the dataset holds no cases or no methods")
    return methods[first].tolist(), blocks


class Page:
    """A figure on which things are placed in millimetres from the upper left corner."""

    def __init__(self, figure: Figure, height: float) -> None:
        self.figure, self.height = figure, height

    def axes(self, x: float, y: float, width: float, height: float) -> Axes:
        """Axes with that upper left corner and that size."""
        bottom = 1.0 - (y + height) / self.height
        return self.figure.add_axes((x / WIDTH, bottom, width / WIDTH, height / self.height))

    def text(self, x: float, y: float, text: str, **ink: Any) -> None:
        """A text that hangs from that point."""
        ink = {"va": "top", "fontsize": SIZE, "linespacing": 1.1, **ink}
        self.figure.text(x / WIDTH, 1.0 - y / self.height, text, **ink)


def _squares(axes: Axes, outcome: np.ndarray) -> None:
    """Draw one square a method and case, with its sign; outcome: shape (methods, cases)."""
    axes.pcolormesh(
        np.ma.masked_equal(outcome, 0),
        cmap=ListedColormap([fill for _, fill, *_ in OUTCOMES.values()]),
        vmin=0.5,
        vmax=len(OUTCOMES) + 0.5,
        edgecolors="white",
        linewidth=0.8,
        gid="outcome",
    )
    axes.invert_yaxis()
    for (i, j), code in np.ndenumerate(outcome):
        if code:
            _sign(axes, j + 0.5, i + 0.5, code)
    for spine in axes.spines.values():
        spine.set(color=look.PALE, linewidth=0.5)


def _labels(axes: Axes, block: Block, names: list[str], first: bool) -> None:
    """Write the cases above the squares and, at the first block of a band, the methods beside."""
    cases = len(block.labels)
    axes.set_xticks(np.arange(cases) + 0.5, block.labels, fontsize=SIZE)
    shown = names if first else [""] * len(names)
    axes.set_yticks(np.arange(len(names)) + 0.5, shown, fontsize=SIZE)
    axes.tick_params(length=0, pad=1.5, top=False, labeltop=True, labelbottom=False)
    if block.upright:
        axes.tick_params(axis="x", labelrotation=90)
    if names[0] == "shipped":  # what the rest is compared with stands out
        frame: dict[str, Any] = {
            "facecolor": "none",
            "edgecolor": look.BLACK,
            "linewidth": 1.0,
            "zorder": 4,
        }
        axes.add_patch(Rectangle((0, 0), cases, 1, clip_on=False, **frame))
        axes.get_yticklabels()[0].set_fontweight("bold")


def _sign(axes: Axes, x: float, y: float, code: int) -> None:
    """Write the sign of an outcome into its square."""
    _, _, sign, color, _ = OUTCOMES[code]
    weight = "normal" if code == 1 else "bold"
    axes.text(
        x, y, sign, color=color, fontsize=SIZE, fontweight=weight, ha="center", va="center_baseline"
    )


def _legend(page: Page, x: float, y: float, lines: list[str]) -> None:
    """A square of every outcome with its sign and its meaning."""
    for code, text in enumerate(lines, start=1):
        axes = page.axes(x, y, SWATCH, LINE)
        axes.set(xlim=(0, 1), ylim=(1, 0), xticks=[], yticks=[], label="<legend>")
        if code in OUTCOMES:
            axes.set_facecolor(OUTCOMES[code][1])
            _sign(axes, 0.5, 0.5, code)
        page.text(x + SWATCH + 1.5, y, text)
        y += LINE * (text.count("\n") + 1) + 1.2
