"""Influence coefficients against brute-force quadrature, closed forms and their own symmetries.

Complex notation: q = lateral + i forward.
"""

import numpy as np
import pytest
from contact.test_models import fitted_order

from microslip.contact.influence import (
    ring_influence,
)
from microslip.contact.modes import PolarContact
from microslip.contact.rings import make_rings
from microslip.theory import hertz


def unit_gauss(count):
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


NODES, WEIGHTS = unit_gauss(160)


def angular_mean(function, r, s):
    """Mean of function(beta, s) / R over the angle beta between two circles with the radii r and s.

    R is the distance between r and s e^{i beta}; s is a float or an array (n, 1).  Near beta = 0
    the substitution 2 sqrt(r s) sin(beta / 2) = |r - s| sinh(t) removes R."""
    gap, mean = abs(r - s), np.sqrt(r * s)
    end = np.arcsinh(2 * mean * np.sin(np.pi / 4) / gap)
    beta = 2 * np.arcsin(gap * np.sinh(end * NODES) / (2 * mean))
    near = np.sum(WEIGHTS * end * function(beta, s) / (mean * np.cos(beta / 2)), axis=-1)
    beta = np.pi / 2 * (1 + NODES)
    rest = function(beta, s) / abs(r - s * np.exp(1j * beta))
    return (near + np.pi / 2 * np.sum(WEIGHTS * rest, axis=-1)) / np.pi


def toroidal_mean(m, r, s):
    return angular_mean(lambda beta, s: np.cos(m * beta), r, s)


def coupling_mean(m, r, s):
    """Response in mode m at r of the kernel e^{2 i alpha} / |z - z'| to conjugated mode 2 - m at
    s."""

    def kernel(beta, s):
        apart = r - s * np.exp(1j * beta)
        return (np.exp(1j * (m - 2) * beta) * (apart / abs(apart)) ** 2).real

    return angular_mean(kernel, r, s)


# Ring averages

RING_EDGES = np.array([0.0, 0.45, 0.7, 1.2, np.pi / 2])


def ring_average(kernel, i, j):
    """2/G* times the mean of kernel(r, s) over rings i and j, times Integral r dr over ring j."""

    def shape(psi):
        return np.sin(psi) * np.cos(psi) ** 2

    def inner(psi):
        low, high = RING_EDGES[j : j + 2]
        nearest = np.clip(psi, low, high)
        total = load = 0.0
        for end in (low, high):
            # psi' - nearest = (end - nearest) t^3 removes the logarithm
            t, w = unit_gauss(20)
            points = nearest + (end - nearest) * t**3
            w = w * 3 * t**2 * abs(end - nearest) * shape(points)
            load += np.sum(w)
            total += np.sum(w * kernel(np.sin(psi), np.sin(points)[:, None]))
        return total / load

    t, w = unit_gauss(24)
    low, high = RING_EDGES[i : i + 2]
    psi = low + (high - low) * t
    w = w * shape(psi)
    area = (np.sin(RING_EDGES[j + 1]) ** 2 - np.sin(RING_EDGES[j]) ** 2) / 2
    return 2 / hertz.G_STAR * area * np.sum(w * [inner(p) for p in psi]) / np.sum(w)


@pytest.mark.slow
@pytest.mark.parametrize(("i", "j"), [(0, 0), (2, 2), (3, 3), (1, 2), (3, 2), (0, 3), (3, 0)])
def test_ring_influence_is_the_average_over_both_rings(i, j):
    near, far = ring_influence(tuple(RING_EDGES), 17, True)
    for m in (0, 1, 5):
        direct = ring_average(lambda r, s, m=m: toroidal_mean(m, r, s), i, j)
        assert near[m, i, j] == pytest.approx(direct, rel=5e-5)
    for m in (1, 2, 5):
        cross = ring_average(lambda r, s, m=m: coupling_mean(m, r, s), i, j)
        assert far[m - 1, i, j] == pytest.approx(cross, rel=5e-5, abs=5e-6)


@pytest.mark.parametrize("focus", [None, 0.1, 0.8])
def test_ring_influence_is_reciprocal_and_positive_definite(focus):
    rings = make_rings(12, focus)
    near, far = ring_influence(tuple(rings.psi), 17, True)
    for count in (2, 3, 6):  # the recurrences depend on it
        fewer, others = ring_influence(tuple(rings.psi), count, True)
        assert fewer == pytest.approx(near[:count], rel=1e-9, abs=1e-13)
        assert others == pytest.approx(far[: len(others)], rel=1e-9, abs=1e-12)
    area = rings.area[:, None]
    symmetric = near * area
    assert symmetric == pytest.approx(symmetric.transpose(0, 2, 1), rel=1e-12)
    assert all(np.linalg.eigvalsh(matrix).min() > 0 for matrix in symmetric)
    # mode 1 couples to itself: C_1(r, s) = C_1(s, r)
    itself = far[0] * area
    assert itself == pytest.approx(itself.T, rel=1e-4)


# The whole operator of the contacts


@pytest.fixture
def rng():
    return np.random.default_rng(20201109)


def smooth_traction(coefficients, z):
    """Traction over the friction bound: Sum c[a, b] z^a conj(z)^b."""
    return sum(c * z**a * z.conj() ** b for (a, b), c in np.ndenumerate(coefficients))


def direct_displacement(coefficients, nu, z):
    """Displacement at z inside the contact under q = g(|z'|) smooth_traction(z').

    Polar coordinates about z remove the kernel 1/rho.  Along each chord, the square root in the
    bound is the weight of Gauss-Chebyshev quadrature; equal angles around z are spectrally
    accurate."""
    count = 16
    k = np.arange(1, count + 1) * np.pi / (count + 1)
    nodes, w = np.cos(k), np.pi / (count + 1) * np.sin(k) ** 2
    alpha = (np.arange(48) + 0.5) * np.pi / 48
    turn = np.exp(1j * alpha)[:, None]
    middle = (z.conjugate() * turn).real
    half = np.sqrt(middle**2 + 1 - abs(z) ** 2)
    q = 1.5 / np.pi * smooth_traction(coefficients, z - (middle + half * nodes) * turn)
    kappa = nu / (2 - nu)
    chords = np.sum(w * half**2 * (q + kappa * turn**2 * q.conj()), axis=1)
    return chords.sum() * np.pi / 48 / (np.pi * hertz.G_STAR)


def random_smooth_traction(rng, rotates):
    """Coefficients of a random traction with the symmetry of the polar contact."""
    c = rng.normal(size=(4, 4)) + 1j * rng.normal(size=(4, 4))
    a, b = np.indices(c.shape)
    if rotates:  # q(conj z) = -conj(q(z)): lateral odd, forward even across the lateral axis
        return 1j * c.real * (a + b < 5)
    return c * ((a + b) % 2 == 0) * (a + b < 5)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("rotates", [True, False])
def test_polar_operator_is_the_half_space_integral(rotates, nu, rng):
    for _ in range(2):
        coefficients = random_smooth_traction(rng, rotates)
        cells, errors = np.array([8, 16, 32]), []
        for n in cells:
            contact = PolarContact(int(n), 8, rotates, nu)
            z = contact.lateral_position + 1j * contact.forward_position
            q = smooth_traction(coefficients, z) * contact.bound
            u = contact.displacement(np.stack([q.imag, q.real]))
            some = (slice(1, None, 3), slice(n // 8, None, n // 8))
            exact = [direct_displacement(coefficients, nu, point) for point in z[some].ravel()]
            error = (u[1] + 1j * u[0])[some].ravel() - exact
            errors.append(np.sqrt(np.mean(np.abs(error) ** 2) / np.mean(np.abs(exact) ** 2)))
        assert errors[-1] < 3e-3
        assert fitted_order(cells, errors) == pytest.approx(2.0, abs=0.3)


# Tractions whose displacement is known
