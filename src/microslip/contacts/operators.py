"""Linear operators on the fields of a contact, for compiled code.

A field has the shape (2, points), with a forward and a lateral component.  A module registers a
class of operators with `operator`.  An object of such a class contains several operators: number 0
is A, which maps tractions to displacements, and the others are the resolvents for the step
solver.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from microslip.contacts.lanes import LANES, NOTHING, four, plus_multiple, put
from microslip.foundation.compiled import kernel

_KERNELS: dict[type, Callable] = {}
"""Class of operators -> kernel(operators, number, field, image)."""


def operator(of: type) -> Callable:
    """Decorator that registers kernel(operators, number, field, image).  of: class of the
    operators, a NamedTuple.

    The kernel fills `image` with an operator applied to `field`.
    """

    def register(function: Callable) -> Callable:
        _KERNELS[of] = function
        return function

    return register


def multiply(operators: object, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """Fill `image` with an operator applied to `field`, in compiled code.

    Both have the shape (2, points).
    """
    raise NotImplementedError("multiply is for compiled code")


# without type hints, because Numba compares the signature with that of the lambda
@overload(multiply, inline="always")
def _multiply(operators, number, field, image):  # type: ignore[no-untyped-def]
    apply = _KERNELS[operators.instance_class]
    return lambda operators, number, field, image: apply(operators, number, field, image)


class Matrices(NamedTuple):
    """Matrices that act on the rows of a field; all rows have the same width.

    Attributes
    ----------
    blocks : np.ndarray, shape (operators, rows, chunks, columns, LANES)
        blocks[number, row, h, k] contains LANES rows of column k of a matrix, starting at the row
        `start(h, width)`.
    """

    blocks: np.ndarray

    def own(self) -> Matrices:
        """Return the object itself, which has no scratch arrays."""
        return self


def scaled(blocks: np.ndarray, factor: float) -> np.ndarray:
    """Return the blocks (operators, ...) with A multiplied by the factor and the resolvents divided
    by it."""
    factors = np.full(len(blocks), 1.0 / factor)
    factors[0] = factor
    return blocks * factors.reshape(-1, *(1,) * (blocks.ndim - 1))


@kernel(inline="always")
def start(chunk: int, width: int) -> int:
    """First row of a chunk; the last chunk can overlap the previous one."""
    return min(LANES * chunk, width - LANES)


def packed(matrices: np.ndarray, width: int) -> np.ndarray:
    """Convert matrices (..., n, n) to Matrices.blocks, for rows with at least LANES columns."""
    *shape, n, _ = matrices.shape
    padded = np.zeros((*shape, width, n))
    padded[..., :n, :] = matrices
    firsts = [min(first, width - LANES) for first in range(0, width, LANES)]
    chunks = [np.moveaxis(padded[..., first : first + LANES, :], -2, -1) for first in firsts]
    return np.ascontiguousarray(np.stack(chunks, axis=-3))


@operator(Matrices)
@kernel
def multiply_rows(operators: Matrices, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """Set image[c, row] = matrix[row] field[c, row]."""
    _, rows, chunks, columns, _ = operators.blocks.shape
    width = field.shape[1] // rows
    for row in range(rows):
        blocks, at = operators.blocks[number, row], row * width
        forward, lateral = field[0, at:], field[1, at:]
        for chunk in range(chunks):
            a = b = c = d = e = f = g = h = NOTHING
            for k in range(columns):
                x, y = forward[k], lateral[k]
                m = four(blocks[chunk, k], 0)
                a, e = plus_multiple(a, m, x), plus_multiple(e, m, y)
                m = four(blocks[chunk, k], 4)
                b, f = plus_multiple(b, m, x), plus_multiple(f, m, y)
                m = four(blocks[chunk, k], 8)
                c, g = plus_multiple(c, m, x), plus_multiple(g, m, y)
                m = four(blocks[chunk, k], 12)
                d, h = plus_multiple(d, m, x), plus_multiple(h, m, y)
            first = at + start(chunk, width)
            put(image[0, first : first + LANES], a, b, c, d)
            put(image[1, first : first + LANES], e, f, g, h)
