"""Compiled Fourier transform for convolution.py, along the first axis of two real arrays.

Butterflies of 2, 3 and 4 rows run over whole rows.  The compiler turns these loops into vector
instructions.  The rows of a butterfly are `part` rows apart; `a` is the first row, and `w` is the
index of the first root of unity.
"""

from __future__ import annotations

import numpy as np

from microslip.contact.operators import fused
from microslip.foundation.compiled import kernel

Parts = tuple[np.ndarray, np.ndarray]
"""Real and imaginary part."""


@kernel
def forward(
    re: np.ndarray, im: np.ndarray, columns: int, radices: np.ndarray, roots: np.ndarray
) -> None:
    """Transform the first `columns` columns in place; the order of rows is `convolution._order`."""
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
def backward(
    re: np.ndarray, im: np.ndarray, columns: int, radices: np.ndarray, roots: np.ndarray
) -> None:
    """Apply the inverse of `forward`, multiplied by the number of rows."""
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


@kernel(inline="always")
def _product(re: float, im: float, c: float, s: float) -> tuple[float, float]:
    """(re + i im) (c + i s)."""
    return fused(re, c, -im * s), fused(re, s, im * c)


@kernel(inline="always")
def _forward_2(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
    re, im = values
    c1, s1 = roots[0, w], -roots[1, w]
    b = a + part
    for k in range(columns):
        x, y = re[a, k] - re[b, k], im[a, k] - im[b, k]
        re[a, k] += re[b, k]
        im[a, k] += im[b, k]
        re[b, k], im[b, k] = _product(x, y, c1, s1)


@kernel(inline="always")
def _backward_2(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
    re, im = values
    c1, s1 = roots[0, w], roots[1, w]
    b = a + part
    for k in range(columns):
        x, y = _product(re[b, k], im[b, k], c1, s1)
        re[b, k], im[b, k] = re[a, k] - x, im[a, k] - y
        re[a, k] += x
        im[a, k] += y


_SIN_60 = np.sqrt(0.75)


@kernel(inline="always")
def _forward_3(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
    re, im = values
    c1, s1, c2, s2 = roots[0, w], -roots[1, w], roots[0, 2 * w], -roots[1, 2 * w]
    b, c = a + part, a + 2 * part
    for k in range(columns):
        xr, xi = re[b, k] + re[c, k], im[b, k] + im[c, k]
        yr, yi = _SIN_60 * (im[b, k] - im[c, k]), _SIN_60 * (re[c, k] - re[b, k])
        zr, zi = re[a, k] - 0.5 * xr, im[a, k] - 0.5 * xi
        re[a, k] += xr
        im[a, k] += xi
        re[b, k], im[b, k] = _product(zr + yr, zi + yi, c1, s1)
        re[c, k], im[c, k] = _product(zr - yr, zi - yi, c2, s2)


@kernel(inline="always")
def _backward_3(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
    re, im = values
    c1, s1, c2, s2 = roots[0, w], roots[1, w], roots[0, 2 * w], roots[1, 2 * w]
    b, c = a + part, a + 2 * part
    for k in range(columns):
        br, bi = _product(re[b, k], im[b, k], c1, s1)
        cr, ci = _product(re[c, k], im[c, k], c2, s2)
        yr, yi = _SIN_60 * (ci - bi), _SIN_60 * (br - cr)
        zr, zi = re[a, k] - 0.5 * (br + cr), im[a, k] - 0.5 * (bi + ci)
        re[a, k] += br + cr
        im[a, k] += bi + ci
        re[b, k], im[b, k] = zr + yr, zi + yi
        re[c, k], im[c, k] = zr - yr, zi - yi


@kernel(inline="always")
def _forward_4(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
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
        re[b, k], im[b, k] = _product(fr + hr, fi + hi, c1, s1)
        re[c, k], im[c, k] = _product(er - gr, ei - gi, c2, s2)
        re[d, k], im[d, k] = _product(fr - hr, fi - hi, c3, s3)


@kernel(inline="always")
def _backward_4(values: Parts, columns: int, a: int, part: int, roots: np.ndarray, w: int) -> None:
    re, im = values
    c1, s1, c2, s2 = roots[0, w], roots[1, w], roots[0, 2 * w], roots[1, 2 * w]
    c3, s3 = roots[0, 3 * w], roots[1, 3 * w]
    b, c, d = a + part, a + 2 * part, a + 3 * part
    for k in range(columns):
        br, bi = _product(re[b, k], im[b, k], c1, s1)
        cr, ci = _product(re[c, k], im[c, k], c2, s2)
        dr, di = _product(re[d, k], im[d, k], c3, s3)
        er, ei = re[a, k] + cr, im[a, k] + ci
        fr, fi = re[a, k] - cr, im[a, k] - ci
        gr, gi = br + dr, bi + di
        hr, hi = di - bi, br - dr
        re[a, k], im[a, k] = er + gr, ei + gi
        re[b, k], im[b, k] = fr + hr, fi + hi
        re[c, k], im[c, k] = er - gr, ei - gi
        re[d, k], im[d, k] = fr - hr, fi - hi
