"""Surface displacement of rectangular cells under tractions, by a compiled FFT convolution.

Zero-padding of each side to at least twice as many cells makes the convolution linear.  The output
of a transform is in digit-reversed order.  The transformed influence coefficients and the input of
the inverse transform have the same order, so that no array is ever sorted.  Butterflies run over
whole rows, so that the compiler generates vector instructions.  The transforms skip rows that are
zero or not needed.

For symmetric fields, it is sufficient to transform a part: a quarter for fields that are even along
both axes (quarter.py), and a half for fields with a half-turn or mirror symmetry (half.py).
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.contact import half, quarter
from microslip.contact.transform import backward, forward
from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR


class Convolution(NamedTuple):
    """Tables of the compiled convolution.

    P is the padded number of cells along a side of the resolved part.  H is the number of lateral
    frequencies.  H equals P, or is smaller if half of the cells are resolved.

    Attributes
    ----------
    radices : np.ndarray
        Factors of P.
    roots : np.ndarray, shape (2, P)
        cos and sin of 2 pi k / P.
    kernel : np.ndarray, shape (P, H)
        Transform of the influence coefficients, which is real; for a quarter of the cells, see
        quarter.folded_filter.
    cross : np.ndarray, shape (2, P, H)
        Transform of the influence coefficients for the conjugate traction, used only if `coupled`;
        for half of the cells, see half.halved_filter.
    coupled : bool
        Whether nu > 0.
    opposite : np.ndarray, shape (P,)
        For each row, the row with the opposite frequency.
    images : int
        Number of cells for each resolved cell: 1 if all are resolved, 2 for a half, 4 for a
        quarter.
    folding : quarter.Folding
        Tables for the convolution of a quarter of the cells.
    halving : half.Halving
        Tables for the convolution of a half of the cells.
    """

    radices: np.ndarray
    roots: np.ndarray
    kernel: np.ndarray
    cross: np.ndarray
    coupled: bool
    opposite: np.ndarray
    images: int
    folding: quarter.Folding
    halving: half.Halving


@lru_cache(maxsize=8)
def square_convolution(
    cells: int,
    poisson: float,
    modulus: float = G_STAR,
    images: int = 1,
    symmetry: str = half.TURN,
    half_widths: tuple[float, float] = (1.0, 1.0),
) -> tuple[Convolution, float, float]:
    """Create the convolution on cells x cells equal cells of a rectangle.

    Parameters
    ----------
    cells : int
        Number of cells along a side; even if `images` is 2 or 4.
    poisson, modulus : float
        Poisson's ratio, and G* in working units.
    images : int
        See Convolution.  If it is 4, fields at nu = 0 are even along both axes, and only squares
        with positive coordinates are resolved.  If it is 2, fields have a symmetry of half.py, and
        only cells with a positive forward coordinate are resolved.
    symmetry : str
        Symmetry of the fields if `images` is 2: half.TURN or half.MIRROR.
    half_widths : tuple of float
        Half of the forward and the lateral width of the rectangle.

    Returns
    -------
    convolution : Convolution
        Tables of the compiled convolution.
    scale : float
        Displacement of a cell under a unit traction on the same cell, in u_lim.
    largest : float
        Upper bound on the eigenvalues of the convolution, in u_lim per unit of traction.
    """
    padded = _padded(cells // 2 if images == 4 else cells)
    radices = _radices(padded)
    turns = 2.0 * np.pi * np.arange(padded) / padded
    order = _order(list(radices))
    opposite = np.argsort(order)[-order % padded]
    whole = 2 * padded if images == 4 else padded
    coefficients = influence(cells, whole, poisson, modulus, half_widths)
    if images == 2 and padded % 2 == 0:
        # the largest offset is its own negative and is never used; 0 keeps the kernel even
        coefficients[1][padded // 2], coefficients[1][:, padded // 2] = 0.0, 0.0
    halving = half.halving(order, opposite, cells, symmetry)
    transforms = [np.fft.fft2(part) for part in coefficients]
    if images == 2:
        kernel, cross = half.halved_filter(transforms, order, halving.rows, cells, symmetry)
    else:
        kernel, cross = (part.T[np.ix_(order, order)] for part in transforms)
    largest = np.abs(kernel).max() + np.abs(cross).max()
    # the inverse transform lacks the factor 1 / P^2
    kernel, cross = (kernel / padded**2).real, cross / padded**2
    convolution = Convolution(
        radices,
        np.stack([np.cos(turns), np.sin(turns)]),
        quarter.folded_filter(kernel, opposite) if images == 4 else np.ascontiguousarray(kernel),
        np.stack([cross.real, cross.imag]),
        poisson > 0.0,
        opposite,
        images,
        quarter.folding(order, opposite),
        halving,
    )
    return convolution, float(coefficients[0][0, 0]), float(largest)


def influence(
    cells: int,
    padded: int,
    poisson: float,
    modulus: float = G_STAR,
    half_widths: tuple[float, float] = (1.0, 1.0),
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the influence coefficients for the traction and for its complex conjugate, (P, P)
    each.

    The kernels of influence.py are integrated over a cell in closed form, and evaluated at
    the centres of cells.  Units are u_lim per unit of traction.  The first axis is the forward
    offset, and the second axis is the lateral offset.  Negative offsets are wrapped around.
    """
    forward, lateral = (2.0 * half_width / cells for half_width in half_widths)
    offsets = np.fft.fftfreq(padded, 1.0 / padded)
    y, x = np.meshgrid(forward * offsets, lateral * offsets, indexing="ij")
    single, squares, product = np.zeros((3, *x.shape))
    for sx in (1, -1):
        for sy in (1, -1):
            u, v = x + sx * lateral / 2, y + sy * forward / 2
            r = np.hypot(u, v)
            log_u, log_v = np.arcsinh(u / np.abs(v)), np.arcsinh(v / np.abs(u))
            # sign(v) v arcsinh(u/|v|) equals v ln(u + r), except for terms that cancel in the sum
            single = single + sx * sy * (u * log_v + v * log_u)
            squares = squares + sx * sy * (v * log_u - u * log_v)
            product = product - sx * sy * r
    scale = 1.0 / (np.pi * modulus)
    kappa = poisson / (2.0 - poisson)
    return scale * single, scale * kappa * (squares + 2j * product)


def _padded(cells: int) -> int:
    """Smallest P >= 2 cells - 1 whose prime factors are 2 and 3."""
    padded = 2 * cells - 1
    while padded != 2 ** _power(padded, 2) * 3 ** _power(padded, 3):
        padded += 1
    return padded


def _power(number: int, prime: int) -> int:
    count = 0
    while number % prime == 0:
        number //= prime
        count += 1
    return count


def _radices(padded: int) -> np.ndarray:
    twos = _power(padded, 2)
    radices = [4] * (twos // 2) + [2] * (twos % 2) + [3] * _power(padded, 3)
    return np.array(radices, dtype=np.int64)  # an integer array even if empty, for a single cell


def _order(radices: list[int]) -> np.ndarray:
    """Frequency of each row after the transform."""
    if not radices:
        return np.zeros(1, dtype=np.int64)
    rest = _order(radices[1:])
    return np.concatenate([k + radices[0] * rest for k in range(radices[0])])


def workspace(operator: Convolution) -> tuple[np.ndarray, np.ndarray]:
    """Scratch arrays of `convolve`, for use by one thread."""
    return np.zeros((2, *operator.kernel.shape)), np.zeros((2, *operator.kernel.shape))


@kernel
def convolve(operator: Convolution, scratch: tuple, q: np.ndarray, out: np.ndarray) -> None:
    """Fill `out` with A q.  `q` and `out` contain forward and lateral parts of the resolved
    squares, (2, rows, columns); scratch: arrays from `workspace`."""
    (first, second), radices, roots = scratch, operator.radices, operator.roots
    columns, width = q.shape[1], second.shape[2]
    _spread(operator, q, first)
    forward(first[0], first[1], columns, radices, roots)
    _turn_over(operator, columns, first, second)
    forward(second[0], second[1], width, radices, roots)
    _multiply(operator, first, second)
    backward(second[0], second[1], width, radices, roots)
    _turn_back(operator, columns, second, first)
    backward(first[0], first[1], columns, radices, roots)
    _gather(operator, first, out)


@kernel
def _spread(operator: Convolution, q: np.ndarray, first: np.ndarray) -> None:
    """Copy tractions to the rows of the first transform, and zeros to the other rows."""
    if operator.images == 4:
        quarter.spread(operator.folding, q, first)
    elif operator.images == 2:
        half.turned(q, first)
    else:
        n = q.shape[1]
        for part in range(2):
            for row in range(first.shape[1]):
                for column in range(n):
                    first[part, row, column] = q[1 - part, row, column] if row < n else 0.0


@kernel
def _turn_over(operator: Convolution, columns: int, first: np.ndarray, second: np.ndarray) -> None:
    """Transpose the array for the transform along the other axis."""
    if operator.images == 4:
        quarter.fold(operator.folding, columns, first, second)
    elif operator.images == 2:
        half.completed(operator.halving, columns, first, second)
    else:
        padded = first.shape[1]
        for part in range(2):
            for column in range(columns):
                for row in range(padded):
                    second[part, column, row] = first[part, row, column]
            for row in range(columns, padded):
                for column in range(padded):
                    second[part, row, column] = 0.0


@kernel
def _multiply(operator: Convolution, first: np.ndarray, second: np.ndarray) -> None:
    """Multiply the transform in `second` by the transform of the influence coefficients; first:
    scratch array."""
    if operator.images == 4:
        quarter.apply_filter(operator.folding, operator.kernel, second)
    elif not operator.coupled:
        for part in range(2):
            for i in range(second.shape[1]):
                for k in range(second.shape[2]):
                    second[part, i, k] *= operator.kernel[i, k]
    elif operator.images == 1:
        copy, values = first.ravel(), second.ravel()
        for i in range(values.size):
            copy[i] = values[i]
        _multiply_coupled(operator, first, second)
    elif operator.halving.sign < 0.0:
        half.multiply_mirrored(operator.kernel, operator.cross, operator.opposite, second)
    else:
        half.multiply_turned(operator.kernel, operator.cross, second)


@kernel
def _turn_back(operator: Convolution, columns: int, second: np.ndarray, first: np.ndarray) -> None:
    """Undo `_turn_over`."""
    if operator.images == 4:
        quarter.unfold(operator.folding, columns, second, first)
    elif operator.images == 2:
        half.halved(operator.halving, columns, second, first)
    else:
        for part in range(2):
            for row in range(first.shape[1]):
                for column in range(columns):
                    first[part, row, column] = second[part, column, row]


@kernel
def _gather(operator: Convolution, first: np.ndarray, out: np.ndarray) -> None:
    """Undo `_spread`."""
    if operator.images == 4:
        quarter.gather(operator.folding, first, out)
    elif operator.images == 2:
        half.turned_back(first, out)
    else:
        for part in range(2):
            for row in range(out.shape[1]):
                for column in range(out.shape[2]):
                    out[part, row, column] = first[1 - part, row, column]


@kernel
def _multiply_coupled(operator: Convolution, values: np.ndarray, out: np.ndarray) -> None:
    """Fill `out` with `kernel` times the transform of the traction, plus `cross` times the
    transform of its conjugate."""
    padded = values.shape[1]
    for i in range(padded):
        far = operator.opposite[i]
        for k in range(padded):
            real = values[0, far, operator.opposite[k]]
            imag = -values[1, far, operator.opposite[k]]
            cr, ci = operator.cross[0, i, k], operator.cross[1, i, k]
            out[0, i, k] = operator.kernel[i, k] * values[0, i, k] + cr * real - ci * imag
            out[1, i, k] = operator.kernel[i, k] * values[1, i, k] + cr * imag + ci * real
