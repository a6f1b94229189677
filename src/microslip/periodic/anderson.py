"""Compiled Anderson acceleration of a fixed-point map (Walker and Ni 2011)."""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel

DEPTH = 12
"""Number of stored differences.  Of the values 5, 8 and 12, this one needs the fewest marches for
bores and loops."""
DEPENDENT = 1e-8
"""Each difference is split into a linear combination of newer differences and an orthogonal part.
The difference is dropped if the norm of the orthogonal part is below this fraction of the full
norm.  The value is about the square root of the rounding error."""


@kernel
def accelerated(pairs: np.ndarray, count: int, scale: np.ndarray) -> np.ndarray:
    """Return the combination of the stored images that has the smallest change.

    The least-squares problem is solved by modified Gram-Schmidt, starting with the newest
    difference.  `pairs` contains pairs of an image and a change.  The newest pair is the last one.
    `scale` multiplies the changes in the least-squares norm; its shape and that of the result are
    (n,).
    """
    images, changes = pairs[0], pairs[1]
    last, n = count - 1, len(scale)
    out = np.empty(n)
    basis, triangle = np.empty((count, n)), np.zeros((count, count))
    projection, source, residual = np.zeros(count), np.zeros(count, np.int64), np.empty(n)
    for i in range(n):
        out[i] = images[last, i]
        residual[i] = changes[last, i] * scale[i]
    size = 0
    for j in range(last - 1, -1, -1):
        column, whole = basis[size], 0.0
        for i in range(n):
            column[i] = (changes[j + 1, i] - changes[j, i]) * scale[i]
            whole += column[i] ** 2
        for k in range(size):
            share = 0.0
            for i in range(n):
                share += basis[k, i] * column[i]
            triangle[k, size] = share
            for i in range(n):
                column[i] -= share * basis[k, i]
        rest = 0.0
        for i in range(n):
            rest += column[i] ** 2
        if not rest > DEPENDENT**2 * whole:
            continue
        length, share = np.sqrt(rest), 0.0
        for i in range(n):
            column[i] /= length
            share += column[i] * residual[i]
        for i in range(n):
            residual[i] -= share * column[i]
        triangle[size, size], projection[size], source[size] = length, share, j
        size += 1
    for k in range(size - 1, -1, -1):
        factor = projection[k]
        for p in range(k + 1, size):
            factor -= triangle[k, p] * projection[p]
        projection[k] = factor / triangle[k, k]
    for k in range(size):
        j, factor = source[k], projection[k]
        for i in range(n):
            out[i] -= factor * (images[j + 1, i] - images[j, i])
    return out
