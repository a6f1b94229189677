"""Ticks of logarithmic axes: as many labels as have room, on ranges of any length."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib import rcParams
from matplotlib.axis import Axis
from matplotlib.font_manager import FontProperties
from matplotlib.ticker import Formatter, LogLocator, MaxNLocator, NullFormatter

from microslip.report.figures import style as look


def logarithmic(axis: Axis, ticks: int = 12) -> None:
    """Label a logarithmic axis with at most so many numbers, and no more than have room.

    Powers of ten, or within a range that holds less than two of them rounder numbers in between.
    """
    axis.set_major_locator(LogarithmicTicks(ticks))
    axis.set_major_formatter(LogarithmicLabels())
    axis.set_minor_formatter(NullFormatter())


class LogarithmicTicks(LogLocator):
    """Powers of ten, or some of them; on short ranges multiples of these, or numbers in equal
    steps: the first of these with at most so many labels that have room."""

    def __init__(self, most: int):
        super().__init__(numticks=most)
        self._most = most

    # an array, as of all of Matplotlib's, the hints of which say that it is a sequence
    def tick_values(self, vmin: float, vmax: float) -> Any:
        """The places of ticks between both ends."""
        low, high = sorted((vmin, vmax))
        if not 0.0 < low < high < np.inf:
            return np.asarray(super().tick_values(vmin, vmax))
        every = [
            ticks
            for ticks in _candidates(low, high, self._most)
            if 2 <= _inside(ticks, low, high).sum() <= self._most
        ]
        fitting = (ticks for ticks in every if self._have_room(ticks, low, high))
        widest = every[-1] if every else np.asarray(super().tick_values(vmin, vmax))
        return next(fitting, widest)

    def _have_room(self, ticks: np.ndarray, low: float, high: float) -> bool:
        """Whether neighbouring labels are at least the height of a letter apart."""
        axis: Any = self.axis  # whose name is missing in the hints of Matplotlib
        if axis is None:
            return True
        name, box = axis.axis_name, axis.axes.bbox
        sizes_of = {"x": rcParams["xtick.labelsize"], "y": rcParams["ytick.labelsize"]}
        size = FontProperties(size=sizes_of[name]).get_size_in_points()
        letter, measure = size / 72.0, look.measurer(size)
        within = _inside(ticks, low, high)
        texts = axis.get_major_formatter().format_ticks(ticks)
        sizes = np.array(
            [
                measure(text) if name == "x" else letter
                for text, is_shown in zip(texts, within, strict=True)
                if is_shown
            ]
        )
        length = (box.width if name == "x" else box.height) / axis.get_figure(root=True).dpi
        places = length * np.log(ticks[within] / low) / np.log(high / low)
        return bool((np.diff(places) >= 0.5 * (sizes[1:] + sizes[:-1]) + letter).all())


class LogarithmicLabels(Formatter):
    """Powers of ten where all labels of an axis are such, else plain numbers."""

    def format_ticks(self, values: Sequence[float]) -> list[str]:
        """The labels of all ticks of an axis."""
        powers = np.log10([place for place in values if place > 0.0])
        plain = not np.allclose(powers, np.round(powers), atol=1e-9)
        return [self(x) if plain else f"$10^{{{np.log10(x):.0f}}}$" for x in values]

    def __call__(self, x: float, pos: int | None = None) -> str:
        """The label of one tick."""
        return f"${x:.6g}$" if 1e-3 <= x < 1e4 else f"${look.number(x)}$"


def _candidates(low: float, high: float, most: int) -> Iterator[np.ndarray]:
    """Ticks from below `low` to above `high`, from what is best to what has fewest labels."""
    exponents = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    powers = 10.0**exponents
    if _inside(powers, low, high).sum() > 1:
        for stride in range(1, len(powers)):
            yield powers[exponents % stride == 0]
    else:
        for factors in ((1, 2, 5), (1, 3), (1, 5), (2,), (3,), (5,)):
            yield np.ravel(powers[:, None] * np.array(factors))
    for count in range(most - 1, 0, -1):
        steps = MaxNLocator(nbins=count, steps=[1, 2, 5, 10], min_n_ticks=1)
        yield np.asarray(steps.tick_values(low, high))


def _inside(ticks: np.ndarray, low: float, high: float) -> np.ndarray:
    """Which of the ticks lie between both ends, up to rounding."""
    return (ticks >= low * (1 - 1e-9)) & (ticks <= high * (1 + 1e-9))
