"""The convolution of fields with one symmetry, from a half of them, the rows ahead of the middle.

- TURN, of translations: a field is its own image under a half turn.  Of n cells along a side,
  those in the row -i are those in the row i from behind, and so is their transform along the
  lateral axis: w^((n-1) k) times that at the frequency -k, w = exp(-2 pi i / P).
- MIRROR, of rotations about a point of the lateral axis: behind it forward parts are the same, and
  lateral ones have the opposite sign.  With lateral + i forward as one complex field, the row -i is
  minus the conjugate of the row i, and its transform that of the transform at -k.

So half of the rows are transformed along the lateral axis, and half of the lateral frequencies
along the forward axis: the values at -k come out in the other half of the cells.

The influence on the conjugate traction needs its transform.  After a half turn the transforms of
real fields are real but for the phase e of the centre, so that it is e^2 times the conjugate of the
transform, at the same frequency.  In the mirror image it is -w^((n-1) k) times the transform at the
forward frequency -k.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel

TURN, MIRROR = "half turn", "mirror image"
"""The symmetries."""


class Halving(NamedTuple):
    """Which H lateral frequencies are kept, and what their images are multiplied by.

    Attributes
    ----------
    rows, images : np.ndarray, shape (H,)
        Row of each one in the lateral transform, and row of its negative.
    turn : np.ndarray, shape (2, H)
        Real and imaginary part of the factor.
    sign : float
        That of its product's imaginary part: -1 for the conjugate, in the mirror image.
    """

    rows: np.ndarray
    images: np.ndarray
    turn: np.ndarray
    sign: float


def halving(order: np.ndarray, opposite: np.ndarray, cells: int, symmetry: str) -> Halving:
    """The Halving of a transform with the frequencies `order` in its rows, and those of the
    opposite sign in the rows `opposite`, shape (P,) each, for so many cells along a side."""
    rows = np.flatnonzero(np.arange(len(order)) <= opposite)
    mirror = symmetry == MIRROR
    turn = np.full(len(rows), -1.0 + 0j) if mirror else _turn(order[rows], cells, len(order))
    return Halving(rows, opposite[rows], np.stack([turn.real, turn.imag]), -1.0 if mirror else 1.0)


def halved_filter(
    transforms: Sequence[np.ndarray], order: np.ndarray, rows: np.ndarray, cells: int, symmetry: str
) -> tuple[np.ndarray, np.ndarray]:
    """The two factors of a convolution of half the squares, shape (P, H) each.

    The first one multiplies the transform.  The second one multiplies the conjugate of the
    transform, or in the mirror image the opposite row of the transform.  transforms: those of the
    influence coefficients, (P, P), forward frequency first.
    """
    direct, cross = (part[np.ix_(order, order[rows])] for part in transforms)
    forward, lateral = (_turn(part, cells, len(order)) for part in (order, order[rows]))
    return direct, cross * forward[:, None] * (-1.0 if symmetry == MIRROR else lateral)


def _turn(frequencies: np.ndarray, cells: int, padded: int) -> np.ndarray:
    return np.exp(-2j * np.pi * ((cells - 1) * frequencies % padded) / padded)


@kernel
def turned(q: np.ndarray, out: np.ndarray) -> None:
    """Cells of q, (2, m, n), to columns of out, (2, P, H), lateral part first, zeros below."""
    m, n = q.shape[1], q.shape[2]
    for part in range(2):
        for row in range(n):
            for column in range(m):
                out[part, row, column] = q[1 - part, column, row]
        for row in range(n, out.shape[1]):
            for column in range(m):
                out[part, row, column] = 0.0


@kernel
def turned_back(given: np.ndarray, out: np.ndarray) -> None:
    """Undo `turned`."""
    for part in range(2):
        for row in range(out.shape[1]):
            for column in range(out.shape[2]):
                out[1 - part, row, column] = given[part, column, row]


@kernel
def completed(halving: Halving, m: int, given: np.ndarray, out: np.ndarray) -> None:
    """All 2 m rows along the forward axis, at the frequencies that are kept, from the lateral
    transform of m rows, which are columns of `given`; zeros below; (2, P, H) each."""
    for column in range(len(halving.rows)):
        near, far = halving.rows[column], halving.images[column]
        c, s = halving.turn[0, column], halving.turn[1, column]
        for row in range(m):
            out[0, m + row, column] = given[0, near, row]
            out[1, m + row, column] = given[1, near, row]
            x, y = given[0, far, row], given[1, far, row]
            out[0, m - 1 - row, column] = c * x - s * y
            out[1, m - 1 - row, column] = halving.sign * (c * y + s * x)
    for part in range(2):
        for row in range(2 * m, out.shape[1]):
            for column in range(out.shape[2]):
                out[part, row, column] = 0.0


@kernel
def halved(halving: Halving, m: int, given: np.ndarray, out: np.ndarray) -> None:
    """Undo `completed`."""
    for column in range(len(halving.rows)):
        near, far = halving.rows[column], halving.images[column]
        c, s = halving.turn[0, column], halving.turn[1, column]
        for row in range(m):
            x, y = given[0, m - 1 - row, column], given[1, m - 1 - row, column]
            out[0, far, row] = c * x + s * y
            out[1, far, row] = halving.sign * (c * y - s * x)
            out[0, near, row] = given[0, m + row, column]
            out[1, near, row] = given[1, m + row, column]


@kernel
def multiply_turned(direct: np.ndarray, cross: np.ndarray, values: np.ndarray) -> None:
    """values = direct values + cross conj(values), complex as (2, P, H)."""
    for i in range(values.shape[1]):
        for k in range(values.shape[2]):
            x, y = values[0, i, k], values[1, i, k]
            values[0, i, k] = (direct[i, k] + cross[0, i, k]) * x + cross[1, i, k] * y
            values[1, i, k] = (direct[i, k] - cross[0, i, k]) * y + cross[1, i, k] * x


@kernel
def multiply_mirrored(
    direct: np.ndarray, cross: np.ndarray, opposite: np.ndarray, values: np.ndarray
) -> None:
    """values = direct values + cross times those in the opposite rows, complex as (2, P, H)."""
    for i in range(values.shape[1]):
        far = opposite[i]
        if i <= far:
            for k in range(values.shape[2]):
                x, y, u, v = values[0, i, k], values[1, i, k], values[0, far, k], values[1, far, k]
                a, b = cross[0, i, k], cross[1, i, k]
                values[0, i, k] = direct[i, k] * x + (a * u - b * v)
                values[1, i, k] = direct[i, k] * y + (a * v + b * u)
                a, b = cross[0, far, k], cross[1, far, k]
                values[0, far, k] = direct[far, k] * u + (a * x - b * y)
                values[1, far, k] = direct[far, k] * v + (a * y + b * x)
