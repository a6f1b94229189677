"""Convolution of fields with one symmetry, from the rows with a positive forward coordinate.

- TURN, for translations: a half turn leaves a field unchanged.  With n cells along a side, row -i
  is row i in reverse order.  At the frequency k, the transform of row -i along the lateral axis is
  w^((n-1) k) times the transform of row i at -k, with w = exp(-2 pi i / P).
- MIRROR, for rotations about a point on the lateral axis: in the mirror image, forward parts are
  equal, and lateral parts have the opposite sign.  With the complex field lateral + i forward, row
  -i is minus the conjugate of row i.  At the frequency k, the transform of row -i is minus the
  conjugate of the transform of row i at -k.

So only half of the rows are transformed along the lateral axis.  Then half of the lateral
frequencies are transformed along the forward axis.  The values at the other frequencies give the
other half of the cells.

The influence of the conjugate traction requires the transform of the conjugate.  Under a half turn,
the transform of a real field is real, except for the phase e of the centre.  The transform of the
conjugate is therefore e^2 times the conjugate of the transform at the same frequency.  Under the
mirror, it is -w^((n-1) k) times the transform at the forward frequency -k.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel

TURN, MIRROR = "half turn", "mirror image"
"""Symmetries of a field."""


class Halving(NamedTuple):
    """The H lateral frequencies that are computed, and factors for the other frequencies.

    Attributes
    ----------
    rows, images : np.ndarray, shape (H,)
        Row of each frequency in the lateral transform, and row of the opposite frequency.
    turn : np.ndarray, shape (2, H)
        Real and imaginary parts of the factor for the opposite frequency.
    sign : float
        Sign of the imaginary part of the product: -1 (conjugate) for the mirror, else 1.
    """

    rows: np.ndarray
    images: np.ndarray
    turn: np.ndarray
    sign: float


def halving(order: np.ndarray, opposite: np.ndarray, cells: int, symmetry: str) -> Halving:
    """Create the Halving of a transform with P rows for `cells` along a side.

    order: frequency of each row, (P,).  opposite: for each row, the row with the opposite
    frequency, (P,).
    """
    rows = np.flatnonzero(np.arange(len(order)) <= opposite)
    mirror = symmetry == MIRROR
    turn = np.full(len(rows), -1.0 + 0j) if mirror else _turn(order[rows], cells, len(order))
    return Halving(rows, opposite[rows], np.stack([turn.real, turn.imag]), -1.0 if mirror else 1.0)


def halved_filter(
    transforms: Sequence[np.ndarray], order: np.ndarray, rows: np.ndarray, cells: int, symmetry: str
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the two factors for the convolution of half of the cells, shape (P, H) each.

    The first factor multiplies the transform.  The second factor multiplies the conjugate of the
    transform for TURN, and the opposite row of the transform for MIRROR.  transforms: transforms of
    the influence coefficients, (P, P), with the forward frequency along the first axis.
    """
    direct, cross = (part[np.ix_(order, order[rows])] for part in transforms)
    forward, lateral = (_turn(part, cells, len(order)) for part in (order, order[rows]))
    return direct, cross * forward[:, None] * (-1.0 if symmetry == MIRROR else lateral)


def _turn(frequencies: np.ndarray, cells: int, padded: int) -> np.ndarray:
    return np.exp(-2j * np.pi * ((cells - 1) * frequencies % padded) / padded)


@kernel
def turned(q: np.ndarray, out: np.ndarray) -> None:
    """Copy the rows of `q`, (2, m, n), to columns of `out`, (2, P, H).  The lateral part comes
    first, and the rest of each column is set to 0."""
    m, n = q.shape[1], q.shape[2]
    for part in range(2):
        for row in range(n):
            for column in range(m):
                out[part, row, column] = q[1 - part, column, row]
        for row in range(n, out.shape[1]):
            for column in range(m):
                out[part, row, column] = 0.0


@kernel
def turned_back(values: np.ndarray, out: np.ndarray) -> None:
    """Apply the inverse of `turned`."""
    for part in range(2):
        for row in range(out.shape[1]):
            for column in range(out.shape[2]):
                out[1 - part, row, column] = values[part, column, row]


@kernel
def completed(halving: Halving, m: int, values: np.ndarray, out: np.ndarray) -> None:
    """Fill 2 m rows of `out` with all cells along the forward axis, at the H lateral frequencies.

    values: lateral transform of m rows of cells, stored in columns.  Both arrays have the shape (2,
    P, H).  The other rows of `out` become 0.
    """
    for column in range(len(halving.rows)):
        near, far = halving.rows[column], halving.images[column]
        c, s = halving.turn[0, column], halving.turn[1, column]
        for row in range(m):
            out[0, m + row, column] = values[0, near, row]
            out[1, m + row, column] = values[1, near, row]
            x, y = values[0, far, row], values[1, far, row]
            out[0, m - 1 - row, column] = c * x - s * y
            out[1, m - 1 - row, column] = halving.sign * (c * y + s * x)
    for part in range(2):
        for row in range(2 * m, out.shape[1]):
            for column in range(out.shape[2]):
                out[part, row, column] = 0.0


@kernel
def halved(halving: Halving, m: int, values: np.ndarray, out: np.ndarray) -> None:
    """Apply the inverse of `completed`."""
    for column in range(len(halving.rows)):
        near, far = halving.rows[column], halving.images[column]
        c, s = halving.turn[0, column], halving.turn[1, column]
        for row in range(m):
            x, y = values[0, m - 1 - row, column], values[1, m - 1 - row, column]
            out[0, far, row] = c * x + s * y
            out[1, far, row] = halving.sign * (c * y - s * x)
            out[0, near, row] = values[0, m + row, column]
            out[1, near, row] = values[1, m + row, column]


@kernel
def multiply_turned(direct: np.ndarray, cross: np.ndarray, values: np.ndarray) -> None:
    """Set values = direct values + cross conj(values); complex values are stored as (2, P, H)."""
    for i in range(values.shape[1]):
        for k in range(values.shape[2]):
            x, y = values[0, i, k], values[1, i, k]
            values[0, i, k] = (direct[i, k] + cross[0, i, k]) * x + cross[1, i, k] * y
            values[1, i, k] = (direct[i, k] - cross[0, i, k]) * y + cross[1, i, k] * x


@kernel
def multiply_mirrored(
    direct: np.ndarray, cross: np.ndarray, opposite: np.ndarray, values: np.ndarray
) -> None:
    """Set values = direct values + cross times the opposite rows; complex values are stored as (2,
    P, H)."""
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
