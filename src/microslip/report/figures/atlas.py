"""The stability atlas: a coloured square for the outcome of each method in each case.

Each varied quantity has a block of squares. Each row of blocks shows the names of the methods once.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from microslip.report.figures import panels
from microslip.report.figures import style as look
from microslip.report.figures.data import columns

OUTCOMES = {
    1: ("converged", "#CDE7DC", "\N{CHECK MARK}", "#00664A", "within its error estimate"),
    2: ("slow", "#F0B84B", "S", look.BLACK, "not converged within its budget, as reported"),
    3: ("wrong", "#C04F00", "W", "white", "reported as converged, but too far from the reference"),
    4: ("diverged", "#222222", "D", "white", "diverged, or no result"),
}
"""Outcomes by code: name, fill colour, symbol, symbol colour, meaning. The fill colours darken from
good to bad, so that they also differ in greyscale."""
BLANK = "blank: the method does not apply"
SIZES = ((27, 0.15), (33, 0.15), (33, 0.12), (40, 0.12), (40, 0.105))
"""Layouts to try, best first: number of squares and gaps in a row, height of a square in inches."""
WIDTH, HEIGHT = 6.0, 9.7
"""Total width of the squares in a row, and height of the page, both in inches."""
NARROWEST = 5
"""Smallest width of a block, as a number of squares, so that its heading fits."""
HEAD, FOOT = 0.75, 0.95
"""Heights of a row's headings and of the legend, in inches."""


@dataclass(frozen=True)
class Block:
    """A block of the atlas: title, note, labels of the cases, and outcomes.

    outcome: codes of the outcomes, shape (methods, cases).
    """

    title: str
    note: str
    labels: list[str]
    outcome: np.ndarray

    @property
    def width(self) -> int:
        """Width in squares, including the heading and the gap to the next block."""
        return max(len(self.labels), NARROWEST) + 1


def draw(name: str, dataset: xr.Dataset) -> Figure:
    """Draw the atlas as rows of blocks. A row shows the methods that apply to any of its cases."""
    methods, blocks = _read(dataset)
    for squares, row in SIZES:
        bands = _bands(blocks, squares)
        used = [_methods_of(band) for band in bands]
        height = HEAD * len(bands) + row * sum(map(len, used)) + FOOT
        if height <= HEIGHT:
            break
    figure = look.new_figure(look.DOUBLE, height)
    figure.set_layout_engine("constrained", w_pad=0.0, wspace=0.0, rect=(0.01, 0.0, 0.98, 1.0))
    grid = figure.add_gridspec(len(bands), squares, height_ratios=[len(rows) for rows in used])
    for k, (band, rows) in enumerate(zip(bands, used, strict=True)):
        start = 0
        for block in band:
            axes = figure.add_subplot(grid[k, start : start + len(block.labels)])
            _squares(axes, block.outcome[rows])
            names = [methods[i] for i in rows] if not start else [""] * len(rows)
            _labels(axes, block, names, WIDTH / squares)
            _head(axes, block, WIDTH / squares)
            start += block.width
    figure.align_xlabels()
    figure.align_titles()
    _legend(figure)
    return figure


def _bands(blocks: list[Block], squares: int) -> list[list[Block]]:
    """Divide the blocks, in order, into rows of at most `squares` squares."""
    bands: list[list[Block]] = [[]]
    for block in blocks:
        if bands[-1] and sum(one.width for one in [*bands[-1], block]) > squares + 1:
            bands.append([])
        bands[-1].append(block)
    return bands


def _read(dataset: xr.Dataset) -> tuple[list[str], list[Block]]:
    """Return the methods (the default method first), and a block for every axis with cases."""
    outcome = dataset["outcome"].transpose("method", "case").values.astype(int)
    methods = dataset["method"].values.astype(str)
    first = np.argsort(methods != "shipped", kind="stable")
    of_case, labels = (part.astype(str) for part in columns(dataset, "case_axis", "case_label"))
    blocks = []
    for axis, title, note in zip(*columns(dataset, "axis", "axis_label", "axis_note"), strict=True):
        own = np.flatnonzero(of_case == str(axis))
        if own.size:
            cases = labels[own].tolist(), outcome[np.ix_(first, own)]
            blocks.append(Block(str(title), str(note), *cases))
    return methods[first].tolist(), blocks


def _methods_of(band: list[Block]) -> np.ndarray:
    """Return the indices of the default method and of all methods that apply to a row's cases."""
    used = np.any([(block.outcome != 0).any(axis=1) for block in band], axis=0)
    used[0] = True
    return np.flatnonzero(used)


def _squares(axes: Axes, outcome: np.ndarray) -> None:
    """Draw a square with a symbol for each method and case. outcome: shape (methods, cases)."""
    fills = ListedColormap([fill for _, fill, *_ in OUTCOMES.values()])
    ink: look.Ink = {"vmin": 0.5, "vmax": len(OUTCOMES) + 0.5, "edgecolors": "white", "lw": 0.8}
    axes.pcolormesh(np.ma.masked_equal(outcome, 0), cmap=fills, gid="outcome", **ink)
    axes.invert_yaxis()
    for (i, j), code in np.ndenumerate(outcome):
        if code:
            _, _, sign, color, _ = OUTCOMES[code]
            text: look.Ink = {"color": color, "fontsize": look.SMALLEST, "ha": "center"}
            weight = "normal" if code == 1 else "bold"
            axes.text(j + 0.5, i + 0.5, sign, va="center_baseline", fontweight=weight, **text)
    for spine in axes.spines.values():
        spine.set(color=look.PALE, linewidth=0.5)


def _labels(axes: Axes, block: Block, names: list[str], square: float) -> None:
    """Label the cases above the squares and the methods beside them."""
    cases = len(block.labels)
    upright = max(look.width(label, look.SMALLEST) for label in block.labels) > square - 0.04
    axes.set_xticks(np.arange(cases) + 0.5, block.labels, rotation=90 if upright else 0)
    axes.set_yticks(np.arange(len(names)) + 0.5, names)
    axes.tick_params(length=0, pad=1.5, top=False, labeltop=True, labelbottom=False)
    axes.tick_params(labelsize=look.SMALLEST)
    # The default method has a frame.
    frame: look.Ink = {"fill": False, "ec": look.BLACK, "zorder": 4, "clip_on": False}
    axes.add_patch(Rectangle((0, 0), cases, 1, **frame))
    axes.get_yticklabels()[0].set_fontweight("bold")


def _head(axes: Axes, block: Block, square: float) -> None:
    """Write a block's letter, title and note above its cases."""
    room = (block.width - 1) * square
    panels.heading(axes, block.title, room)
    axes.xaxis.set_label_position("top")
    note = look.wrapped(block.note, room, look.SMALLEST)
    axes.set_xlabel(note, loc="left", color=look.GREY, fontsize=look.SMALLEST)


def _legend(figure: Figure) -> None:
    """Add a legend with the square and the meaning of every outcome."""
    handles: list[Any] = []
    labels = []
    for name, fill, sign, color, meaning in OUTCOMES.values():
        mark = Line2D([], [], marker=rf"$\bf{{{sign}}}$", color=color, ls="none", ms=5.0, mew=0.0)
        handles.append((Patch(fc=fill), mark))
        labels.append(f"{name}: {meaning}")
    blank = Patch(fc="white", ec=look.PALE)
    place: look.Ink = {"loc": "outside lower left", "handlelength": 1.6, "handleheight": 1.1}
    figure.legend([*handles, blank], [*labels, BLANK], fontsize=look.SMALLEST, **place)
