"""Influence coefficients against brute-force quadrature, closed forms and their own symmetries.

Complex notation: q = lateral + i forward, as in PHYSICS.md and halfspace.py.
"""

import numpy as np
import pytest
from scipy.integrate import quad

from microslip import hertz
from microslip.halfspace import coupling_kernels, ring_influence, toroidal_kernels
from microslip.models.cartesian import CartesianContact
from microslip.models.polar import PolarContact
from microslip.models.radial import RadialContact
from microslip.rings import make_rings

RADII = [(0.3, 0.9), (0.9, 0.3), (0.5, 0.52), (0.52, 0.5), (0.7, 0.7001), (0.999, 1e-3), (0.4, 0.5)]


def unit_gauss(count):
    x, w = np.polynomial.legendre.leggauss(count)
    return (x + 1) / 2, w / 2


NODES, WEIGHTS = unit_gauss(160)


def angular_mean(function, r, s):
    """(1/2 pi) Integral over the angle beta between two circles, for a function over R.

    function(beta, s) is what the mean of function / R is taken of, R the distance of r from
    s e^{i beta}; s: float or array of shape (n, 1).  Near beta = 0 the substitution
    2 sqrt(r s) sin(beta / 2) = |r - s| sinh(t) takes R away.
    """
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
    """Mode m at (r, 0) of e^{2 i alpha} / |z - z'| under conj(e^{i (2 - m) beta}) on the circle s."""

    def kernel(beta, s):
        apart = r - s * np.exp(1j * beta)
        return (np.exp(1j * (m - 2) * beta) * (apart / abs(apart)) ** 2).real

    return angular_mean(kernel, r, s)


def both_kernels(r, s, count=33):
    """(G_0 .. , C_1 ..) of the module, with a tail long enough for the downward recurrence."""
    torus, pair = np.empty(count + 2 + int(36 / abs(np.log(s / r)))), np.empty(count)
    toroidal_kernels(r, s, torus)
    coupling_kernels(r, s, torus, pair)
    return torus, pair


@pytest.mark.parametrize(("r", "s"), RADII)
def test_toroidal_kernels_are_angular_means(r, s):
    for count in (1, 2, 5, 40):  # the count decides which recurrence runs
        kernels = np.empty(count)
        toroidal_kernels(r, s, kernels)
        expected = [toroidal_mean(m, r, s) for m in range(count)]
        assert kernels == pytest.approx(expected, rel=1e-9, abs=1e-13)


@pytest.mark.parametrize(("r", "s"), RADII)
def test_coupling_kernels_are_angular_means(r, s):
    _, pair = both_kernels(r, s)
    expected = [coupling_mean(m, r, s) for m in range(1, len(pair) + 1)]
    assert pair == pytest.approx(expected, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("r", "s"), RADII)
def test_coupling_kernels_below_mode_one_are_those_of_swapped_radii(r, s):
    _, pair = both_kernels(s, r)
    expected = [coupling_mean(2 - m, r, s) for m in range(1, 9)]
    assert pair[:8] == pytest.approx(expected, rel=1e-9, abs=1e-12)


# Ring averages

RING_EDGES = np.array([0.0, 0.45, 0.7, 1.2, np.pi / 2])


def ring_average(kernel, i, j, hertzian):
    """2/G* times the mean of kernel(r, s) over rings i and j, times Integral r dr over ring j."""

    def shape(psi):
        return np.sin(psi) * np.cos(psi) ** (2 if hertzian else 1)

    def inner(psi):
        low, high = RING_EDGES[j : j + 2]
        nearest = np.clip(psi, low, high)
        total = load = 0.0
        for end in (low, high):
            # psi' - nearest = (end - nearest) t^3 takes the logarithm away
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


@pytest.mark.parametrize("hertzian", [True, False])
@pytest.mark.parametrize(("i", "j"), [(0, 0), (2, 2), (3, 3), (1, 2), (3, 2), (0, 3), (3, 0)])
def test_ring_influence_is_the_average_over_both_rings(i, j, hertzian):
    near, far = ring_influence(RING_EDGES, 6, True, hertz=hertzian)
    for m in (0, 1, 5):
        direct = ring_average(lambda r, s, m=m: toroidal_mean(m, r, s), i, j, hertzian)
        assert near[m, i, j] == pytest.approx(direct, rel=5e-5)
    for m in (1, 2, 5):
        cross = ring_average(lambda r, s, m=m: coupling_mean(m, r, s), i, j, hertzian)
        assert far[m - 1, i, j] == pytest.approx(cross, rel=5e-5, abs=5e-6)


@pytest.mark.parametrize("focus", [None, 0.1, 0.8])
@pytest.mark.parametrize("hertzian", [True, False])
def test_ring_influence_is_reciprocal_and_positive_definite(focus, hertzian):
    rings = make_rings(12, focus)
    near, far = ring_influence(rings.psi, 17, True, hertz=hertzian)
    area = rings.area[:, None]
    symmetric = near * area
    assert symmetric == pytest.approx(symmetric.transpose(0, 2, 1), rel=1e-12)
    assert all(np.linalg.eigvalsh(matrix).min() > 0 for matrix in symmetric)
    # mode 1 couples to itself: C_1(r, s) = C_1(s, r)
    itself = far[0] * area
    assert itself == pytest.approx(itself.T, rel=1e-4)


@pytest.mark.parametrize("uncoupled", [0, 3])
def test_ring_influence_without_coupling_has_the_same_direct_part(uncoupled):
    near, far = ring_influence(RING_EDGES, 5, False)
    coupled, _ = ring_influence(RING_EDGES, 5, True)
    assert not far.any()
    assert near[uncoupled] == pytest.approx(coupled[uncoupled], rel=1e-9)


# The whole operator of the contacts


def dense(contact):
    """Matrix of the influence operator on flattened states, shape (size, size)."""
    shape = (2, *np.broadcast_shapes(contact.bound.shape, contact.forward_position.shape))
    size = int(np.prod(shape))
    images = [contact.displacement(unit.reshape(shape)).ravel() for unit in np.eye(size)]
    return np.stack(images, axis=1)


def weights(contact):
    shape = (2, *np.broadcast_shapes(contact.bound.shape, contact.forward_position.shape))
    return np.broadcast_to(contact.weight, shape).ravel()


CONTACTS = {
    "radial": lambda nu: RadialContact.resolved(10, 0.7),
    "polar, translation": lambda nu: PolarContact(6, 6, False, nu, 0.7),
    "polar, odd number of angles": lambda nu: PolarContact(5, 5, False, nu),
    "polar, rotation": lambda nu: PolarContact(6, 5, True, nu, 0.3),
    "cartesian": lambda nu: CartesianContact(7, nu),
}


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("name", CONTACTS)
def test_operator_is_reciprocal_and_positive_definite(name, nu):
    contact = CONTACTS[name](nu)
    energy = weights(contact)[:, None] * dense(contact)
    assert energy == pytest.approx(energy.T, abs=1e-12 * np.abs(energy).max())
    assert np.linalg.eigvalsh(energy).min() > 0


@pytest.mark.parametrize("nu", [0.0, 0.5])
@pytest.mark.parametrize("name", CONTACTS)
def test_operator_commutes_with_the_mirror(name, nu, rng):
    contact = CONTACTS[name](nu)
    state = rng.normal(size=(2, *contact.forward_position.shape))
    image = contact.mirrored(contact.displacement(state))
    assert contact.displacement(contact.mirrored(state)) == pytest.approx(image, abs=1e-12)
    assert contact.mirrored(contact.mirrored(state)) == pytest.approx(state, abs=0)
    # what is mirrored is the lateral axis: forward force and torque stay, the rest turns over
    kept, turned = forces(contact, state), forces(contact, contact.mirrored(state))
    assert turned == pytest.approx(kept * [1, -1, 1 if False else -1], abs=1e-12)
