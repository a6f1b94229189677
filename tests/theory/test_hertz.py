"""Closed forms of a Hertz contact against quadrature, elasticity and limits."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.special import ellipe, ellipkm1

from microslip.theory import hertz

POISSON = st.floats(0.0, 0.5)


def integral(function, *ends, tolerance=1e-12):
    """Sum of adaptive quadratures over the consecutive intervals between `ends`."""
    options = {"epsabs": tolerance / 10, "epsrel": tolerance, "limit": 200}
    return sum(quad(function, a, b, **options)[0] for a, b in pairwise(ends))


def ring_integrals(r, s):
    """K and E of the ring kernel at 1 - m = (r - s)^2/(r + s)^2, finite also at s = r."""
    rest = max(((r - s) / (r + s)) ** 2, 1e-60)
    return ellipkm1(rest), ellipe(1 - rest)


def cosine_kernel(r, s):
    """Integral over the angle of cos/rho between the radii r and s."""
    first, second = ring_integrals(r, s)
    return 2 * ((r * r + s * s) * first - (r + s) ** 2 * second) / (r * s * (r + s))


# Pressure and rings


def test_friction_bound_carries_the_load_and_the_full_slip_torque():
    assert integral(lambda r: 2 * np.pi * r * hertz.friction_bound(r), 0, 1) == pytest.approx(1)
    torque = integral(lambda r: 2 * np.pi * r**2 * hertz.friction_bound(r), 0, 1)
    assert pytest.approx(torque, rel=1e-12) == hertz.TORQUE_FULL_SLIP
    assert np.array_equal(hertz.friction_bound([1.0, 1.5]), [0.0, 0.0])


@pytest.mark.parametrize("r", [1e-6, 0.3, 0.8, 1.0])
def test_load_inside_is_the_integral_of_the_bound(r):
    load = integral(lambda s: 2 * np.pi * s * hertz.friction_bound(s), 0, r)
    assert hertz.load_inside(r) == pytest.approx(load, rel=1e-10)


@given(st.lists(st.floats(0.001, 0.999), min_size=1, max_size=20, unique=True))
def test_ring_bounds_times_areas_sum_to_the_load(inner):
    edges = np.array([0.0, *sorted(inner), 1.0])
    means = hertz.ring_bounds(edges)
    assert np.sum(means * np.pi * np.diff(edges**2)) == pytest.approx(1, rel=1e-12)
    g = hertz.friction_bound(edges)
    assert np.all((means <= g[:-1] * (1 + 1e-14)) & (means >= g[1:] * (1 - 1e-14)))


def test_ring_bounds_are_means_even_of_thin_rings():
    edges = np.array([0.2, 0.5, 0.5 + 1e-9, 0.99, 1.0])
    means = hertz.ring_bounds(edges)
    for a, b, mean in zip(edges[:-1], edges[1:], means, strict=True):
        load = integral(lambda r: 2 * r * hertz.friction_bound(r), a, b)
        # The area of the thin ring itself is known to 1e-7 only.
        assert mean == pytest.approx(load / (b**2 - a**2), rel=1e-6 if b - a < 1e-6 else 1e-9)
    assert means[1] == pytest.approx(hertz.friction_bound(0.5), rel=1e-8)


# Elliptic integrals and Lubkin's angle


@pytest.mark.parametrize("c", [1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1 - 1e-9])
def test_D_equals_its_defining_integral(c):
    # K - E = Integral of k^2 sin^2/sqrt(1 - k^2 sin^2), with k cos(phi) = c sinh(y).
    k = np.sqrt((1 - c) * (1 + c))
    value = integral(
        lambda y: k * np.sqrt(max(0.0, 1 - (c * np.sinh(y) / k) ** 2)), 0, np.arcsinh(k / c)
    )
    assert hertz.D(c) == pytest.approx(value, rel=1e-12)


def test_D_at_its_ends_and_at_one_half():
    assert hertz.D(1.0) == 0.0
    assert hertz.D(1e-200) == pytest.approx(np.log(4e200) - 1, rel=1e-14)
    assert pytest.approx(0.94546, abs=5e-6) == hertz.D_half()  # the paper, to four digits
    assert np.all(np.diff(hertz.D(np.geomspace(1e-12, 1, 500))) < 0)


@given(st.floats(-60.0, 0.0), POISSON)
def test_lubkin_angle_and_stick_radius_are_inverse(log_c, nu):
    c = np.exp(log_c)
    back = hertz.lubkin_stick_radius(hertz.lubkin_angle(c, nu), nu)
    assert back == pytest.approx(c, rel=1e-12)


@given(st.floats(0.0, 300.0), POISSON)
def test_lubkin_stick_radius_reproduces_its_angle(angle, nu):
    c = hertz.lubkin_stick_radius(angle, nu)
    assert hertz.lubkin_angle(c, nu) == pytest.approx(angle, rel=1e-12, abs=1e-15)


def test_lubkin_stick_radius_over_the_whole_range():
    angles = np.array([0.0, *np.geomspace(1e-300, 1e300, 400)])
    c = hertz.lubkin_stick_radius(angles)
    assert c[0] == 1.0
    assert np.all((c > 0) & (c <= 1) & np.isfinite(c))
    assert np.all(np.diff(c) <= 0)
    assert hertz.lubkin_stick_radius([[0.1], [0.2]], [0.0, 0.3, 0.5]).shape == (2, 3)


@given(st.floats(0.0, 1e6), POISSON)
def test_bore_angle_and_amplitude_are_inverse(amplitude, nu):
    angle = hertz.bore_angle(amplitude, nu)
    assert hertz.bore_amplitude(angle, nu) == pytest.approx(amplitude, rel=1e-14)


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
def test_bore_amplitude_one_leaves_half_the_radius(nu):
    assert hertz.lubkin_stick_radius(hertz.bore_angle(1.0, nu), nu) == pytest.approx(0.5)


# Cattaneo and Mindlin


@pytest.mark.parametrize("u", [1e-6, 0.1, 0.5, 0.9, 1.0])
def test_mindlin_force_is_the_integral_of_its_traction(u):
    c = float(hertz.mindlin_stick_radius(u))
    force = integral(lambda r: 2 * np.pi * r * hertz.mindlin_traction(r, u), 0, c, 1)
    assert hertz.mindlin_force(u) == pytest.approx(force, rel=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("u", [0.05, 0.5, 0.95])
def test_mindlin_traction_displaces_the_stick_zone_uniformly(u):
    def displacement(r):
        # Potential of a ring of unit traction: 4 s/(r + s) K.
        def ring(s):
            return 4 * s / (r + s) * ring_integrals(r, s)[0] * hertz.mindlin_traction(s, u)

        total = integral(ring, *sorted({0.0, r, c, 1.0}), tolerance=1e-9)
        return total / (np.pi * hertz.G_STAR)

    c = float(hertz.mindlin_stick_radius(u))
    for r in (0.1 * c, 0.5 * c, 0.9 * c):
        assert displacement(r) == pytest.approx(u, rel=1e-8)
    assert displacement((1 + c) / 2) < u * (1 - 1e-4)


def test_mindlin_limits():
    assert np.array_equal(hertz.mindlin_force([0.0, 1.0, 7.0]), [0.0, 1.0, 1.0])
    r = np.linspace(0, 1.2, 200)
    assert np.array_equal(hertz.mindlin_traction(r, 2.0), hertz.friction_bound(r))
    assert np.array_equal(hertz.mindlin_traction(r, 0.0), np.zeros_like(r))
    traction = hertz.mindlin_traction(r, np.linspace(0, 1, 30)[:, None])
    assert np.all(traction <= hertz.friction_bound(r) * (1 + 1e-12))
    # Stiffness of the whole contact: 2 G* a.
    assert hertz.mindlin_force(1e-9) / 1e-9 == pytest.approx(2 * hertz.G_STAR, rel=1e-8)


# Lubkin


@pytest.mark.parametrize("c", [1e-3, 0.1, 0.5, 0.9, 0.999])
def test_lubkin_traction_is_the_sum_of_rigid_rotation_punches(c):
    # (3/pi^2) r Integral_c^1 E(k)/(s sqrt(s^2 - r^2)) ds, with sin(psi) = r/s.
    for r in np.array([0.001, 0.1, 0.5, 0.9, 0.999]) * c:
        angles = np.arcsin(r / np.array([1.0, min(1.0, 3 * c), c]))
        punches = integral(lambda psi, r=r: ellipe(1 - (r / np.sin(psi)) ** 2), *angles)
        assert hertz.lubkin_traction(r, c) == pytest.approx(3 / np.pi**2 * punches, rel=1e-10)


@pytest.mark.slow
@pytest.mark.parametrize("nu", [0.0, 0.4])
@pytest.mark.parametrize("c", [0.3, 0.8])
def test_lubkin_traction_rotates_the_stick_zone_rigidly(c, nu):
    # Angular integrals of the half-space kernel for circumferential tractions on a ring:
    # cos/rho, and for the coupling term exactly its negative (next test), so kappa adds to 1.
    factor = (1 + nu / (2 - nu)) / (np.pi * hertz.G_STAR)

    def twist(r):
        def ring(s):
            return s * hertz.lubkin_traction(s, c) * cosine_kernel(r, s)

        return factor * integral(ring, *sorted({0.0, r, c, 1.0}), tolerance=1e-9) / r

    angle = hertz.lubkin_angle(c, nu)
    for r in (0.2 * c, 0.6 * c, 0.95 * c):
        assert twist(r) == pytest.approx(angle, rel=1e-6)
    assert twist((1 + c) / 2) < angle * (1 - 1e-3)


def test_ring_kernels_of_torsion_are_the_angular_integrals():
    r, s = 0.4, 0.7

    def rho(t):
        return np.sqrt(r * r + s * s - 2 * r * s * np.cos(t))

    plain = integral(lambda t: np.cos(t) / rho(t), 0, 2 * np.pi)
    # Re[(z - z')^2 e^(-i t)]/rho^3 for z = r, z' = s e^(i t)
    coupled = integral(
        lambda t: ((r * r + s * s) * np.cos(t) - 2 * r * s) / rho(t) ** 3, 0, 2 * np.pi
    )
    assert cosine_kernel(r, s) == pytest.approx(plain, rel=1e-11)
    assert coupled == pytest.approx(-plain, rel=1e-10)


@pytest.mark.parametrize("c", [1e-9, 1e-3, 0.3, 0.5, 0.9, 1 - 1e-6])
def test_lubkin_torque_is_the_integral_of_its_traction(c):
    torque = integral(lambda r: 2 * np.pi * r**2 * hertz.lubkin_traction(r, c), 0, c, 1)
    assert hertz.lubkin_torque(c) == pytest.approx(torque, rel=1e-9, abs=1e-14)


def test_lubkin_limits():
    assert hertz.lubkin_torque([0.0, 1e-300, 1.0]) == pytest.approx(
        [hertz.TORQUE_FULL_SLIP, hertz.TORQUE_FULL_SLIP, 0.0], rel=1e-13
    )
    assert np.all(np.diff(hertz.lubkin_torque(np.linspace(0, 1, 300))) < 0)
    r, c = np.linspace(0, 1.1, 111), np.array([0.0, 1e-200, 1e-3, 0.4, 0.97, 1.0])[:, None]
    traction = hertz.lubkin_traction(r, c)
    bound = np.broadcast_to(hertz.friction_bound(r), traction.shape)
    assert np.all((traction >= 0) & (traction <= bound))
    assert np.array_equal(traction[r + 0 * c >= c], bound[r + 0 * c >= c])
    assert np.all(hertz.lubkin_share(0.0, c[1:]) == 0)


@pytest.mark.parametrize("nu", [0.0, 0.25, 0.5])
def test_first_torsion_is_that_of_the_glued_disc(nu):
    shear_modulus = hertz.G_STAR * (2 - nu) / 4
    c = 1 - 1e-7
    stiffness = hertz.lubkin_torque(c) / hertz.lubkin_angle(c, nu)
    assert stiffness == pytest.approx(16 / 3 * shear_modulus, rel=1e-4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: hertz.friction_bound(-0.1), "r = -0.1"),
        (lambda: hertz.load_inside(np.nan), "r = nan"),
        (lambda: hertz.ring_bounds([0.0, 1.1]), "edges = 1.1"),
        (lambda: hertz.ring_bounds([0.0, 0.5, 0.5]), "edges = "),
        (lambda: hertz.ring_bounds([0.5]), "edges = "),
        (lambda: hertz.D([0.5, 0.0]), "c = 0.0"),
        (lambda: hertz.lubkin_angle(1.2), "stick_radius = 1.2"),
        (lambda: hertz.lubkin_angle(0.5, 0.51), "poisson = 0.51"),
        (lambda: hertz.lubkin_stick_radius(-1.0), "angle = -1.0"),
        (lambda: hertz.bore_angle(np.inf), "amplitude = inf"),
        (lambda: hertz.bore_amplitude(1.0, -0.1), "poisson = -0.1"),
        (lambda: hertz.mindlin_force(-1e-9), "u = -1e-09"),
        (lambda: hertz.mindlin_traction(0.1, np.nan), "u = nan"),
        (lambda: hertz.lubkin_traction(0.1, -0.5), "stick_radius = -0.5"),
        (lambda: hertz.lubkin_torque(2.0), "stick_radius = 2.0"),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(ValueError, match=rf"^{message}.*allowed"):
        call()
