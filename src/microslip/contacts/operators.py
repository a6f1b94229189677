"""Linear operators on the fields of a contact, for compiled code.

A field has the shape (2, points): forward and lateral component.  An object of a class that a
module registers with `operator` holds several operators: number 0 is A, from tractions to
displacements, the others, if there are any, are what a step solver needs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from microslip.contacts.lanes import LANES, NOTHING, four, plus_multiple, put
from microslip.foundation.compiled import kernel

_KERNELS: dict[type, Callable] = {}
"""Class of operators -> kernel(operators, number, field, image)."""


def operator(of: type) -> Callable:
    """Decorator of the kernel(operators, number, field, image) that applies an operator of a
    NamedTuple."""

    def register(function: Callable) -> Callable:
        _KERNELS[of] = function
        return function

    return register


def multiply(operators: object, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """image = operator field, in compiled code; both (2, points)."""
    raise NotImplementedError("multiply is for compiled code")


# Numba compares the signature with that of the lambda: it may have no hints
@overload(multiply, inline="always")
def _multiply(operators, number, field, image):  # type: ignore[no-untyped-def]
    apply = _KERNELS[operators.instance_class]
    return lambda operators, number, field, image: apply(operators, number, field, image)


class Matrices(NamedTuple):
    """Matrices on the rows of a field that is cut into rows of equal width.

    Attributes
    ----------
    blocks : np.ndarray, shape (operators, rows, chunks, columns, LANES)
        blocks[number, row, h, k] are rows of a matrix in column k, from row `start(h, width)` on.
    """

    blocks: np.ndarray

    def own(self) -> Matrices:
        """Return the object itself, which has no scratch arrays."""
        return self

    @staticmethod
    def joined(each: Sequence[Matrices], extents: np.ndarray) -> Matrices:
        """The matrices of several contacts on one body, see `scaled`."""
        parts = [scaled(one.blocks, extent) for one, extent in zip(each, extents, strict=True)]
        return Matrices(np.concatenate(parts, axis=1))


def scaled(blocks: np.ndarray, factor: float) -> np.ndarray:
    """Blocks (operators, ...) of a contact whose A is larger by a factor: its resolvents are
    smaller by that."""
    factors = np.full(len(blocks), 1.0 / factor)
    factors[0] = factor
    return blocks * factors.reshape(-1, *(1,) * (blocks.ndim - 1))


@kernel(inline="always")
def start(chunk: int, width: int) -> int:
    """First of the rows of a chunk: the last chunk overlaps the one before."""
    return min(LANES * chunk, width - LANES)


def packed(matrices: np.ndarray, width: int) -> np.ndarray:
    """Matrices (..., n, n) as Matrices.blocks, for rows of a width of at least LANES."""
    *shape, n, _ = matrices.shape
    padded = np.zeros((*shape, width, n))
    padded[..., :n, :] = matrices
    firsts = [min(first, width - LANES) for first in range(0, width, LANES)]
    chunks = [np.moveaxis(padded[..., first : first + LANES, :], -2, -1) for first in firsts]
    return np.ascontiguousarray(np.stack(chunks, axis=-3))


@operator(Matrices)
@kernel
def multiply_rows(operators: Matrices, number: int, field: np.ndarray, image: np.ndarray) -> None:
    """image[c, row] = matrix[row] field[c, row]."""
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
