"""Influence coefficients of the elastic half-space under in-plane traction.

The surface displacement u = u_x + i u_y under a traction q = q_x + i q_y is, in working units with
the contact radius 1 and the reduced shear modulus G*,

    u(z) = 1/(pi G*) Integral [ q(z') / |z-z'| + kappa e^{2 i alpha} conj(q(z')) / |z-z'| ] dA'

with kappa = nu / (2 - nu) and the angle alpha of z - z'.  On circles, both kernels decompose into
angular modes.  With q = Sum_m q_m(r) e^{i m theta}

    u_m(r) = 2/G* Integral [ G_m(r, r') q_m(r') + kappa C_m(r, r') conj(q_{2-m}(r')) ] r' dr'
    G_m(r, r') = Integral_0^inf J_m(k r) J_m(k r') dk            (a toroidal Legendre function)
    C_m(r, r') = Integral_0^inf J_m(k r) J_{m-2}(k r') dk

This module averages G_m and C_m (mode_kernels.py) over pairs of rings.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from microslip.foundation.compiled import kernel
from microslip.models.rings.mode_kernels import mode_kernels
from microslip.theory.hertz import G_STAR

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
