"""The operator on rings times angles, and its resolvents, against a plain sum over modes."""

import numpy as np
import pytest

from microslip.contact.influence import ring_influence
from microslip.contact.modes import PolarContact
from microslip.contact.rings import make_rings

CASES = [
    (4, 2, True, 0.0, None),
    (4, 2, False, 0.3, None),
    (5, 4, True, 0.3, 0.5),
    (5, 4, False, 0.5, 0.5),
    (7, 6, False, 0.0, 0.8),
    (6, 8, True, 0.5, None),
    (6, 8, False, 0.3, None),
    (13, 10, True, 0.3, 0.3),
    (13, 10, False, 0.3, 0.3),
    (17, 12, True, 0.0, 0.9),
    (17, 12, False, 0.0, 0.9),
]
"""Rings, angles, whether the motion rotates, Poisson's ratio, focus."""
cases = pytest.mark.parametrize(("cells", "angles", "rotates", "nu", "focus"), CASES)


# The whole disc, mode by mode


def whole_disc(state, rotates):
    """q = lateral + i forward at theta_j = (j + 1/2) pi / M, j = 0 .. 2 M - 1, shape (2 M, N)."""
    q = state[1] + 1j * state[0]
    return np.concatenate([q, -q[::-1].conj() if rotates else q])


def ring_modes(cells, angles, nu, focus):
    """Functions near(m) and cross(m): matrices of rings from modes m and 2 - m (conjugated) to mode
    m."""
    rings = make_rings(cells, focus)
    near, far = ring_influence(rings.psi, angles + 2, True)
    kappa, area = nu / (2.0 - nu), rings.area

    def cross(m):
        if m > 1:
            return kappa * far[m - 1]
        swapped = kappa * (area[:, None] * far[1 - m]).T / area[:, None]  # reciprocity
        return swapped if m < 1 else 0.5 * (swapped + kappa * far[0])

    return lambda m: near[abs(m)], cross


def plain_displacement(state, cells, angles, rotates, nu, focus):
    """u = Sum_m e^{i m theta} (near_m q_m + cross_m conj(q_{2-m})), the sums written out.

    The modes are those that 2 M points can represent.  The shortest mode of a rotation is not
    coupled, because its cosine vanishes at the points."""
    near, cross = ring_modes(cells, angles, nu, focus)
    theta = (np.arange(2 * angles) + 0.5) * np.pi / angles
    q = whole_disc(state, rotates)
    modes = range(1 - angles, angles + 1)
    part = {m: np.exp(-1j * m * theta) @ q / (2 * angles) for m in modes}
    highest = angles - 1 if rotates else angles
    u = np.zeros_like(q)
    for m in modes:
        image = near(m) @ part[m]
        if m <= highest and 2 - m in part and 2 - m <= highest:
            image = image + cross(m) @ part[2 - m].conj()
        u += np.exp(1j * m * theta)[:, None] * image
    return np.stack([u.imag, u.real])


@pytest.fixture
def rng():
    return np.random.default_rng(12)


@cases
def test_operator_is_the_plain_sum_over_modes(cells, angles, rotates, nu, focus, rng):
    contact = PolarContact(cells, angles, rotates, nu, focus)
    for _ in range(3):
        state = rng.normal(size=(2, angles, cells))
        expected = plain_displacement(state, cells, angles, rotates, nu, focus)
        displacement = contact.displacement(state)
        assert displacement == pytest.approx(expected[:, :angles], abs=1e-12)
        # displacements of the other half of the disc follow from symmetry
        other = whole_disc(expected[:, :angles], rotates)[angles:]
        result = expected[1, angles:] + 1j * expected[0, angles:]
        assert result == pytest.approx(other, abs=1e-12)
    near, _ = ring_modes(cells, angles, nu, focus)
    assert contact.compliance == pytest.approx(np.diag(near(0)), rel=1e-12)
