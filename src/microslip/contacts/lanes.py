"""Sixteen neighbouring numbers, as four vectors of four, in compiled code.

The compiler makes vector instructions of tuples of four numbers, as long as it knows that indices
are not negative: they count from the beginning of an array.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel

LANES = 16
"""Numbers at a time: two times four vectors are as many sums as the processor adds up at once."""
NOTHING = (0.0, 0.0, 0.0, 0.0)


@kernel(inline="always")
def four(values: np.ndarray, first: int) -> tuple:
    """Four numbers of a row."""
    return values[first], values[first + 1], values[first + 2], values[first + 3]


@kernel(fastmath={"contract"})
def plus(total: tuple, numbers: tuple, factor: float) -> tuple:
    """total + factor numbers."""
    return (
        total[0] + numbers[0] * factor,
        total[1] + numbers[1] * factor,
        total[2] + numbers[2] * factor,
        total[3] + numbers[3] * factor,
    )


@kernel(inline="always")
def put(values: np.ndarray, a: tuple, b: tuple, c: tuple, d: tuple) -> None:
    """Fill a row of sixteen numbers."""
    values[0], values[1], values[2], values[3] = a
    values[4], values[5], values[6], values[7] = b
    values[8], values[9], values[10], values[11] = c
    values[12], values[13], values[14], values[15] = d
