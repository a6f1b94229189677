"""Linear operators on the fields of a contact, for compiled code.

A field has the shape (2, rows, columns): forward and lateral component at the points of a contact.
An operator is an object of a class that a module registers with `operator`.  `Matrix` is the one
of rings: it acts on each row of each component alike.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numba.extending import overload

from microslip.foundation.compiled import OPTIONS, kernel

_KERNELS = {}
"""Class of an operator -> kernel(operator, field, image)."""


def operator(of: type) -> Callable:
    """Decorator of the kernel(operator, field, image) that applies operators of a NamedTuple."""

    def register(function):
        _KERNELS[of] = function
        return function

    return register


def multiply(operator: object, field: np.ndarray, image: np.ndarray) -> None:
    """image = operator field, in compiled code; both (2, rows, columns)."""
    raise NotImplementedError("multiply is for compiled code")


@overload(multiply, jit_options=OPTIONS | {"cache": False})
def _multiply(operator, field, image):
    apply = _KERNELS[operator.instance_class]
    return lambda operator, field, image: apply(operator, field, image)


class Matrix(NamedTuple):
    """A matrix on the columns of a field.

    Attributes
    ----------
    blocks : np.ndarray, shape (ceil(n / 4), n, 4)
        blocks[h, j, k] = matrix[4 h + k, j], zero beyond the last row: four rows are one vector.
    """

    blocks: np.ndarray


def matrix_operator(matrix: np.ndarray) -> Matrix:
    """The Matrix of an array of shape (n, n)."""
    n = len(matrix)
    padded = np.zeros((-(-n // 4) * 4, n))
    padded[:n] = matrix
    return Matrix(np.ascontiguousarray(padded.reshape(-1, 4, n).transpose(0, 2, 1)))


@operator(Matrix)
@kernel(fastmath={"contract"})
def multiply_matrix(operator: Matrix, field: np.ndarray, image: np.ndarray) -> None:
    """image[c, j] = matrix field[c, j]."""
    blocks, n = operator.blocks, field.shape[2]
    for j in range(field.shape[1]):
        for h in range(n // 4):
            a0 = a1 = a2 = a3 = b0 = b1 = b2 = b3 = 0.0
            for k in range(n):
                x, y = field[0, j, k], field[1, j, k]
                a0 += blocks[h, k, 0] * x
                a1 += blocks[h, k, 1] * x
                a2 += blocks[h, k, 2] * x
                a3 += blocks[h, k, 3] * x
                b0 += blocks[h, k, 0] * y
                b1 += blocks[h, k, 1] * y
                b2 += blocks[h, k, 2] * y
                b3 += blocks[h, k, 3] * y
            i = 4 * h
            image[0, j, i] = a0
            image[0, j, i + 1] = a1
            image[0, j, i + 2] = a2
            image[0, j, i + 3] = a3
            image[1, j, i] = b0
            image[1, j, i + 1] = b1
            image[1, j, i + 2] = b2
            image[1, j, i + 3] = b3
        h = n // 4
        for i in range(4 * h, n):
            x = y = 0.0
            for k in range(n):
                x += blocks[h, k, i - 4 * h] * field[0, j, k]
                y += blocks[h, k, i - 4 * h] * field[1, j, k]
            image[0, j, i], image[1, j, i] = x, y
