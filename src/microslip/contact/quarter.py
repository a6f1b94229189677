"""Convolution of fields that are even along both axes, computed from a quarter of the cells.

The Fourier transform of an even field of 2 m cells is a cosine transform (type II) of the m cells
in one half.  These m cells are padded to the length L, which is half the padded length of the whole
field.  A Fourier transform of length L gives the cosine transform, if cells with even numbers come
first and the others follow in reverse order (Makhoul 1980).  With the values Z of this Fourier
transform at the frequencies k and L - k, and t = pi k / (2 L),

    2 C_k = exp(-i t) Z_k + exp(i t) Z_{L-k},      Z_k = exp(i t) (C_k - i C_{L-k}),      Z_0 = C_0.

All steps are linear, so one complex transform handles two real fields at once.  The influence
coefficients are even as well.  Hence the cosine transform of the displacement is that of the
tractions times that of the influence coefficients.  Rows are in the order of transform.py, in which
the first row has the frequency 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel


class Folding(NamedTuple):
    """Order of the cells and frequencies in a quarter.  The quarter is padded to L rows.

    Attributes
    ----------
    place : np.ndarray, shape (L,)
        Row of each cell in the input of the transform.
    opposite : np.ndarray, shape (L,)
        For the row of the frequency k, the row of the frequency L - k; the same row if k = 0.
    turn : np.ndarray, shape (2, L)
        cos and sin of pi k / (2 L) for each row.
    """

    place: np.ndarray
    opposite: np.ndarray
    turn: np.ndarray


def folding(order: np.ndarray, opposite: np.ndarray) -> Folding:
    """Create the Folding of a transform with L rows.

    order: frequency of each row, (L,).  opposite: for each row, the row with the opposite
    frequency, (L,).
    """
    cells = np.arange(len(order))
    place = np.where(cells % 2 == 0, cells // 2, len(order) - 1 - cells // 2)
    angle = np.pi * order / (2 * len(order))
    return Folding(place, opposite, np.stack([np.cos(angle), np.sin(angle)]))


def folded_filter(transform: np.ndarray, opposite: np.ndarray) -> np.ndarray:
    """Compute the coefficients (L, L) for `apply_filter` from the cosine transform of influence
    coefficients.

    Of two opposite rows, the first contains half the sum of both, and the second contains half the
    difference.  transform: cosine transform (L, L), with the rows along the second axis and without
    the factor 2 of `fold`.
    """
    rows = np.arange(len(transform))[:, None]
    near, far = 0.5 * transform, 0.5 * transform[opposite]
    pairs = np.where(rows < opposite[:, None], near + far, far - near)
    alone = opposite[:, None] == rows
    return 0.5 * np.where(alone, transform, pairs)


@kernel
def spread(folding: Folding, q: np.ndarray, out: np.ndarray) -> None:
    """Copy the cells of `q`, (2, m, m), to their rows in `out`, (2, L, L), and zeros to the other
    rows."""
    m, padded = q.shape[1], out.shape[1]
    for part in range(2):
        for row in range(m):
            for column in range(m):
                out[part, folding.place[row], column] = q[part, row, column]
        for row in range((m + 1) // 2, padded - m // 2):
            for column in range(m):
                out[part, row, column] = 0.0


@kernel
def gather(folding: Folding, values: np.ndarray, out: np.ndarray) -> None:
    """Fill the cells of `out`, (2, m, m), from their rows in `values`, (2, L, L)."""
    for part in range(2):
        for row in range(out.shape[1]):
            for column in range(out.shape[2]):
                out[part, row, column] = values[part, folding.place[row], column]


@kernel
def fold(folding: Folding, m: int, values: np.ndarray, out: np.ndarray) -> None:
    """Fill `out` with twice the cosine transform, transposed.  The first m columns of `values`
    contain the Fourier transform.

    The rows of `out` have the order that the next transform needs.  Both arrays have the shape (2,
    L, L).
    """
    padded = values.shape[1]
    for row in range(padded):
        far, c, s = folding.opposite[row], folding.turn[0, row], folding.turn[1, row]
        for column in range(m):
            x, y = values[0, row, column], values[1, row, column]
            u, v = values[0, far, column], values[1, far, column]
            cell = folding.place[column]
            out[0, cell, row] = c * (x + u) + s * (y - v)
            out[1, cell, row] = c * (y + v) + s * (u - x)
    for part in range(2):
        for row in range((m + 1) // 2, padded - m // 2):
            for column in range(padded):
                out[part, row, column] = 0.0


@kernel
def unfold(folding: Folding, m: int, values: np.ndarray, out: np.ndarray) -> None:
    """Compute the Fourier transform from the cosine transform of m rows.  `out` receives the
    Fourier transform, transposed back."""
    padded = values.shape[1]
    for column in range(m):
        cell = folding.place[column]
        out[0, 0, column], out[1, 0, column] = values[0, cell, 0], values[1, cell, 0]
    for row in range(1, padded):
        far, c, s = folding.opposite[row], folding.turn[0, row], folding.turn[1, row]
        for column in range(m):
            cell = folding.place[column]
            x = values[0, cell, row] + values[1, cell, far]
            y = values[1, cell, row] - values[0, cell, far]
            out[0, row, column], out[1, row, column] = c * x - s * y, c * y + s * x


@kernel
def apply_filter(folding: Folding, coefficients: np.ndarray, values: np.ndarray) -> None:
    """Multiply the cosine transform along the first axis by coefficients, in place.

    values: Fourier transform Z, (2, L, L); coefficients: from `folded_filter`.  If f_k are the
    factors of C_k, h = (f_k + f_{L-k}) / 2 and d = (f_k - f_{L-k}) / 2, then Z_k becomes
    h Z_k + d exp(2 i t) Z_{L-k}, and Z_{L-k} becomes h Z_{L-k} + d exp(-2 i t) Z_k.
    """
    re, im = values
    for row in range(re.shape[0]):
        far, c, s = folding.opposite[row], folding.turn[0, row], folding.turn[1, row]
        if row == far:
            for k in range(re.shape[1]):
                re[row, k] *= coefficients[row, k]
                im[row, k] *= coefficients[row, k]
        elif row < far:
            c, s = c * c - s * s, 2.0 * c * s
            for k in range(re.shape[1]):
                x, y, u, v = re[row, k], im[row, k], re[far, k], im[far, k]
                h, d = coefficients[row, k], coefficients[far, k]
                re[row, k], im[row, k] = h * x + d * (c * u - s * v), h * y + d * (c * v + s * u)
                re[far, k], im[far, k] = h * u + d * (c * x + s * y), h * v + d * (c * y - s * x)
