"""The operator on rings x angles against a plain sum over modes; steps against plain descent."""

import numba
import numpy as np
import pytest
from reference_march import solved_stage

from microslip.contacts.operators import multiply
from microslip.contacts.splitting import PENALTIES
from microslip.models.contact import energy_norm
from microslip.models.path import EULER, SDIRK2, make_path
from microslip.models.polar.contact import PolarContact
from microslip.models.rings.influence import ring_influence
from microslip.models.rings.mesh import make_rings

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
    """near(m) and cross(m), ring matrices of mode m under modes m and 2 - m (conjugated)."""
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

    Modes are those that 2 M points tell apart; the shortest of a rotating motion couples to none,
    since its points hold no cosine of it.
    """
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


@numba.njit
def apply_here(operators, number, field, image):
    multiply(operators, number, field, image)


def operator_of(contact, number=0):
    """An operator of a contact as a function of states (2, M, N)."""

    def apply(state):
        field = contact.layout.pack(state)
        image = np.empty_like(field)
        apply_here(contact.system().operators, number, field, image)
        return contact.layout.unpack(image)

    return apply


def matrix_of(apply, angles, cells):
    """Dense matrix of a function of states, by its columns."""
    units = np.eye(2 * angles * cells).reshape(-1, 2, angles, cells)
    return np.stack([apply(unit).ravel() for unit in units], axis=1)


@pytest.fixture
def rng():
    return np.random.default_rng(12)


@cases
def test_operator_is_the_plain_sum_over_modes(cells, angles, rotates, nu, focus, rng):
    contact = PolarContact(cells, angles, rotates, nu, focus)
    for _ in range(3):
        state = rng.normal(size=(2, angles, cells))
        expected = plain_displacement(state, cells, angles, rotates, nu, focus)
        moved = contact.displacement(state)
        assert moved == pytest.approx(expected[:, :angles], abs=1e-12)
        # the other half of the disc moves as the symmetry says
        other = whole_disc(expected[:, :angles], rotates)[angles:]
        found = expected[1, angles:] + 1j * expected[0, angles:]
        assert found == pytest.approx(other, abs=1e-12)
    near, _ = ring_modes(cells, angles, nu, focus)
    assert contact.compliance == pytest.approx(np.diag(near(0)), rel=1e-12)


@pytest.mark.slow
@cases
def test_operator_is_symmetric_and_positive_in_the_energy(cells, angles, rotates, nu, focus):
    contact = PolarContact(cells, angles, rotates, nu, focus)
    matrix = matrix_of(contact.displacement, angles, cells)
    area = np.tile(make_rings(cells, focus).area, 2 * angles)
    energy = area[:, None] * matrix
    assert energy == pytest.approx(energy.T, abs=1e-13 * np.abs(energy).max())
    assert np.linalg.eigvalsh(energy).min() > 0.0


@cases
def test_resolvents_undo_the_shifted_operator(cells, angles, rotates, nu, focus, rng):
    contact = PolarContact(cells, angles, rotates, nu, focus)
    apply = operator_of(contact)
    for number, factor in enumerate(PENALTIES, start=1):
        inverse, shift = operator_of(contact, number), factor * contact_penalty(contact)
        state = rng.normal(size=(2, angles, cells))
        assert inverse(apply(state) + shift * state) == pytest.approx(state, abs=1e-10)
        back = inverse(state)
        assert apply(back) + shift * back == pytest.approx(state, abs=1e-10)


def contact_penalty(contact):
    """Penalty of the solver at every point of a state."""
    return contact.layout.unpack(contact.system().solver.penalty)


# Steps


def path_through(motions, integrator=EULER):
    """Straight lines through rows of (forward, lateral, angle), a step each."""
    motions, phase = np.asarray(motions, dtype=float), np.arange(len(motions))

    def displacement(t):
        return tuple(np.interp(t, phase, column) for column in motions.T)

    return make_path(displacement, phase, integrator)


MOTIONS = {
    True: [(0, 0, 0), (0, 0, 0.7), (0.2, 0, 0.4), (0.5, 0, -0.9), (0.5, 0, -0.8)],
    False: [(0, 0, 0), (0, 0.6, 0), (0.2, 0.3, 0), (0.4, -0.5, 0), (0.45, -0.45, 0)],
}


@pytest.mark.slow
@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("rotates", [True, False])
def test_steps_are_the_solutions_of_plain_descent(rotates, nu, integrator):
    cells, angles = 5, 4
    contact = PolarContact(cells, angles, rotates, nu, 0.6)

    def displacement(state):
        return plain_displacement(state, cells, angles, rotates, nu, 0.6)[:, :angles]

    def rigid(way):
        forward, lateral, angle = way
        turn = np.stack([contact.lateral_position, -contact.forward_position])
        return np.array([forward, lateral])[:, None, None] + angle * turn

    gamma = 1.0 - 0.5**0.5  # of the two stages of SDIRK2, the first at gamma
    matrix = matrix_of(displacement, angles, cells)
    q = np.zeros((2, angles, cells))
    motions, sliding = np.array(MOTIONS[rotates]), []
    for before, after in zip(motions[:-1], motions[1:], strict=True):
        held, expected = displacement(q), q
        b = held + rigid(after - before)
        if integrator is SDIRK2:
            early = held + gamma * rigid(after - before)
            expected = solved_stage(matrix, early, contact.bound, q)
            b = b - (1.0 - gamma) / gamma * (early - displacement(expected))
        expected = solved_stage(matrix, b, contact.bound, expected)
        path = path_through([before, after], integrator)
        assert contact.march(path, q, 1e-11).state == pytest.approx(expected, abs=1e-8)
        q = expected
        sliding.append(np.mean(np.hypot(*q) > contact.bound * (1.0 - 1e-9)))
    # most points slip in some steps and stick in others: both branches of the law count
    assert min(sliding) < 0.2 and 0.5 < max(sliding) < 1.0


@pytest.mark.parametrize("integrator", [EULER, SDIRK2], ids=lambda method: method.name)
@pytest.mark.parametrize(("rotates", "nu"), [(True, 0.0), (True, 0.3), (False, 0.3)])
def test_a_previous_march_saves_work_and_changes_nothing(rotates, nu, integrator, rng):
    contact = PolarContact(8, 6, rotates, nu, 0.5)
    path = path_through(MOTIONS[rotates], integrator)
    ones = np.ones((6, 8))
    state = 0.5 * contact.bound * np.stack([ones, 0.0 * ones])
    near_by = state + 1e-3 * contact.bound * rng.normal(size=state.shape)
    exact = contact.march(path, state, 1e-12)
    for tolerance in (1e-4, 1e-7):
        previous = contact.march(path, near_by, tolerance)
        fields = previous.fields.copy()
        plain = contact.march(path, state, tolerance)
        warm = contact.march(path, state, tolerance, previous=previous)
        assert np.array_equal(previous.fields, fields)
        assert warm.iterations < 0.8 * plain.iterations
        for march in (plain, warm):
            assert march.residual <= march.solves * tolerance
            assert energy_norm(contact, march.state - exact.state) < 10 * march.solves * tolerance
            assert march.forces == pytest.approx(exact.forces, abs=10 * march.solves * tolerance)
    # guesses that are far off mislead nobody
    path_back = path_through(np.negative(MOTIONS[rotates]), integrator)
    misled = contact.march(path, state, 1e-7, previous=contact.march(path_back, -state, 1e-7))
    assert energy_norm(contact, misled.state - exact.state) < 10 * misled.solves * 1e-7
