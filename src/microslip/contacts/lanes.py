"""Vectors of four neighbouring numbers, in compiled code.

The compiler turns operations on tuples of four numbers into vector instructions, if indices are
unsigned.  Kernels are compiled without fastmath, because fastmath would allow the compiler to
reorder and fuse operations.  The last bits of a result would then depend on which kernels were
compiled earlier.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types
from numba.extending import intrinsic

from microslip.foundation.compiled import kernel

LANES = 16
"""Number of neighbouring values that are accumulated at once.  The processor can accumulate two
groups of four vectors in parallel."""
NOTHING = (0.0, 0.0, 0.0, 0.0)


@kernel(inline="always")
def four(values: np.ndarray, first: int) -> tuple:
    """Return four numbers of a row, starting at the index `first` >= 0."""
    i = np.uint64(first)
    return values[i], values[i + np.uint64(1)], values[i + np.uint64(2)], values[i + np.uint64(3)]


@intrinsic
def fused(typing: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a b + c for floats, with a single rounding."""
    if (a, b, c) != (types.float64,) * 3:
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(a, b, c), generate


@kernel(inline="always")
def plus(a: tuple, b: tuple) -> tuple:
    """a + b."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]


@kernel(inline="always")
def minus(a: tuple, b: tuple) -> tuple:
    """a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]


@kernel(inline="always")
def times(a: tuple, b: tuple) -> tuple:
    """a b."""
    return a[0] * b[0], a[1] * b[1], a[2] * b[2], a[3] * b[3]


@kernel(inline="always")
def sum_of(a: tuple) -> float:
    """Sum of the four numbers."""
    return (a[0] + a[1]) + (a[2] + a[3])


@kernel(inline="always")
def plus_multiple(total: tuple, numbers: tuple, factor: float) -> tuple:
    """Return total + factor times numbers."""
    return (
        fused(numbers[0], factor, total[0]),
        fused(numbers[1], factor, total[1]),
        fused(numbers[2], factor, total[2]),
        fused(numbers[3], factor, total[3]),
    )


@kernel(inline="always")
def put(values: np.ndarray, a: tuple, b: tuple, c: tuple, d: tuple) -> None:
    """Fill a row of sixteen numbers with four vectors."""
    values[0], values[1], values[2], values[3] = a
    values[4], values[5], values[6], values[7] = b
    values[8], values[9], values[10], values[11] = c
    values[12], values[13], values[14], values[15] = d
