"""The stability atlas: a table with a coloured square for the outcome of each method in each case.

Each varied quantity has a block of rows with a heading.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

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
COLUMN, ROW, FOOT = 0.3, 0.125, 0.95
"""Width of a column, height of a row and of the legend, in inches."""
NOTE = 3.0
"""Width of the notes beside the table, in inches."""


def draw(dataset: xr.Dataset) -> Figure:
    """Draw the outcomes: a row for each case, and a column for each method."""
    outcome = dataset["outcome"].transpose("case", "method").values.astype(int)
    methods = dataset["method"].values.astype(str)
    used = outcome.any(axis=0) | (methods == "shipped")
    order = np.argsort(methods != "shipped", kind="stable")  # the default method is first
    order = order[used[order]]
    of_case, labels = (part.astype(str) for part in columns(dataset, "case_axis", "case_label"))
    rows: list[tuple[str, np.ndarray]] = []
    heads = {}
    for axis, title, note in zip(*columns(dataset, "axis", "axis_label", "axis_note"), strict=True):
        own = np.flatnonzero(of_case == str(axis))
        if own.size:
            rows += [("", np.zeros(0, int))] * (2 if rows else 1)
            heads[len(rows) - 1] = look.literal(str(title)), look.literal(str(note))
            rows += [(labels[case], outcome[case, order]) for case in own]
    count, height = len(order), ROW * len(rows)
    figure = look.new_figure(look.DOUBLE, height + FOOT + 1.2)
    axes = figure.add_subplot(aspect=ROW / COLUMN, anchor="W")
    axes.set(xlim=(0, count + NOTE / COLUMN), ylim=(len(rows), 0))
    for row, (_, codes) in enumerate(rows):
        for column, code in enumerate(codes):
            if code:
                _, fill, sign, color, _ = OUTCOMES[code]
                square: look.Ink = {"fc": fill, "ec": "white", "lw": 0.8, "gid": f"outcome {code}"}
                axes.add_patch(Rectangle((column, row), 1, 1, **square))
                text: look.Ink = {"color": color, "fontsize": look.SMALLEST, "ha": "center"}
                text |= {"fontweight": "normal" if code == 1 else "bold"}
                axes.text(column + 0.5, row + 0.5, sign, va="center_baseline", **text)
    for row, (title, note) in heads.items():
        cases = next((k for k, (label, _) in enumerate(rows) if k > row and not label), len(rows))
        axes.add_patch(Rectangle((0, row + 1), 1, cases - row - 1, fill=False, clip_on=False))
        text = {"va": "center", "fontsize": look.HEADING, "gid": "head"}
        axes.text(0.0, row + 0.5, title, fontweight="bold", **text)
        wide = look.wrapped(note, NOTE - 0.2, look.SMALLEST)
        text = {"va": "top", "fontsize": look.SMALLEST, "color": look.GREY}
        axes.text(count + 0.4, row + 1.0, wide, linespacing=1.1, **text)
    named = [(row + 0.5, label) for row, (label, _) in enumerate(rows) if label]
    axes.set_yticks(*zip(*named, strict=True))
    axes.set_xticks(np.arange(count) + 0.5, methods[order], rotation=90)
    axes.tick_params(length=0, pad=1.5, top=False, labeltop=True, labelbottom=False)
    axes.tick_params(labelsize=look.SMALLEST)
    axes.get_xticklabels()[0].set_fontweight("bold")
    axes.spines[:].set_visible(False)
    handles: list = []
    texts = []
    for name, fill, sign, color, meaning in OUTCOMES.values():
        mark = Line2D([], [], marker=rf"$\bf{{{sign}}}$", color=color, ls="none", ms=5.0, mew=0.0)
        handles.append((Patch(fc=fill), mark))
        texts.append(f"{name}: {meaning}")
    handles.append(Patch(fc="white", ec=look.PALE))
    place: look.Ink = {"loc": "outside lower left", "handlelength": 1.6, "handleheight": 1.1}
    figure.legend(handles, [*texts, BLANK], fontsize=look.SMALLEST, **place)
    return figure
