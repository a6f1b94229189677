"""Closed forms of a Hertz contact against quadrature, elasticity and limits."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import ellipe, ellipkm1

from microslip.theory import hertz


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


@pytest.mark.parametrize("r", [1e-6, 0.3, 0.8, 1.0])
def test_load_inside_is_the_integral_of_the_bound(r):
    load = integral(lambda s: 2 * np.pi * s * hertz.friction_bound(s), 0, r)
    assert hertz.load_inside(r) == pytest.approx(load, rel=1e-10)


# Elliptic integrals and Lubkin's angle


@pytest.mark.parametrize("c", [1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1 - 1e-9])
def test_D_equals_its_defining_integral(c):
    # K - E = Integral of k^2 sin^2/sqrt(1 - k^2 sin^2), with k cos(phi) = c sinh(y).
    k = np.sqrt((1 - c) * (1 + c))
    value = integral(
        lambda y: k * np.sqrt(max(0.0, 1 - (c * np.sinh(y) / k) ** 2)), 0, np.arcsinh(k / c)
    )
    assert hertz.D(c) == pytest.approx(value, rel=1e-12)


def test_lubkin_stick_radius_over_the_whole_range():
    angles = np.array([0.0, *np.geomspace(1e-300, 1e300, 400)])
    c = hertz.lubkin_stick_radius(angles)
    assert c[0] == 1.0
    assert np.all((c > 0) & (c <= 1) & np.isfinite(c))
    assert np.all(np.diff(c) <= 0)
    assert hertz.lubkin_stick_radius([[0.1], [0.2]], [0.0, 0.3, 0.5]).shape == (2, 3)


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


BAD = [
    (hertz.friction_bound, "r", (-0.1,)),
    (hertz.load_inside, "r", (np.nan,)),
    (hertz.ring_bounds, "edges", ([0.0, 1.1],)),
    (hertz.ring_bounds, "edges", ([0.0, 0.5, 0.5],)),
    (hertz.D, "c", ([0.5, 0.0],)),
    (hertz.lubkin_angle, "stick_radius", (1.2,)),
    (hertz.lubkin_angle, "poisson", (0.5, 0.51)),
    (hertz.lubkin_stick_radius, "angle", (-1.0,)),
    (hertz.bore_angle, "amplitude", (np.inf,)),
    (hertz.mindlin_force, "u", (-1e-9,)),
    (hertz.mindlin_traction, "u", (0.1, np.nan)),
    (hertz.lubkin_traction, "stick_radius", (0.1, -0.5)),
    (hertz.lubkin_torque, "stick_radius", (2.0,)),
]


@pytest.mark.parametrize(("function", "name", "arguments"), BAD)
def test_bad_input_is_named(function, name, arguments):
    with pytest.raises(ValueError, match=rf"^{name} = .*allowed"):
        function(*arguments)
