"""The kernels G_m and C_m of influence.py at two radii, for all angular modes at once."""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel

ACCURACY = 1e-10
"""Relative accuracy of the kernels, much better than the accuracy of their averages over rings."""
MOST_GROWTH = np.log(ACCURACY / np.finfo(float).eps)
"""Logarithm of the largest growth of rounding errors in an upward recurrence."""
DECAY = -np.log(ACCURACY)
"""Logarithm of the decay after which a downward recurrence does not depend on its start value."""


@kernel
def _elliptic_ke(kc: float) -> tuple[float, float]:
    """Complete elliptic integrals (K, E) for the complementary modulus kc, by the
    arithmetic-geometric mean."""
    a, b = 1.0, kc
    c2 = 1.0 - kc * kc
    total, weight = 0.5 * c2, 0.5
    for _ in range(40):
        c = 0.5 * (a - b)
        a, b = 0.5 * (a + b), np.sqrt(a * b)
        weight *= 2.0
        total += weight * c * c
        if c <= 1e-16 * a:
            break
    big_k = 0.5 * np.pi / a
    return big_k, big_k * (1.0 - total)


@kernel
def toroidal_kernels(r: float, s: float, out: np.ndarray) -> None:
    """Fill out[m] = G_m(r, s) = Integral J_m(k r) J_m(k s) dk for m = 0 .. len(out) - 1.

    The radii r and s must be positive and different.  G_m is Q_{m-1/2}(chi) / (pi sqrt(r s)) with
    chi = (r^2 + s^2) / (2 r s).  Q is the decaying solution of a three-term recurrence in m.  An
    upward recurrence loses accuracy if m times the decay rate is large.  In this case, ratios are
    computed by a downward recurrence (Miller's method).
    """
    n = len(out)
    kc = abs(r - s) / (r + s)
    big_k, big_e = _elliptic_ke(kc)
    out[0] = 2.0 * big_k / (np.pi * (r + s))
    if n == 1:
        return
    chi_minus_1 = (r - s) ** 2 / (2.0 * r * s)
    chi = 1.0 + chi_minus_1
    decay = np.log1p(chi_minus_1 + np.sqrt(chi_minus_1 * (chi + 1.0)))
    if 2.0 * decay * n < MOST_GROWTH:
        modulus = 2.0 * np.sqrt(r * s) / (r + s)
        q1 = chi * modulus * big_k - np.sqrt(2.0 * (chi + 1.0)) * big_e
        out[1] = q1 / (np.pi * np.sqrt(r * s))
        for m in range(1, n - 1):
            out[m + 1] = (2.0 * m * chi * out[m] - (m - 0.5) * out[m - 1]) / (m + 0.5)
        return
    top = n + int(0.5 * DECAY / decay) + 2
    ratio = 0.0
    for m in range(top, 0, -1):
        ratio = (m - 0.5) / (2.0 * m * chi - (m + 0.5) * ratio)
        if m < n:
            out[m] = ratio
    for m in range(1, n):
        out[m] *= out[m - 1]


@kernel
def coupling_kernels(r: float, s: float, toroidal: np.ndarray, out: np.ndarray) -> None:
    """Fill out[j] = C_{j+1}(r, s) = Integral J_{j+1}(k r) J_{j-1}(k s) dk, j = 0 .. len(out) - 1.

    `toroidal` contains G_m(r, s) for m = 0 .. len(toroidal) - 1 with len(toroidal) > len(out).
    Multiplication of e^{2 i alpha}/|z-z'| by conj(z - z') gives the recurrence r C_m - s C_{m-1} =
    r G_{m-2} - s G_{m-1}, with C_1 = -G_1.  The upward recurrence is stable if s < r or if (s/r)^m
    is of order one.  Otherwise the recurrence runs downward from an index at which C is negligible.
    Modes below 1 follow from C_{2-m}(r, s) = C_m(s, r).
    """
    n = len(out)
    out[0] = -toroidal[1]
    if s <= r or (n + 1) * np.log(s / r) < 2.0:
        q = s / r
        for j in range(1, n):
            m = j + 1
            out[j] = q * out[j - 1] + toroidal[m - 2] - q * toroidal[m - 1]
        return
    q = r / s
    value = 0.0
    for m in range(len(toroidal), 1, -1):
        # value is C_m at the start of the loop body and C_{m-1} at its end
        if m - 1 < n:
            out[m - 1] = value
        value = q * value + toroidal[m - 1] - q * toroidal[m - 2]


@kernel
def mode_kernels(
    r: float, s: float, n_modes: int, coupled: bool, torus: np.ndarray, pair: np.ndarray
) -> np.ndarray:
    """Set torus[m] = G_m and, if coupled, pair[j] = C_{j+1}.

    Returns `torus`, or a larger array if `torus` was too short.
    """
    top = n_modes
    if coupled:
        top = n_modes + 2
        ratio = abs(np.log(s / r))
        if s > r and (n_modes + 1) * ratio >= 2.0:
            top = n_modes + 2 + int(DECAY / ratio)
        if top > len(torus):
            torus = np.empty(top)
    view = torus[:top]
    toroidal_kernels(r, s, view)
    if coupled:
        coupling_kernels(r, s, view, pair)
    return torus
