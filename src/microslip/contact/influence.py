"""Influence coefficients of the elastic half-space under in-plane traction.

In working units, with the contact radius 1 and the reduced shear modulus G*, a traction q = q_x + i
q_y causes the surface displacement u = u_x + i u_y:

    u(z) = 1/(pi G*) Integral [ q(z') / |z-z'| + kappa e^{2 i alpha} conj(q(z')) / |z-z'| ] dA'

Here kappa = nu / (2 - nu), and alpha is the angle of z - z'.  On circles, both kernels decompose
into angular modes.  With q = Sum_m q_m(r) e^{i m theta},

    u_m(r) = 2/G* Integral [ G_m(r, r') q_m(r') + kappa C_m(r, r') conj(q_{2-m}(r')) ] r' dr'
    G_m(r, r') = Integral_0^inf J_m(k r) J_m(k r') dk            (a toroidal Legendre function)
    C_m(r, r') = Integral_0^inf J_m(k r) J_{m-2}(k r') dk

This module computes the kernels G_m and C_m for all modes at once, and averages them over pairs of
rings.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR

EPSILON = float(np.finfo(float).eps)
"""Distance from 1 to the next larger floating-point number."""
ACCURACY = 1e-10
"""Relative accuracy of the kernels. The averages over rings are much less accurate."""
MOST_GROWTH = np.log(ACCURACY / EPSILON)
"""Logarithm of the largest accepted growth of rounding errors in an upward recurrence."""
HALF_PRECISION = np.sqrt(EPSILON)
"""If the relative difference of two numbers is at most this value, their arithmetic and geometric
means are equal except for rounding."""
DECAY = -np.log(ACCURACY)
"""Logarithm of a decay.  After this decay, a downward recurrence no longer depends on its start
value."""
MOST_MODES = 1 + int(np.ceil(0.5 * DECAY))
"""Upper bound on the ratio of modes_for(r, s, n) to n + 2."""
OUTER_POINTS = 8
INNER_POINTS = 12
CLUSTER_POWER = 4
"""OUTER_POINTS: number of Gauss points for the outer integral over a ring (averaging).
INNER_POINTS: number of Gauss points for the inner, singular integral.  CLUSTER_POWER: exponent that
clusters the inner points where the rings are closest.  Where the rings are closest, the kernels
have a logarithmic singularity."""
APART_POINTS = 5
"""Number of Gauss points on each ring, for two rings that are at least the width of a ring
apart."""


class Averaging(NamedTuple):
    """Quadrature of kernels over pairs of rings.  Every rule is a pair (nodes, weights) on [0, 1].

    Attributes
    ----------
    psi : np.ndarray, shape (rings + 1,)
        Edges of the rings as angles, with r = sin(psi).
    coupled : bool
        Whether the modes m and 2 - m are coupled (nu > 0).
    outer, inner : tuple of np.ndarray
        Quadrature rules for the narrower ring, and for the wider ring.  The nodes of the latter are
        measured from the point of closest approach.
    apart : tuple of np.ndarray
        Quadrature rule for both rings if their distance is at least the width of a ring.
    """

    psi: np.ndarray
    coupled: bool
    outer: tuple
    inner: tuple
    apart: tuple


@kernel
def elliptic_integrals(kc: np.ndarray, big_k: np.ndarray, big_e: np.ndarray) -> None:
    """Fill `big_k` and `big_e` with the complete elliptic integrals K and E.

    kc: complementary moduli, as an array of shape (n,).

    The integrals are computed by the arithmetic-geometric mean.  The iteration converges
    quadratically.  Convergence is slowest for the smallest modulus.  All moduli use the number of
    steps that the smallest modulus needs, so that the compiler can use vector instructions.
    """
    large, small, steps = 1.0, kc.min(), 0
    while large - small > HALF_PRECISION * large:
        large, small = 0.5 * (large + small), np.sqrt(large * small)
        steps += 1
    a, b = np.ones(len(kc)), kc.copy()
    for q in range(len(kc)):
        big_e[q] = 0.5 - 0.5 * kc[q] * kc[q]
    weight = 0.125
    for _ in range(steps):
        weight *= 2.0
        for q in range(len(kc)):
            big_e[q] += weight * (a[q] - b[q]) * (a[q] - b[q])
            a[q], b[q] = 0.5 * (a[q] + b[q]), np.sqrt(a[q] * b[q])
    for q in range(len(kc)):
        big_k[q] = np.pi / (a[q] + b[q])
        big_e[q] = big_k[q] * (1.0 - big_e[q])


@kernel
def toroidal_kernels(
    r: float, s: float, integrals: tuple[float, float], n: int, out: np.ndarray
) -> None:
    """Compute G_m(r, s) for m = 0 .. n - 1, and store it in out[m].

    G_m(r, s) is the integral of J_m(k r) J_m(k s) over k.  The radii r and s must be positive and
    different.  The argument `integrals` contains K and E for the complementary modulus |r - s| / (r
    + s).  G_m is Q_{m-1/2}(chi) / (pi sqrt(r s)) with chi = (r^2 + s^2) / (2 r s).  Q is the
    decaying solution of a three-term recurrence in m.  An upward recurrence loses accuracy if m
    times the decay rate is large.  In this case, the ratios of consecutive values are computed by a
    downward recurrence (Miller's method).
    """
    big_k, big_e = integrals
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
def modes_for(r: float, s: float, n: int) -> int:
    """Return the number of values G_m(r, s) that are needed to compute C_1, ..., C_n.

    If the upward recurrence is stable, the number is n + 2.  Otherwise, the number is larger, but
    at most `MOST_MODES * (n + 2)`.
    """
    growth = np.log(s / r)
    return n + 2 if (n + 1) * growth < 2.0 else n + 3 + int(DECAY / growth)


@kernel
def coupling_kernels(r: float, s: float, toroidal: np.ndarray, n: int, out: np.ndarray) -> None:
    """Compute C_{j+1}(r, s) for j = 0 .. n - 1, and store it in out[j].

    C_{j+1}(r, s) is the integral of J_{j+1}(k r) J_{j-1}(k s) over k.  `toroidal` contains at least
    `modes_for(r, s, n)` values G_m(r, s).  Multiplying e^{2 i alpha}/|z-z'| by conj(z - z') gives
    the recurrence r C_m - s C_{m-1} = r G_{m-2} - s G_{m-1}, with C_1 = -G_1.  The upward
    recurrence is stable if s < r or if (s/r)^m is of order one.  Otherwise the recurrence runs
    downward from an index at which C is negligible.  Modes below 1 follow from C_{2-m}(r, s) =
    C_m(s, r).
    """
    out[0] = -toroidal[1]
    top = modes_for(r, s, n)
    if top == n + 2:
        q = s / r
        for j in range(1, n):
            m = j + 1
            out[j] = q * out[j - 1] + toroidal[m - 2] - q * toroidal[m - 1]
        return
    q = r / s
    value = 0.0
    for m in range(top, 1, -1):
        # value is C_m at the start of the loop body and C_{m-1} at its end
        if m - 1 < n:
            out[m - 1] = value
        value = q * value + toroidal[m - 1] - q * toroidal[m - 2]


@kernel
def _points_of_pair(averaging: Averaging, i: int, j: int, points: np.ndarray) -> int:
    """Fill `points` with quadrature points of a pair of rings, and return the number of points.

    A quadrature point consists of three numbers: a radius on ring i (outer rule), a radius on ring
    j (inner rule), and a weight.  The weights include the traction profile s(r) of each ring.  The
    profile is normalised: the integral of s(r) r dr is 1.
    """
    psi = averaging.psi
    a0, a1 = psi[i], psi[i + 1]
    b0, b1 = psi[j], psi[j + 1]
    apart = max(a0 - b1, b0 - a1) >= 0.999 * max(a1 - a0, b1 - b0)
    x_out, w_out = averaging.apart if apart else averaging.outer
    x_in, w_in = averaging.apart if apart else averaging.inner
    norm_i = 0.0
    norm_j = (np.cos(b0) ** 3 - np.cos(b1) ** 3) / 3.0
    count = 0
    for p in range(len(x_out)):
        at = a0 + (a1 - a0) * x_out[p]
        r = np.sin(at)
        weight = w_out[p] * _weight(r)
        norm_i += weight
        # the inner ring is divided at the point of closest approach
        cut = min(max(at, b0), b1)
        for end in (b0, b1):
            length = end - cut
            if length == 0.0:
                continue
            for q in range(len(x_in)):
                s = np.sin(cut + length * x_in[q])
                points[0, count], points[1, count] = r, s
                points[2, count] = weight / norm_j * abs(length) * w_in[q] * _weight(s)
                count += 1
    for q in range(count):
        points[2, q] /= norm_i
    return count


@kernel
def _add_pair(
    averaging: Averaging, i: int, j: int, points: np.ndarray, near: np.ndarray, far: np.ndarray
) -> None:
    """Average the kernels over ring i (outer rule) and ring j (inner rule).

    Only the points of the inner rule are clustered where the rings are closest.  Therefore, ring i
    must be the narrower one.  The averages of G_m are added to near[:, i, j].  The averages of
    C_{m+1} are added to far[:, i, j] and to far[:, j, i].  `points` is a scratch array for the
    quadrature points.
    """
    count = _points_of_pair(averaging, i, j, points)
    radii, others, weights = points[0, :count], points[1, :count], points[2, :count]
    moduli, big_k, big_e = points[3, :count], points[4, :count], points[5, :count]
    for q in range(count):
        apart = abs(radii[q] - others[q]) / (radii[q] + others[q])
        moduli[q] = max(apart, EPSILON)  # near the edge, radii may be equal after rounding
    elliptic_integrals(moduli, big_k, big_e)
    n, coupled = len(near), averaging.coupled
    torus, pair = np.empty(MOST_MODES * (n + 2)), np.empty(n)
    for q in range(count):
        r, s, integrals = radii[q], others[q], (big_k[q], big_e[q])
        toroidal_kernels(r, s, integrals, modes_for(r, s, n) if coupled else n, torus)
        for m in range(n):
            near[m, i, j] += weights[q] * torus[m]
        if coupled:
            coupling_kernels(r, s, torus, n, pair)
            for m in range(n):
                far[m, i, j] += weights[q] * pair[m]
        if coupled and i != j:
            toroidal_kernels(s, r, integrals, modes_for(s, r, n), torus)
            coupling_kernels(s, r, torus, n, pair)
            for m in range(n):
                far[m, j, i] += weights[q] * pair[m]


@kernel
def _weight(r: float) -> float:
    """Return the product of the Hertz friction bound and r dr/dpsi at r = sin psi, except for a
    constant factor."""
    return r * (1.0 - r) * (1.0 + r)


@kernel
def _all_pairs(averaging: Averaging, near: np.ndarray, far: np.ndarray) -> None:
    """Fill `near` and `far` with averages of the kernels over all pairs of rings.  Both arrays have
    the shape (n_modes, rings, rings) and must be zero on entry."""
    width = averaging.psi[1:] - averaging.psi[:-1]
    points = np.empty((6, 2 * len(averaging.outer[0]) * len(averaging.inner[0])))
    for one in range(len(width)):
        for other in range(one + 1):
            i, j = (one, other) if width[one] < width[other] else (other, one)
            _add_pair(averaging, i, j, points, near, far)
            for m in range(len(near)):  # an assignment of arrays would take a second to compile
                near[m, j, i] = near[m, i, j]


@lru_cache
def _unit_gauss(n: int, power: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a Gauss-Legendre rule on [0, 1], clustered at 0 by t -> t^power."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t**power, w * power * t ** (power - 1)


@lru_cache
def _smooth_ends_gauss(n: int) -> tuple[np.ndarray, np.ndarray]:
    """Return a Gauss-Legendre rule on [0, 1] whose nodes are clustered at both ends by the map
    t -> 3 t^2 - 2 t^3."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t * t * (3.0 - 2.0 * t), w * 6.0 * t * (1.0 - t)


@lru_cache(maxsize=8)
def ring_influence(
    edges: tuple[float, ...], n_modes: int, coupled: bool, modulus: float = G_STAR
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the influence matrices of angular modes on rings of a half-space.

    Within a ring, tractions are proportional to the Hertz friction bound.  Averages are Galerkin
    averages, so that the matrices near[m] are symmetric when weighted with the ring areas.

    Calls with equal arguments return the same arrays, which must not be modified.

    Parameters
    ----------
    edges : tuple of float
        Edges of the n rings as angles psi, with r = sin(psi); they increase up to pi/2.
    n_modes : int
        Number of modes.  Modes are numbered from 0 to n_modes - 1.
    coupled : bool
        Whether to compute `far`, which is zero otherwise.
    modulus : float
        G* in working units.

    Returns
    -------
    near : np.ndarray, shape (n_modes, n, n)
        near[m] maps mean ring tractions (force per area) of mode m to mean ring displacements of
        mode m.  Modes m and -m have the same matrix.
    far : np.ndarray, shape (n_modes, n, n)
        kappa * far[j] maps conjugate tractions of mode 1 - j to displacements of mode 1 + j.  The
        transpose of this matrix maps conjugate tractions of mode 1 + j to displacements of mode 1 -
        j.
    """
    psi, n = np.array(edges), len(edges) - 1
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
