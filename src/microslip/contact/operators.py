"""Compiled elastic operators for contacts that are discretised into rings.

A field is an array of shape (2, points) with the forward and lateral components at the points of a
contact.  The points are ordered by angle, then by ring.  Each angle has `width` points. The points
beyond the last ring are padding, with area 0 and friction bound 0.

An operator acts in three steps.  First, the values at the angles are transformed to amplitudes of
angular waves.  Then the ring values of each wave are multiplied by a matrix.  Finally, the result
is transformed back.  At nu = 0, forward and lateral tractions are decoupled, and form two sectors
with the same matrices.  At nu > 0, there is one sector, in which each matrix couples two
neighbouring waves.  A contact of rings without angular points has one angle and one wave.

The compiler turns operations on tuples of four numbers into vector instructions if indices are
unsigned.  Kernels are compiled without fastmath.  With fastmath, the compiler could reorder and
fuse operations.  The last bits of a result would then depend on the kernels that were compiled
before.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types
from numba.extending import intrinsic

from microslip.foundation.compiled import kernel

LANES = 8
"""Number of neighbouring values that are accumulated at once.  The values form two vectors of
four."""
ZERO = (0.0, 0.0, 0.0, 0.0)


def padded(count: int) -> int:
    """Return the smallest multiple of LANES that is at least `count`."""
    return -(-count // LANES) * LANES


@intrinsic
def fused(typing: Any, a: Any, b: Any, c: Any) -> Any:
    """Return a * b + c for floats, with a single rounding."""
    if (a, b, c) != (types.float64,) * 3:
        return None

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(a, b, c), generate


@kernel(inline="always")
def four(values: np.ndarray, first: int) -> tuple:
    """Return four values of a row, starting at the index `first` >= 0."""
    i = np.uint64(first)
    return values[i], values[i + np.uint64(1)], values[i + np.uint64(2)], values[i + np.uint64(3)]


@kernel(inline="always")
def put(values: np.ndarray, first: int, a: tuple, b: tuple) -> None:
    """Store eight values in a row, starting at the index `first` >= 0."""
    i = np.uint64(first)
    values[i], values[i + np.uint64(1)], values[i + np.uint64(2)], values[i + np.uint64(3)] = a
    i = np.uint64(first + 4)
    values[i], values[i + np.uint64(1)], values[i + np.uint64(2)], values[i + np.uint64(3)] = b


@kernel(inline="always")
def plus(a: tuple, b: tuple) -> tuple:
    """Return a + b for two tuples."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]


@kernel(inline="always")
def plus_multiple(total: tuple, numbers: tuple, factor: float) -> tuple:
    """Return `total` + `factor` * `numbers`."""
    return (
        fused(numbers[0], factor, total[0]),
        fused(numbers[1], factor, total[1]),
        fused(numbers[2], factor, total[2]),
        fused(numbers[3], factor, total[3]),
    )


@kernel(inline="always")
def shrink(forward: float, lateral: float, bound: float) -> float:
    """Return the factor between 0 and 1 that projects the traction (forward, lateral) onto the disc
    |q| <= bound."""
    size = np.sqrt(forward * forward + lateral * lateral)
    # without a branch, so that the compiler can vectorise it
    return min(1.0, bound / max(size, 1e-300))


@kernel
def transform(
    matrix: np.ndarray,
    source: np.ndarray,
    taken: tuple[int, int],
    target: np.ndarray,
    filled: tuple[int, int],
) -> None:
    """Multiply rows of `source` by a matrix, and store the results in rows of `target`.

    Row k of the argument is row `taken[0] + taken[1] * k` of `source`.  Row k of the result is row
    `filled[0] + filled[1] * k` of `target`.  Rows are computed in groups of four. The last group
    can overlap the previous one.
    """
    (begin, stride), (at, step) = taken, filled
    rows, columns = matrix.shape
    for after in range(0, rows, 4):
        row = max(min(after, rows - 4), 0)
        one, two, three = min(row + 1, rows - 1), min(row + 2, rows - 1), min(row + 3, rows - 1)
        r, s, t, u = matrix[row], matrix[one], matrix[two], matrix[three]
        for i in range(0, source.shape[1], LANES):
            a = b = c = d = e = f = g = h = ZERO
            for k in range(columns):
                values = source[begin + stride * k]
                m = four(values, i)
                a, c = plus_multiple(a, m, r[k]), plus_multiple(c, m, s[k])
                e, g = plus_multiple(e, m, t[k]), plus_multiple(g, m, u[k])
                m = four(values, i + 4)
                b, d = plus_multiple(b, m, r[k]), plus_multiple(d, m, s[k])
                f, h = plus_multiple(f, m, t[k]), plus_multiple(h, m, u[k])
            put(target[at + step * row], i, a, b)
            put(target[at + step * one], i, c, d)
            put(target[at + step * two], i, e, f)
            put(target[at + step * three], i, g, h)


@kernel(inline="always")
def multiply_two(matrix: np.ndarray, pair: np.ndarray, image: np.ndarray) -> None:
    """Multiply two vectors, given as an array of shape (2, n), by the transpose of a matrix of even
    size."""
    x, y, first, second = pair[0], pair[1], image[0], image[1]
    for i in range(0, len(x), LANES):
        a = b = c = d = e = f = g = h = ZERO
        for k in range(0, len(x), 2):
            row, p, q = matrix[k], x[k], y[k]
            m = four(row, i)
            a, c = plus_multiple(a, m, p), plus_multiple(c, m, q)
            m = four(row, i + 4)
            b, d = plus_multiple(b, m, p), plus_multiple(d, m, q)
            row, p, q = matrix[k + 1], x[k + 1], y[k + 1]
            m = four(row, i)
            e, g = plus_multiple(e, m, p), plus_multiple(g, m, q)
            m = four(row, i + 4)
            f, h = plus_multiple(f, m, p), plus_multiple(h, m, q)
        put(first, i, plus(a, e), plus(b, f))
        put(second, i, plus(c, g), plus(d, h))


@kernel
def multiply_one(matrix: np.ndarray, x: np.ndarray, image: np.ndarray) -> None:
    """Multiply a vector by the transpose of a matrix of even size."""
    for i in range(0, len(x), LANES):
        a = b = c = d = ZERO
        for k in range(0, len(x), 2):
            row, other = matrix[k], matrix[k + 1]
            a, b = plus_multiple(a, four(row, i), x[k]), plus_multiple(b, four(row, i + 4), x[k])
            c = plus_multiple(c, four(other, i), x[k + 1])
            d = plus_multiple(d, four(other, i + 4), x[k + 1])
        put(image, i, plus(a, c), plus(b, d))


@kernel
def multiply(
    operators: tuple, number: int, field: np.ndarray, image: np.ndarray, waves: np.ndarray
) -> None:
    """Apply an operator to `field`, and store the result in `image`.

    Parameters
    ----------
    operators : tuple of np.ndarray
        Three arrays.  `to_waves`, of shape (sectors, waves, rows), transforms values at the angles
        to amplitudes of the waves, and `to_points`, of shape (sectors, rows, waves), transforms
        back.  The third array, of shape (operators, matrices, columns, columns), contains the
        transposed matrix of each wave (nu = 0) or of each pair of waves (nu > 0).
    number : int
        Index of the operator in the third array.
    field, image : np.ndarray, shape (2, points)
        Argument and result of the operator.
    waves : np.ndarray, shape (2, waves sectors, width)
        Scratch array for the amplitudes before and after the multiplication.
    """
    to_waves, to_points, every = operators
    matrices = every[number]
    sectors, count, rows = to_waves.shape
    if count == 1:
        multiply_two(matrices[0], field, image)
        return
    width = waves.shape[2]
    source, target = field.reshape(-1, width), image.reshape(-1, width)
    for sector in range(sectors):
        transform(to_waves[sector], source, (sector * rows, 1), waves[0], (sector, sectors))
    parts = waves.reshape(2, len(matrices), 2, -1)
    for k in range(len(matrices)):
        if sectors == 2:
            multiply_two(matrices[k], parts[0, k], parts[1, k])
        else:
            multiply_one(matrices[k], parts[0, k].ravel(), parts[1, k].ravel())
    for sector in range(sectors):
        transform(to_points[sector], waves[1], (sector, sectors), target, (sector * rows, 1))
