"""Influence coefficients of the elastic half-space under in-plane traction.

The surface displacement u = u_x + i u_y under a traction q = q_x + i q_y is, in working units with
the contact radius 1 and the reduced shear modulus G*,

    u(z) = 1/(pi G*) Integral [ q(z') / |z-z'| + kappa e^{2 i alpha} conj(q(z')) / |z-z'| ] dA'

with kappa = nu / (2 - nu) and the angle alpha of z - z'.  On circles, both kernels decompose into
angular modes.  With q = Sum_m q_m(r) e^{i m theta}

    u_m(r) = 2/G* Integral [ G_m(r, r') q_m(r') + kappa C_m(r, r') conj(q_{2-m}(r')) ] r' dr'
    G_m(r, r') = Integral_0^inf J_m(k r) J_m(k r') dk            (a toroidal Legendre function)
    C_m(r, r') = Integral_0^inf J_m(k r) J_{m-2}(k r') dk

This module computes G_m and C_m for all modes at once, and averages them over pairs of rings.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR

ACCURACY = 1e-10
"""Relative accuracy of the kernels, much better than the accuracy of their averages over rings."""
MOST_GROWTH = np.log(ACCURACY / np.finfo(float).eps)
"""Logarithm of the largest growth of rounding errors in an upward recurrence."""
DECAY = -np.log(ACCURACY)
"""Logarithm of the decay after which a downward recurrence does not depend on its start value."""
OUTER_POINTS = 8
INNER_POINTS = 12
CLUSTER_POWER = 4
"""Numbers of Gauss points for the outer (averaging) and the inner (singular) ring integral.  The
exponent clusters the inner points where the rings are closest, because the kernels have a
logarithmic singularity there."""
APART_POINTS = 5
"""Number of Gauss points on each ring of a pair whose distance is at least the width of a ring."""


class Averaging(NamedTuple):
    """Quadrature of kernels over pairs of rings; every rule is (nodes, weights) on [0, 1].

    Attributes
    ----------
    psi : np.ndarray, shape (rings + 1,)
        Edges of the rings as angles, with r = sin(psi).
    coupled : bool
        Whether the modes m and 2 - m are coupled (nu > 0).
    outer, inner : tuple of np.ndarray
        Quadrature rules for the narrower ring, and for the other ring.  The latter starts at the
        point of closest approach.
    apart : tuple of np.ndarray
        Quadrature rule for both rings if their distance is at least the width of a ring.
    """

    psi: np.ndarray
    coupled: bool
    outer: tuple
    inner: tuple
    apart: tuple


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


@kernel
def _add_pair(averaging: Averaging, i: int, j: int, near: np.ndarray, far: np.ndarray) -> None:
    """Average the kernels over ring i (outer rule) and ring j (inner rule).

    Ring i must be the narrower one, because only the points of the inner rule are clustered where
    the rings are closest.  Adds the averages of G_m to near[:, i, j], and the averages of C_{m+1}
    to far[:, i, j] and far[:, j, i].  Averages are weighted with the shape of the traction on each
    ring, normalised to Integral shape r dr = 1.
    """
    psi, coupled = averaging.psi, averaging.coupled
    a0, a1 = psi[i], psi[i + 1]
    b0, b1 = psi[j], psi[j + 1]
    apart = max(a0 - b1, b0 - a1) >= 0.999 * max(a1 - a0, b1 - b0)
    x_out, w_out = averaging.apart if apart else averaging.outer
    x_in, w_in = averaging.apart if apart else averaging.inner
    n_modes = len(near)
    norm_i = 0.0
    for p in range(len(x_out)):
        norm_i += (a1 - a0) * w_out[p] * _weight(a0 + (a1 - a0) * x_out[p])
    norm_j = (np.cos(b0) ** 3 - np.cos(b1) ** 3) / 3.0
    torus, pair = np.empty(n_modes + 2), np.empty(n_modes)
    for p in range(len(x_out)):
        at = a0 + (a1 - a0) * x_out[p]
        weight_out = (a1 - a0) * w_out[p] * _weight(at) / norm_i
        # the inner ring is divided at the point of closest approach
        cut = min(max(at, b0), b1)
        for end in (b0, b1):
            length = end - cut
            if length == 0.0:
                continue
            for q in range(len(x_in)):
                chi = cut + length * x_in[q]
                w = weight_out * abs(length) * w_in[q] * _weight(chi) / norm_j
                torus = mode_kernels(np.sin(at), np.sin(chi), n_modes, coupled, torus, pair)
                for m in range(n_modes):
                    near[m, i, j] += w * torus[m]
                    if coupled:
                        far[m, i, j] += w * pair[m]
                if coupled and i != j:
                    torus = mode_kernels(np.sin(chi), np.sin(at), n_modes, coupled, torus, pair)
                    for m in range(n_modes):
                        far[m, j, i] += w * pair[m]


@kernel
def _weight(psi: float) -> float:
    """Shape of the Hertz friction bound times r dr/dpsi, at r = sin psi."""
    c = np.cos(psi)
    return np.sin(psi) * c * c


@kernel
def _all_pairs(averaging: Averaging, near: np.ndarray, far: np.ndarray) -> None:
    """Fill the arrays `near` and `far`, (n_modes, rings, rings), which must be zero on entry."""
    width = averaging.psi[1:] - averaging.psi[:-1]
    for one in range(len(width)):
        for other in range(one + 1):
            i, j = (one, other) if width[one] < width[other] else (other, one)
            _add_pair(averaging, i, j, near, far)
            for m in range(len(near)):  # an assignment of arrays would take a second to compile
                near[m, j, i] = near[m, i, j]


@lru_cache
def _unit_gauss(n: int, power: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre rule on [0, 1], clustered at 0 by t -> t^power."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t**power, w * power * t ** (power - 1)


@lru_cache
def _smooth_ends_gauss(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss-Legendre rule on [0, 1], clustered at both ends (t -> 3 t^2 - 2 t^3)."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t * t * (3.0 - 2.0 * t), w * 6.0 * t * (1.0 - t)


def ring_influence(
    psi: np.ndarray, n_modes: int, coupled: bool, modulus: float = G_STAR
) -> tuple[np.ndarray, np.ndarray]:
    """Influence matrices of angular modes on rings of a half-space.

    Tractions on a ring have the shape of the Hertz friction bound.  Averages are Galerkin averages,
    so the matrices near[m] are symmetric after weighting with the ring areas.

    Parameters
    ----------
    psi : np.ndarray, shape (n + 1,)
        Edges of the rings as angles, with r = sin(psi), increasing up to pi/2.
    n_modes : int
        Number of modes, which are numbered 0 to n_modes - 1.
    coupled : bool
        Whether to compute `far`, which is zero otherwise.
    modulus : float
        G* in working units.

    Returns
    -------
    near : np.ndarray, shape (n_modes, n, n)
        near[m] maps mean ring tractions (force per area) of mode m to mean ring displacements of
        mode m; modes m and -m have the same matrix.
    far : np.ndarray, shape (n_modes, n, n)
        kappa * far[j] maps conjugate tractions of mode 1 - j to displacements of mode 1 + j; its
        transpose maps conjugate tractions of mode 1 + j to displacements of mode 1 - j.
    """
    psi = np.ascontiguousarray(psi, dtype=float)
    n = len(psi) - 1
    near = np.zeros((n_modes, n, n))
    far = np.zeros((n_modes, n, n))
    averaging = Averaging(
        psi,
        bool(coupled),
        outer=_smooth_ends_gauss(OUTER_POINTS),
        inner=_unit_gauss(INNER_POINTS, CLUSTER_POWER),
        apart=_unit_gauss(APART_POINTS, 1),
    )
    _all_pairs(averaging, near, far)
    area = np.diff(np.sin(psi) ** 2) / 2.0  # Integral r dr of each ring
    scale = 2.0 / modulus * area[None, None, :]
    return near * scale, far * scale
