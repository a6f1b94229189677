"""Influence coefficients of the elastic half-space under in-plane traction.

The surface displacement u = u_x + i u_y that a traction q = q_x + i q_y causes is (dimensionless
working units, contact radius 1, reduced shear modulus ``G_STAR``)

    u(z) = 1/(pi G*) Integral [ q(z') / |z-z'| + kappa e^{2 i alpha} conj(q(z')) / |z-z'| ] dA'

with kappa = nu / (2 - nu) and alpha the angle of z - z'.  On circles both kernels fall apart into
angular modes.  With q = Sum_m q_m(r) e^{i m theta}

    u_m(r) = 2/G* Integral [ G_m(r, r') q_m(r') + kappa C_m(r, r') conj(q_{2-m}(r')) ] r' dr'
    G_m(r, r') = Integral_0^inf J_m(k r) J_m(k r') dk            (a toroidal Legendre function)
    C_m(r, r') = Integral_0^inf J_m(k r) J_{m-2}(k r') dk

This module evaluates G_m and C_m for all modes at once, and averages them over pairs of rings.
It knows nothing of friction, motion or time.
"""

from __future__ import annotations

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.theory.hertz import G_STAR

# Gauss points of the outer (averaging) and the inner (singular) ring integral, and the power that
# clusters the inner points at the nearest approach, where the kernels have a logarithm.
OUTER_POINTS = 8
INNER_POINTS = 12
CLUSTER_POWER = 4
APART_POINTS = 5
"""Gauss points on each of two rings with at least a ring's width between them."""


@kernel
def _elliptic_ke(kc):
    """Complete elliptic integrals (K, E) for the complementary modulus kc, by the AGM."""
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
def toroidal_kernels(r, s, out):
    """Fill out[m] = G_m(r, s) = Integral J_m(k r) J_m(k s) dk for m = 0 .. len(out) - 1.

    Parameters: two different positive radii (dimensionless) and the array to fill.  G_m equals
    Q_{m-1/2}(chi) / (pi sqrt(r s)) with chi = (r^2 + s^2) / (2 r s).  Q is the solution of its
    three-term recurrence that decays with m, so upward recurrence loses accuracy once m times the
    decay rate is no longer small; there the ratios are run downward instead (Miller's method).
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
    if decay * n < 1.0:
        modulus = 2.0 * np.sqrt(r * s) / (r + s)
        q1 = chi * modulus * big_k - np.sqrt(2.0 * (chi + 1.0)) * big_e
        out[1] = q1 / (np.pi * np.sqrt(r * s))
        for m in range(1, n - 1):
            out[m + 1] = (2.0 * m * chi * out[m] - (m - 0.5) * out[m - 1]) / (m + 0.5)
        return
    top = n + int(20.0 / decay) + 2
    ratio = 0.0
    for m in range(top, 0, -1):
        ratio = (m - 0.5) / (2.0 * m * chi - (m + 0.5) * ratio)
        if m < n:
            out[m] = ratio
    for m in range(1, n):
        out[m] *= out[m - 1]


@kernel
def coupling_kernels(r, s, toroidal, out):
    """Fill out[j] = C_{j+1}(r, s) = Integral J_{j+1}(k r) J_{j-1}(k s) dk, j = 0 .. len(out) - 1.

    ``toroidal`` holds G_m(r, s) for m = 0 .. len(toroidal) - 1 with len(toroidal) > len(out).
    Multiplying e^{2 i alpha}/|z-z'| by conj(z - z') gives r C_m - s C_{m-1} = r G_{m-2} - s G_{m-1}
    and C_1 = -G_1: stable upward for s < r; for s > r it is run downward from an index where C has
    died out, or upward where (s/r)^m stays of order one.  Modes below 1 follow from
    C_{2-m}(r, s) = C_m(s, r).
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
        # value is C_m on entry to the body and C_{m-1} after it
        if m - 1 < n:
            out[m - 1] = value
        value = q * value + toroidal[m - 1] - q * toroidal[m - 2]


@kernel
def _kernels(r, s, n_modes, coupled, torus, pair):
    """Fill torus[m] = G_m and, if coupled, pair[j] = C_{j+1}; returns torus, perhaps enlarged."""
    top = n_modes
    if coupled:
        top = n_modes + 2
        ratio = abs(np.log(s / r))
        if s > r and (n_modes + 1) * ratio >= 2.0:
            top = n_modes + 2 + int(36.0 / ratio)
        if top > len(torus):
            torus = np.empty(top)
    view = torus[:top]
    toroidal_kernels(r, s, view)
    if coupled:
        coupling_kernels(r, s, view, pair)
    return torus


@kernel
def _close_pair(edges_i, edges_j, n_modes, coupled, outer, inner, hertz, near, far):
    """Average kernels over ring i (outer rule) and ring j (inner rule); angles psi, r = sin psi.

    Adds to near[m] and far[m] the averages of G_m and C_{m+1} weighted with the ring shapes
    (normalised to unit weight Integral shape r dr = 1 on each ring).
    """
    x_out, w_out = outer
    x_in, w_in = inner
    a0, a1 = edges_i
    b0, b1 = edges_j
    norm_i = 0.0
    for p in range(len(x_out)):
        psi = a0 + (a1 - a0) * x_out[p]
        norm_i += (a1 - a0) * w_out[p] * _weight(psi, hertz)
    norm_j = _weight_integral(b0, b1, hertz)
    torus, pair = np.empty(n_modes + 2), np.empty(n_modes)
    for p in range(len(x_out)):
        psi = a0 + (a1 - a0) * x_out[p]
        weight_out = (a1 - a0) * w_out[p] * _weight(psi, hertz) / norm_i
        # the inner panel is cut at the point of nearest approach
        cut = min(max(psi, b0), b1)
        for side in range(2):
            end = b0 if side == 0 else b1
            length = end - cut
            if length == 0.0:
                continue
            for q in range(len(x_in)):
                chi = cut + length * x_in[q]
                w = weight_out * abs(length) * w_in[q] * _weight(chi, hertz) / norm_j
                torus = _kernels(np.sin(psi), np.sin(chi), n_modes, coupled, torus, pair)
                for m in range(n_modes):
                    near[m] += w * torus[m]
                    if coupled:
                        far[m] += w * pair[m]


@kernel
def _pair_apart(edges_i, edges_j, n_modes, coupled, rule, hertz, near, far, far_back):
    """As ``_close_pair`` for rings with a gap between them, both ways at once (far_back: C with
    the rings exchanged): the kernels are smooth there."""
    x, w = rule
    a0, a1 = edges_i
    b0, b1 = edges_j
    norm = _weight_integral(a0, a1, hertz) * _weight_integral(b0, b1, hertz)
    torus, pair = np.empty(n_modes + 2), np.empty(n_modes)
    for p in range(len(x)):
        psi = a0 + (a1 - a0) * x[p]
        weight_out = (a1 - a0) * w[p] * _weight(psi, hertz) / norm
        for q in range(len(x)):
            chi = b0 + (b1 - b0) * x[q]
            weight = weight_out * (b1 - b0) * w[q] * _weight(chi, hertz)
            torus = _kernels(np.sin(psi), np.sin(chi), n_modes, coupled, torus, pair)
            for m in range(n_modes):
                near[m] += weight * torus[m]
                if coupled:
                    far[m] += weight * pair[m]
            if coupled:
                torus = _kernels(np.sin(chi), np.sin(psi), n_modes, coupled, torus, pair)
                for m in range(n_modes):
                    far_back[m] += weight * pair[m]


@kernel
def _weight(psi, hertz):
    """Shape times r dr/dpsi on r = sin psi: uniform traction, or one shaped like the bound."""
    c = np.cos(psi)
    return np.sin(psi) * c * (c if hertz else 1.0)


@kernel
def _weight_integral(b0, b1, hertz):
    """Exact integral of _weight from b0 to b1."""
    c0, c1 = np.cos(b0), np.cos(b1)
    if hertz:
        return (c0**3 - c1**3) / 3.0
    return 0.5 * (c0 * c0 - c1 * c1)


@kernel
def _all_pairs(psi, n_modes, coupled, outer, inner, apart, hertz, near, far):
    n = len(psi) - 1
    for i in range(n):
        for j in range(i + 1):
            one, other = (psi[i], psi[i + 1]), (psi[j], psi[j + 1])
            gap = psi[i] - psi[j + 1]
            if gap >= 0.999 * max(psi[i + 1] - psi[i], psi[j + 1] - psi[j]):
                _pair_apart(
                    one,
                    other,
                    n_modes,
                    coupled,
                    apart,
                    hertz,
                    near[:, i, j],
                    far[:, i, j],
                    far[:, j, i],
                )
                for m in range(n_modes):
                    near[m, j, i] = near[m, i, j]
                continue
            _close_pair(
                one, other, n_modes, coupled, outer, inner, hertz, near[:, i, j], far[:, i, j]
            )
            if i != j:
                _close_pair(
                    other, one, n_modes, coupled, outer, inner, hertz, near[:, j, i], far[:, j, i]
                )


def _unit_gauss(n, power):
    """Gauss-Legendre rule on [0, 1], clustered at 0 by t -> t^power."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t**power, w * power * t ** (power - 1)


def _smooth_ends_gauss(n):
    """Gauss-Legendre rule on [0, 1], clustered at both ends (t -> 3 t^2 - 2 t^3)."""
    x, w = np.polynomial.legendre.leggauss(n)
    t, w = 0.5 * (x + 1.0), 0.5 * w
    return t * t * (3.0 - 2.0 * t), w * 6.0 * t * (1.0 - t)


def ring_influence(psi, n_modes, coupled, hertz=True, modulus=G_STAR):
    """Mode matrices of a half-space under ring tractions.

    psi: ring edges as angles, r = sin(psi), shape (n + 1,), increasing up to pi/2.  modulus: G* in
    working units.
    Returns (near, far), each of shape (n_modes, n, n) and dimensionless:
    near[m] maps mean ring tractions (force per area) of mode m to ring-averaged displacements of
    mode m (also for mode -m); kappa * far[j] maps conj of the tractions of mode 1 - j to the
    displacements of mode 1 + j, and its transpose those of 1 + j to 1 - j.  far is zero if
    ``coupled`` is false.  Averages are Galerkin averages with the shape of the friction bound
    (``hertz``) or uniform, so near is symmetric after weighting with ring areas.
    """
    psi = np.ascontiguousarray(psi, dtype=float)
    n = len(psi) - 1
    near = np.zeros((n_modes, n, n))
    far = np.zeros((n_modes, n, n))
    outer = _smooth_ends_gauss(OUTER_POINTS)
    inner = _unit_gauss(INNER_POINTS, CLUSTER_POWER)
    apart = _unit_gauss(APART_POINTS, 1)
    _all_pairs(psi, n_modes, bool(coupled), outer, inner, apart, bool(hertz), near, far)
    area = np.diff(np.sin(psi) ** 2) / 2.0  # Integral r dr of each ring
    scale = 2.0 / modulus * area[None, None, :]
    # the quadrature is not symmetric in its outer and inner variable; the operator is
    near = 0.5 * (near + near.transpose(0, 2, 1)) * scale
    return near, far * scale
