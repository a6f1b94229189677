"""Surface displacement of square cells under tractions: compiled convolution by FFT.

The convolution is made linear by zero-padding each side to at least twice as many cells.  A
transform leaves its output in the order in which it was computed (digit-reversed), the inverse
starts from there, and the transformed kernel sits in the same order, so that nothing is ever
sorted.  Butterflies run over whole rows, which the compiler turns into vector instructions, and
rows that are known to be zero, or of no interest, are left out.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR


class Convolution(NamedTuple):
    """All that the compiled convolution needs; P: padded cells along a side.

    radices: factors of P; roots: cos and sin of 2 pi k / P, (2, P); kernel: transform of the
    influence coefficients, real, (P, P); cross: transform of those on the conjugate traction,
    (2, P, P), used only if ``coupled``; opposite: row of minus the frequency of each row, (P,).
    """

    radices: np.ndarray
    roots: np.ndarray
    kernel: np.ndarray
    cross: np.ndarray
    coupled: bool
    opposite: np.ndarray


@lru_cache(maxsize=8)
def square_convolution(cells, poisson, modulus=G_STAR):
    """Convolution of ``cells`` x ``cells`` squares over [-1, 1]^2, their self-influence, and an
    upper bound on the eigenvalues (u_lim per unit traction); modulus: G* in working units."""
    padded = _padded(cells)
    radices = _radices(padded)
    turns = 2.0 * np.pi * np.arange(padded) / padded
    order = _order(list(radices))
    coefficients = influence(cells, padded, poisson, modulus)
    kernel, cross = (np.fft.fft2(part).T[np.ix_(order, order)] for part in coefficients)
    largest = np.abs(kernel).max() + np.abs(cross).max()
    # each factor of the inverse transform brings its size along: divide once, here
    kernel, cross = kernel / padded**2, cross / padded**2
    operator = Convolution(
        radices,
        np.stack([np.cos(turns), np.sin(turns)]),
        np.ascontiguousarray(kernel.real),
        np.stack([cross.real, cross.imag]),
        poisson > 0.0,
        np.argsort(order)[-order % padded],
    )
    return operator, float(coefficients[0][0, 0]), float(largest)


def influence(cells, padded, poisson, modulus=G_STAR):
    """Influence coefficients on the traction and on its conjugate, (P, P) each; u_lim per unit
    traction, first axis forward, second lateral offset, negative offsets wrapped around.

    Closed forms of the kernels of rings/influence.py, integrated over a square, at cell centres.
    """
    size = 2.0 / cells
    offsets = np.fft.fftfreq(padded, 1.0 / padded) * size
    y, x = np.meshgrid(offsets, offsets, indexing="ij")
    single, squares, product = 0.0, 0.0, 0.0
    for sx in (1, -1):
        for sy in (1, -1):
            u, v = x + sx * size / 2, y + sy * size / 2
            r = np.hypot(u, v)
            log_u, log_v = np.arcsinh(u / np.abs(v)), np.arcsinh(v / np.abs(u))
            # sign(v) v arcsinh(u/|v|) is v ln(u + r) up to terms that cancel in the differences
            single = single + sx * sy * (u * log_v + v * log_u)
            squares = squares + sx * sy * (v * log_u - u * log_v)
            product = product - sx * sy * r
    scale = 1.0 / (np.pi * modulus)
    kappa = poisson / (2.0 - poisson)
    return scale * single, scale * kappa * (squares + 2j * product)


def _padded(cells):
    """Smallest P >= 2 cells - 1 with factors 2 and 3 only."""
    padded = 2 * cells - 1
    while padded != 2 ** _power(padded, 2) * 3 ** _power(padded, 3):
        padded += 1
    return padded


def _power(number, prime):
    count = 0
    while number % prime == 0:
        number //= prime
        count += 1
    return count


def _radices(padded):
    twos = _power(padded, 2)
    return np.array([4] * (twos // 2) + [2] * (twos % 2) + [3] * _power(padded, 3))


def _order(radices):
    """Frequency in each row after the transform."""
    if not radices:
        return np.zeros(1, dtype=np.int64)
    rest = _order(radices[1:])
    return np.concatenate([k + radices[0] * rest for k in range(radices[0])])


def workspace(operator):
    """Scratch arrays of ``convolve``: reusable, not shared between threads."""
    padded = len(operator.opposite)
    return np.zeros((2, padded, padded)), np.zeros((2, padded, padded))


@kernel
def convolve(operator, scratch, q, out):
    """out = A q; q, out: forward and lateral parts, (2, n, n); scratch: from ``workspace``."""
    n = q.shape[1]
    first, second = scratch
    padded = first.shape[1]
    first[0, :n, :n] = q[1]
    first[1, :n, :n] = q[0]
    first[:, n:, :n] = 0.0
    _forward(first[0], first[1], n, operator.radices, operator.roots)
    for part in range(2):
        for column in range(n):
            for row in range(padded):
                second[part, column, row] = first[part, row, column]
    second[:, n:] = 0.0
    _forward(second[0], second[1], padded, operator.radices, operator.roots)
    if operator.coupled:
        first[:] = second
        _multiply_coupled(operator, first, second)
    else:
        second[0] *= operator.kernel
        second[1] *= operator.kernel
    _backward(second[0], second[1], padded, operator.radices, operator.roots)
    for part in range(2):
        for row in range(padded):
            for column in range(n):
                first[part, row, column] = second[part, column, row]
    _backward(first[0], first[1], n, operator.radices, operator.roots)
    out[0] = first[1, :n, :n]
    out[1] = first[0, :n, :n]


@kernel
def _multiply_coupled(operator, given, out):
    """Kernel times transform, plus cross kernel times the transform of the conjugate traction."""
    padded = given.shape[1]
    for i in range(padded):
        far = operator.opposite[i]
        for k in range(padded):
            real = given[0, far, operator.opposite[k]]
            imag = -given[1, far, operator.opposite[k]]
            cr, ci = operator.cross[0, i, k], operator.cross[1, i, k]
            out[0, i, k] = operator.kernel[i, k] * given[0, i, k] + cr * real - ci * imag
            out[1, i, k] = operator.kernel[i, k] * given[1, i, k] + cr * imag + ci * real


@kernel
def _forward(re, im, columns, radices, roots):
    """Transform the first ``columns`` columns in place; frequencies end up in ``_order``."""
    length = padded = re.shape[0]
    for radix in radices:
        part = length // radix
        for j in range(part):
            w = padded // length * j
            for a in range(j, padded, length):
                if radix == 4:
                    _forward_4((re, im), columns, a, part, roots, w)
                elif radix == 3:
                    _forward_3((re, im), columns, a, part, roots, w)
                else:
                    _forward_2((re, im), columns, a, part, roots, w)
        length = part


@kernel
def _backward(re, im, columns, radices, roots):
    """Undo ``_forward``, up to the factor P."""
    part, padded = 1, re.shape[0]
    for radix in radices[::-1]:
        length = part * radix
        for j in range(part):
            w = padded // length * j
            for a in range(j, padded, length):
                if radix == 4:
                    _backward_4((re, im), columns, a, part, roots, w)
                elif radix == 3:
                    _backward_3((re, im), columns, a, part, roots, w)
                else:
                    _backward_2((re, im), columns, a, part, roots, w)
        part = length


@kernel
def _forward_2(values, columns, a, part, roots, w):
    re, im = values
    c1, s1 = roots[0, w], -roots[1, w]
    b = a + part
    for k in range(columns):
        x, y = re[a, k] - re[b, k], im[a, k] - im[b, k]
        re[a, k] += re[b, k]
        im[a, k] += im[b, k]
        re[b, k], im[b, k] = x * c1 - y * s1, x * s1 + y * c1


@kernel
def _backward_2(values, columns, a, part, roots, w):
    re, im = values
    c1, s1 = roots[0, w], roots[1, w]
    b = a + part
    for k in range(columns):
        x, y = re[b, k] * c1 - im[b, k] * s1, re[b, k] * s1 + im[b, k] * c1
        re[b, k], im[b, k] = re[a, k] - x, im[a, k] - y
        re[a, k] += x
        im[a, k] += y


_SIN_60 = np.sqrt(0.75)


@kernel
def _forward_3(values, columns, a, part, roots, w):
    re, im = values
    c1, s1, c2, s2 = roots[0, w], -roots[1, w], roots[0, 2 * w], -roots[1, 2 * w]
    b, c = a + part, a + 2 * part
    for k in range(columns):
        xr, xi = re[b, k] + re[c, k], im[b, k] + im[c, k]
        yr, yi = _SIN_60 * (im[b, k] - im[c, k]), _SIN_60 * (re[c, k] - re[b, k])
        zr, zi = re[a, k] - 0.5 * xr, im[a, k] - 0.5 * xi
        re[a, k] += xr
        im[a, k] += xi
        re[b, k] = (zr + yr) * c1 - (zi + yi) * s1
        im[b, k] = (zr + yr) * s1 + (zi + yi) * c1
        re[c, k] = (zr - yr) * c2 - (zi - yi) * s2
        im[c, k] = (zr - yr) * s2 + (zi - yi) * c2


@kernel
def _backward_3(values, columns, a, part, roots, w):
    re, im = values
    c1, s1, c2, s2 = roots[0, w], roots[1, w], roots[0, 2 * w], roots[1, 2 * w]
    b, c = a + part, a + 2 * part
    for k in range(columns):
        br, bi = re[b, k] * c1 - im[b, k] * s1, re[b, k] * s1 + im[b, k] * c1
        cr, ci = re[c, k] * c2 - im[c, k] * s2, re[c, k] * s2 + im[c, k] * c2
        yr, yi = _SIN_60 * (ci - bi), _SIN_60 * (br - cr)
        zr, zi = re[a, k] - 0.5 * (br + cr), im[a, k] - 0.5 * (bi + ci)
        re[a, k] += br + cr
        im[a, k] += bi + ci
        re[b, k], im[b, k] = zr + yr, zi + yi
        re[c, k], im[c, k] = zr - yr, zi - yi


@kernel
def _forward_4(values, columns, a, part, roots, w):
    re, im = values
    c1, s1, c2, s2 = roots[0, w], -roots[1, w], roots[0, 2 * w], -roots[1, 2 * w]
    c3, s3 = roots[0, 3 * w], -roots[1, 3 * w]
    b, c, d = a + part, a + 2 * part, a + 3 * part
    for k in range(columns):
        er, ei = re[a, k] + re[c, k], im[a, k] + im[c, k]
        fr, fi = re[a, k] - re[c, k], im[a, k] - im[c, k]
        gr, gi = re[b, k] + re[d, k], im[b, k] + im[d, k]
        hr, hi = im[b, k] - im[d, k], re[d, k] - re[b, k]
        re[a, k], im[a, k] = er + gr, ei + gi
        re[b, k] = (fr + hr) * c1 - (fi + hi) * s1
        im[b, k] = (fr + hr) * s1 + (fi + hi) * c1
        re[c, k] = (er - gr) * c2 - (ei - gi) * s2
        im[c, k] = (er - gr) * s2 + (ei - gi) * c2
        re[d, k] = (fr - hr) * c3 - (fi - hi) * s3
        im[d, k] = (fr - hr) * s3 + (fi - hi) * c3


@kernel
def _backward_4(values, columns, a, part, roots, w):
    re, im = values
    c1, s1, c2, s2 = roots[0, w], roots[1, w], roots[0, 2 * w], roots[1, 2 * w]
    c3, s3 = roots[0, 3 * w], roots[1, 3 * w]
    b, c, d = a + part, a + 2 * part, a + 3 * part
    for k in range(columns):
        br, bi = re[b, k] * c1 - im[b, k] * s1, re[b, k] * s1 + im[b, k] * c1
        cr, ci = re[c, k] * c2 - im[c, k] * s2, re[c, k] * s2 + im[c, k] * c2
        dr, di = re[d, k] * c3 - im[d, k] * s3, re[d, k] * s3 + im[d, k] * c3
        er, ei = re[a, k] + cr, im[a, k] + ci
        fr, fi = re[a, k] - cr, im[a, k] - ci
        gr, gi = br + dr, bi + di
        hr, hi = di - bi, br - dr
        re[a, k], im[a, k] = er + gr, ei + gi
        re[b, k], im[b, k] = fr + hr, fi + hi
        re[c, k], im[c, k] = er - gr, ei - gi
        re[d, k], im[d, k] = fr - hr, fi - hi
