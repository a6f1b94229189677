"""Ticks of logarithmic axes: as many labels as have room, on ranges of any length."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axis import Axis
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
    """Powers of ten; on short ranges 1, 2, 5 times these, or numbers in equal steps."""

    def __init__(self, most: int):
        super().__init__(numticks=most)
        self._most = most

    def tick_values(self, vmin: float, vmax: float) -> np.ndarray:
        """The places of ticks between both ends."""
        low, high = sorted((vmin, vmax))
        room = max(2, min(self._most, self.axis.get_tick_space() if self.axis else self._most))
        if not 0.0 < low < high < np.inf or _inside(_powers(low, high, (1,)), low, high) > 1:
            return super().tick_values(vmin, vmax)
        for factors in ((1, 3), (1, 2, 5), (1, 5)):
            ticks = _powers(low, high, factors)
            if 2 <= _inside(ticks, low, high) <= room:
                return ticks
        return MaxNLocator(nbins=room - 1, steps=[1, 2, 5, 10]).tick_values(low, high)


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


def _powers(low: float, high: float, factors: tuple[int, ...]) -> np.ndarray:
    """Multiples of powers of ten, from below `low` to above `high`."""
    exponents = np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
    return np.ravel(10.0 ** exponents[:, None] * np.array(factors))


def _inside(ticks: np.ndarray, low: float, high: float) -> int:
    """How many of the ticks lie between both ends, up to rounding."""
    return int(((ticks >= low * (1 - 1e-9)) & (ticks <= high * (1 + 1e-9))).sum())
