"""First guesses of the tractions at the end of a stage, from what was before."""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.coulomb import shrink
from microslip.models.rings.tangent import ON_BOUND

LONGEST_STRETCH = 3.0
"""Longest extrapolation of tractions, over the stage that it is taken from."""


@kernel
def follow(q: np.ndarray, bound: np.ndarray, now: np.ndarray, before: np.ndarray) -> None:
    """First guess: move q as another march moved its tractions in the same stage.

    Rings that slipped there are taken to slip here in the same direction.
    """
    for i in range(len(bound)):
        x, y = now[0, i], now[1, i]
        limit = bound[i] * ON_BOUND
        if x * x + y * y < limit * limit:
            x += q[0, i] - before[0, i]
            y += q[1, i] - before[1, i]
            f = shrink(x, y, bound[i])
            x, y = x * f, y * f
        q[0, i], q[1, i] = x, y


@kernel
def extrapolate(
    q: np.ndarray, last: np.ndarray, bound: np.ndarray, before: np.ndarray, ratio: float
) -> None:
    """First guess: go on as from `before` to q, `ratio` times as far; slip stays slip.

    last, bound: those that q obeys, and that the guess shall.
    """
    for i in range(len(bound)):
        x, y = q[0, i], q[1, i]
        limit = last[i] * ON_BOUND
        slips = x * x + y * y >= limit * limit
        x += ratio * (x - before[0, i])
        y += ratio * (y - before[1, i])
        size = np.sqrt(x * x + y * y)
        if size > bound[i] or (slips and size > 0.0):
            x, y = x * bound[i] / size, y * bound[i] / size
        q[0, i], q[1, i] = x, y


@kernel
def stretch(displacements: np.ndarray, at: int) -> float:
    """Length of the stage that ends at `at` over that of the stage before, at most 3."""
    before = np.hypot(
        displacements[at - 1, 0] - displacements[at - 2, 0],
        displacements[at - 1, 1] - displacements[at - 2, 1],
    )
    length = np.hypot(
        displacements[at, 0] - displacements[at - 1, 0],
        displacements[at, 1] - displacements[at - 1, 1],
    )
    return length / before if length < LONGEST_STRETCH * before else LONGEST_STRETCH


@kernel
def within(q: np.ndarray, bound: np.ndarray) -> None:
    """Shrink q onto the bound."""
    for i in range(len(bound)):
        f = shrink(q[0, i], q[1, i], bound[i])
        q[0, i], q[1, i] = q[0, i] * f, q[1, i] * f
