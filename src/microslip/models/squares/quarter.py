"""The convolution of fields that are even along both axes, from a quarter of them.

A field of 2 m cells that is even about the middle and zero beyond its edge has a cosine transform
(type II) in place of a Fourier transform: that of the m cells of one half, padded to L, which is
half of what the whole is padded to.  A Fourier transform of length L gives it, if the even cells
come first and the odd ones after them in reverse (Makhoul 1980): with its values Z at the
frequencies k and L - k, and t = pi k / (2 L),

    2 C_k = exp(-i t) Z_k + exp(i t) Z_{L-k},      Z_k = exp(i t) (C_k - i C_{L-k}),      Z_0 = C_0.

All of this is linear, so that one complex transform serves two real fields at once.  The influence
coefficients are even, too, and so the cosine transform of a displacement is that of the tractions
times theirs.  Rows are in the order of transform.py; the first one has the frequency 0.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel


class Folding(NamedTuple):
    """Rows of the cells and of the frequencies of a quarter, padded to L rows.

    Attributes
    ----------
    place : np.ndarray, shape (L,)
        Row of each cell before the transform.
    opposite : np.ndarray, shape (L,)
        Row of the frequency L - k for each row, its own for k = 0.
    turn : np.ndarray, shape (2, L)
        cos and sin of pi k / (2 L) for each row.
    """

    place: np.ndarray
    opposite: np.ndarray
    turn: np.ndarray


def folding(order: np.ndarray, opposite: np.ndarray) -> Folding:
    """The Folding of rows whose frequencies after the transform are `order`, those of the opposite
    ones in the rows `opposite`; shape (L,) each."""
    cells = np.arange(len(order))
    place = np.where(cells % 2 == 0, cells // 2, len(order) - 1 - cells // 2)
    angle = np.pi * order / (2 * len(order))
    return Folding(place, opposite, np.stack([np.cos(angle), np.sin(angle)]))


def folded_filter(transform: np.ndarray, opposite: np.ndarray) -> np.ndarray:
    """The filter for `apply_filter`: half sums and half differences of opposite rows.

    Half the sum of two opposite rows stands in the first of them, half their difference in the
    other.  transform: the cosine transform of the coefficients, (L, L), with the rows along the
    second axis, without the factor that `fold` leaves out.
    """
    rows = np.arange(len(transform))[:, None]
    near, far = 0.5 * transform, 0.5 * transform[opposite]
    pairs = np.where(rows < opposite[:, None], near + far, far - near)
    alone = opposite[:, None] == rows
    return 0.5 * np.where(alone, transform, pairs)


@kernel
def spread(folding: Folding, q: np.ndarray, out: np.ndarray) -> None:
    """Cells of q, (2, m, m), to their rows of out, (2, L, L), and zeros to the others."""
    m, padded = q.shape[1], out.shape[1]
    for part in range(2):
        for row in range(m):
            for column in range(m):
                out[part, folding.place[row], column] = q[part, row, column]
        for row in range((m + 1) // 2, padded - m // 2):
            for column in range(m):
                out[part, row, column] = 0.0


@kernel
def gather(folding: Folding, given: np.ndarray, out: np.ndarray) -> None:
    """Cells of out, (2, m, m), from their rows of `given`, (2, L, L)."""
    for part in range(2):
        for row in range(out.shape[1]):
            for column in range(out.shape[2]):
                out[part, row, column] = given[part, folding.place[row], column]


@kernel
def fold(folding: Folding, m: int, given: np.ndarray, out: np.ndarray) -> None:
    """Twice the cosine transform from the Fourier transform in the first m columns of `given`,
    turned round: its columns are rows of out, spread for the next transform; (2, L, L) each."""
    padded = given.shape[1]
    for row in range(padded):
        far, c, s = folding.opposite[row], folding.turn[0, row], folding.turn[1, row]
        for column in range(m):
            x, y = given[0, row, column], given[1, row, column]
            u, v = given[0, far, column], given[1, far, column]
            cell = folding.place[column]
            out[0, cell, row] = c * (x + u) + s * (y - v)
            out[1, cell, row] = c * (y + v) + s * (u - x)
    for part in range(2):
        for row in range((m + 1) // 2, padded - m // 2):
            for column in range(padded):
                out[part, row, column] = 0.0


@kernel
def unfold(folding: Folding, m: int, given: np.ndarray, out: np.ndarray) -> None:
    """The Fourier transform, turned back, from the cosine transform in the rows of m cells."""
    padded = given.shape[1]
    for column in range(m):
        cell = folding.place[column]
        out[0, 0, column], out[1, 0, column] = given[0, cell, 0], given[1, cell, 0]
    for row in range(1, padded):
        far, c, s = folding.opposite[row], folding.turn[0, row], folding.turn[1, row]
        for column in range(m):
            cell = folding.place[column]
            x = given[0, cell, row] + given[1, cell, far]
            y = given[1, cell, row] - given[0, cell, far]
            out[0, row, column], out[1, row, column] = c * x - s * y, c * y + s * x


@kernel
def apply_filter(folding: Folding, coefficients: np.ndarray, values: np.ndarray) -> None:
    """Multiply the cosine transform along the first axis of `values`, (2, L, L), which holds the
    Fourier transform before and after; coefficients: see folded_filter.

    For factors f_k of C_k, with h the half of f_k + f_{L-k} and d that of f_k - f_{L-k}, this is
    h Z_k + d exp(2 i t) Z_{L-k} in place of Z_k, h Z_{L-k} + d exp(-2 i t) Z_k in that of Z_{L-k}.
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
