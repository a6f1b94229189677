"""Closed forms of the paper against their integrals, limits and brute force."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from microslip.theory import axisymmetric, hertz
from microslip.theory import paper as theory

AMPLITUDE = st.floats(0.0, 5.0)


def integral(function, *ends, tolerance=1e-12):
    """Sum of adaptive quadratures over the consecutive intervals between `ends`."""
    options = {"epsabs": tolerance / 10, "epsrel": tolerance, "limit": 200}
    return sum(quad(function, a, b, **options)[0] for a, b in pairwise(ends))


def hertz_pressure(r):
    return np.sqrt(1 - r * r)


# Transverse oscillation


@pytest.mark.parametrize("ratio", [1e-8, 0.1, 1.0, 10.0, 1e3, 1e6])
def test_large_amplitude_transverse_is_eq_6(ratio):
    ends = [0.0, *(x / ratio for x in (1, 10, 100) if x < ratio), np.pi / 2]
    mean = 2 / np.pi * integral(lambda t: 1 / np.hypot(1, ratio * np.sin(t)), *ends)
    assert theory.large_amplitude_transverse(0.3, 0.3 * ratio) == pytest.approx(mean, rel=1e-11)


def test_large_amplitude_transverse_at_its_ends():
    assert np.all(theory.large_amplitude_transverse([0.0, 1e-3, 5.0], 0.0) == 1.0)
    assert theory.large_amplitude_transverse(0.0, 1.0) == 0.0
    # (2/pi) ln(4 A/v) v/A at large A/v
    for ratio in (1e7, 1e8, 1e10, 1e12):
        expected = 2 / np.pi * np.log(4 * ratio) / ratio
        assert theory.large_amplitude_transverse(1.0, ratio) == pytest.approx(expected, rel=1e-12)
    mean = theory.large_amplitude_transverse(np.geomspace(1e-6, 1e3, 200)[:, None], [0.5, 2.0])
    assert mean.shape == (200, 2)
    assert np.all(np.diff(mean, axis=0) > 0)
    assert np.all(mean[:, 0] > mean[:, 1])


def test_static_slider_and_stick_radius():
    assert theory.static_slider([0.0, 0.6, 1.0, 3.0]) == pytest.approx([1.0, 0.8, 0.0, 0.0])
    assert theory.stick_radius_transverse([0.0, 0.75, 1.0, 3.0]) == pytest.approx([1, 0.5, 0, 0])


@given(AMPLITUDE)
def test_eq_11_is_eq_10_at_the_radius_of_eq_8(amplitude):
    zone = theory.static_stick_zone(theory.stick_radius_transverse(amplitude))
    assert theory.static_transverse(amplitude) == pytest.approx(zone, abs=1e-14)


def test_stick_zone_of_any_pressure():
    c = np.array([[0.0, 1e-3], [0.5, 1.0]])
    general = axisymmetric.static_stick_zone_of(hertz_pressure, c)
    assert general == pytest.approx(theory.static_stick_zone(c), rel=1e-9)
    # Flat-ended punch: the load inside c is 1 - sqrt(1 - c^2); uniform pressure: c^2.
    punch = axisymmetric.static_stick_zone_of(lambda r: 1 / np.sqrt(1 - r * r), c)
    assert punch == pytest.approx(1 - np.sqrt(1 - c**2), abs=1e-8)
    assert axisymmetric.static_stick_zone_of(lambda r: 7.0, c) == pytest.approx(c**2, rel=1e-10)


# Continuous bore


def test_rotation_centre_does_not_move():
    velocity, omega = 0.8, 1.7
    lateral, forward = theory.rotation_centre(velocity, 0.3)
    # Velocity there: omega z-hat x (position - contact centre) + forward velocity.
    assert forward - 0.3 == 0.0
    assert omega * lateral + velocity * omega == 0.0
    assert theory.rotation_centre([0.1, 0.2], [[0.0], [1.0]])[0].shape == (2, 2)


@pytest.mark.parametrize("velocity", [0.0, 0.4, 1.0, 3.0])
def test_steady_traction_has_full_size_and_opposes_the_motion(velocity):
    lateral, forward = np.random.default_rng(3).uniform(-0.7, 0.7, (2, 500))
    traction = np.array(theory.steady_bore_traction(lateral, forward, velocity))
    motion = np.array([-forward, velocity + lateral])
    bound = hertz.friction_bound(np.hypot(lateral, forward))
    assert np.hypot(*traction) == pytest.approx(bound, rel=1e-13)
    power = np.sum(traction * motion, axis=0)
    assert power == pytest.approx(-bound * np.hypot(*motion), rel=1e-12)


def test_steady_traction_in_the_centre_of_rotation_is_zero():
    assert theory.steady_bore_traction(-0.4, 0.0, 0.4) == (0.0, 0.0)


@pytest.mark.parametrize("velocity", [0.05, 0.5, 0.8, 1.0, 1.3, 10.0])
def test_bore_forces_are_the_disc_integrals_of_the_steady_traction(velocity):
    # Polar midpoint rule about the contact centre; r = sin(beta) makes the edge smooth.
    n, m = 600, 800
    beta = (np.arange(n) + 0.5) * np.pi / (2 * n)
    angle = (np.arange(m) + 0.5) * 2 * np.pi / m
    r = np.sin(beta)[:, None]
    area = (np.cos(beta) * np.pi / (2 * n))[:, None] * r * 2 * np.pi / m
    x, y = r * np.cos(angle), r * np.sin(angle)
    lateral, forward = theory.steady_bore_traction(x, y, velocity)
    assert np.sum(lateral * area) == pytest.approx(0, abs=1e-12)  # Eq 16
    assert -np.sum(forward * area) == pytest.approx(theory.bore_forward(velocity), abs=1e-5)
    torque = -np.sum((forward * x - lateral * y) * area) / hertz.TORQUE_FULL_SLIP
    assert torque == pytest.approx(theory.bore_torque(velocity), abs=1e-5)


@pytest.mark.parametrize("ratio", [0, 1e-8, 0.3, 0.99, 1 - 1e-9, 1, 1 + 1e-9, 1.5, 10, 1e5, 1e8])
def test_kernels_are_eqs_19_and_20(ratio):
    def distance(t):
        # r^2 + 2 r cos + 1 without cancellation near the centre of rotation
        return np.sqrt((ratio - 1) ** 2 + 4 * ratio * np.cos(t / 2) ** 2)

    def kernel(numerator):
        return 2 * integral(lambda t: numerator(np.cos(t)) / distance(t), 0, 3, np.pi)

    forward, torque = kernel(lambda x: ratio * x + 1), kernel(lambda x: ratio + x)
    assert theory.forward_kernel(ratio) == pytest.approx(forward, rel=1e-10, abs=1e-12)
    assert theory.torque_kernel(ratio) == pytest.approx(torque, rel=1e-10, abs=1e-12)


@pytest.mark.parametrize("velocity", [1e-6, 0.1, 0.8, 0.999, 1.0, 1.001, 1.5, 30.0, 1e6])
def test_closed_bore_forms_are_the_integrals_of_the_kernels(velocity):
    forward, torque = axisymmetric.bore_of(hertz_pressure, velocity)
    assert theory.bore_forward(velocity) == pytest.approx(forward, rel=1e-10)
    assert theory.bore_torque(velocity) == pytest.approx(torque, rel=1e-10)


@pytest.mark.parametrize("velocity", [1.0, 1.0 + 1e-9, 1.01, 1.5, 4.0, 20.0])
def test_fast_bore_in_elementary_functions(velocity):
    # Derived by hand: the cubic of v <= 1 with arcsin(1/v) for pi/2, plus terms that cancel its
    # growth. The rounding error grows as v^4, so only moderate velocities are tested.
    v = velocity
    root = np.sqrt(1 - 1 / v**2)
    forward = 0.75 * ((v - v**3 / 4) * np.arcsin(1 / v) + (v**2 / 4 + 0.5) * root)
    assert theory.bore_forward(v) == pytest.approx(forward, abs=1e-14 * v**4)


def test_bore_limits_and_monotonicity():
    assert (theory.bore_forward(0.0), theory.bore_torque(0.0)) == (0.0, 1.0)
    assert 1 - theory.bore_forward(1e3) == pytest.approx(0.1e-6, rel=1e-6)
    assert theory.bore_torque(1e6) == pytest.approx(16 / (15 * np.pi) * 1e-6, rel=1e-11)
    v = np.geomspace(1e-4, 1e4, 2000)
    assert np.all(np.diff(theory.bore_forward(v)) > 0)
    assert np.all(np.diff(theory.bore_torque(v)) < 0)
    ends = theory.bore_forward(np.array([1 - 1e-9, 1 + 1e-9]))
    assert np.diff(ends)[0] == pytest.approx(2e-9 * 3 * np.pi / 32, rel=1e-5)


def test_bore_of_a_ring_of_pressure():
    def ring(r):
        return np.exp(-(((r - 0.7) / 0.02) ** 2))

    # A plain sum converges fast for a smooth ring.
    r = np.linspace(0, 1, 20001)
    weight = ring(r)
    forward, torque = axisymmetric.bore_of(ring, [0.3, 2.0])
    for i, v in enumerate((0.3, 2.0)):
        share = np.sum(weight * r * theory.forward_kernel(r / v)) / np.sum(weight * r)
        assert forward[i] == pytest.approx(share / (2 * np.pi), rel=1e-8)
        share = np.sum(weight * r**2 * theory.torque_kernel(r / v)) / np.sum(weight * r**2)
        assert torque[i] == pytest.approx(share / (2 * np.pi), rel=1e-8)


# Oscillating bore


@pytest.mark.parametrize(
    "velocity", [1e-6, 1e-3, 0.1, 0.5, 0.9, 0.9999, 1.0, 1.0001, 1.1, 3.0, 1e3, 1e6]
)
def test_large_amplitude_bore_is_the_mean_of_eq_21(velocity):
    # x = cos(tau) covers both branches; the integral is split at the steep part near x = v.
    turn = np.arccos(velocity) if velocity < 1 else 0.0
    mean = integral(
        lambda t: theory.bore_forward(velocity / np.cos(t)), *sorted({0.0, turn, np.pi / 2})
    )
    assert theory.large_amplitude_bore(velocity) == pytest.approx(2 / np.pi * mean, rel=1e-10)


@pytest.mark.slow
def test_large_amplitude_bore_limits():
    assert theory.large_amplitude_bore(0.0) == 0.0
    v = np.geomspace(1e-6, 1e6, 500)
    mean = theory.large_amplitude_bore(v)
    assert np.all(np.diff(mean[v < 1e3]) > 0)
    assert np.all(mean <= theory.bore_forward(v) * 3 * (1 + np.log(1 + 1 / v)))
    assert 1 - theory.large_amplitude_bore(1e3) == pytest.approx(0.05e-6, rel=1e-5)
    near = theory.large_amplitude_bore(1 + np.array([-1e-15, -1e-10, 0.0, 1e-10]))
    assert near == pytest.approx(near[2], abs=1e-9)


@given(st.floats(0.0, 50.0))
def test_bore_amplitude_and_stick_radius_are_inverse(amplitude):
    c = theory.bore_stick_radius(amplitude)
    assert theory.bore_amplitude_at(c) == pytest.approx(amplitude, rel=1e-12, abs=1e-15)


@pytest.mark.parametrize("nu", [0.0, 0.5])
def test_eq_31_is_eq_24_over_its_value_at_one_half(nu):
    ratio = hertz.lubkin_angle(0.2, nu) / hertz.lubkin_angle(0.5, nu)
    assert theory.bore_amplitude_at(0.2) == pytest.approx(ratio, rel=1e-14)


def test_static_bore_and_its_misprint():
    # At phi~ = 1 the stick radius is 1/2 by definition.
    assert theory.static_bore(1.0) == pytest.approx(1 - 0.75**1.5, rel=1e-13)
    assert theory.static_bore_printed(1.0) == pytest.approx(1 - 0.5**1.5, rel=1e-13)
    assert (theory.static_bore(0.0), theory.static_bore_printed(0.0)) == (1.0, 1.0)
    inside = theory.static_bore(np.linspace(0.0, 5.0, 100))
    assert np.all(np.diff(inside) < 0)


# The exact limits for v -> 0


def best_forward_traction(bound, oscillation, direction):
    """Largest forward part of a constant traction R with |R +- oscillation| <= bound.

    `direction` is the angle of the oscillating traction from the forward axis. The search is a
    brute force over the boundary of the two discs of possible R.
    """
    theta = np.linspace(-np.pi, np.pi, 20001)
    own = oscillation * np.exp(1j * direction)
    best = -np.inf
    for centre in (own, -own):
        edge = centre + bound * np.exp(1j * theta)
        best = max(best, np.max(edge.real[np.abs(edge + centre) <= bound * (1 + 1e-9)]))
    return best


@pytest.mark.parametrize("amplitude", [0.1, 0.5, 0.9])
def test_static_translations_are_the_best_constant_traction_point_by_point(amplitude):
    c = np.sqrt(1 - amplitude)
    nodes, weights = np.polynomial.legendre.leggauss(60)
    beta = np.pi / 4 * (nodes + 1)
    area = np.pi / 4 * weights * np.cos(beta) * c * 2 * np.pi * c * np.sin(beta)
    total = {0.0: 0.0, np.pi / 2: 0.0}
    for r, ring in zip(c * np.sin(beta), area, strict=True):
        own = hertz.mindlin_traction(r, amplitude)
        for direction in total:
            total[direction] += ring * best_forward_traction(
                hertz.friction_bound(r), own, direction
            )
    assert theory.static_limit_longitudinal(amplitude) == pytest.approx(total[0.0], abs=1e-4)
    assert theory.static_limit_transverse(amplitude) == pytest.approx(total[np.pi / 2], abs=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("amplitude", [0.3, 1.0, 2.0])
def test_static_bore_limit_is_the_best_constant_traction_point_by_point(amplitude):
    c = theory.bore_stick_radius(amplitude)
    nodes, weights = np.polynomial.legendre.leggauss(12)
    beta = np.pi / 4 * (nodes + 1)
    area = np.pi / 4 * weights * np.cos(beta) * c * 2 * np.pi * c * np.sin(beta)
    angles = (np.arange(12) + 0.5) * np.pi / 24  # a quarter of the circle is enough
    total = 0.0
    for r, ring in zip(c * np.sin(beta), area, strict=True):
        bound, own = hertz.friction_bound(r), hertz.lubkin_traction(r, c)
        total += ring * np.mean([best_forward_traction(bound, own, t) for t in angles])
    assert theory.static_limit_bore(amplitude) == pytest.approx(total, abs=3e-4)


@pytest.mark.parametrize("amplitude", [1e-6, 1e-3, 0.25, 0.5, 0.9, 0.9999])
def test_static_limit_transverse_is_its_integral(amplitude):
    def zone(s):
        rest = max(0.0, 1 - amplitude - s)
        return np.sqrt(max(0.0, 2 * np.sqrt((1 - s) * rest) - rest))

    mean = 1.5 * integral(zone, 0, (1 - amplitude) ** 2, 1 - amplitude, tolerance=1e-11)
    assert theory.static_limit_transverse(amplitude) == pytest.approx(mean, rel=1e-8)


@pytest.mark.parametrize("amplitude", [1e-3, 0.1, 0.5, 1.0, 2.0, 5.0])
def test_static_limit_bore_is_its_integral(amplitude):
    c = float(theory.bore_stick_radius(amplitude))

    def zone(t):  # r = c - t^4, where arccos has its quartic root
        r = c - t**4
        used = hertz.lubkin_traction(r, c) / hertz.friction_bound(r)
        return np.sqrt(1 - r * r) * np.arccos(min(used, 1.0)) * r * 4 * t**3

    mean = 6 / np.pi * integral(zone, 0, c**0.25, tolerance=1e-11)
    assert theory.static_limit_bore(amplitude) == pytest.approx(mean, rel=1e-8)


@given(AMPLITUDE)
def test_static_limits_lie_below_the_papers_estimates(amplitude):
    transverse, bore = (
        theory.static_limit_transverse(amplitude),
        theory.static_limit_bore(amplitude),
    )
    assert 0 <= transverse <= theory.static_transverse(amplitude) + 1e-14
    assert 0 <= bore <= theory.static_bore(amplitude) + 1e-14
    # Forward oscillation reduces the forward bound more than transverse oscillation.
    assert theory.static_limit_longitudinal(amplitude) <= transverse + 1e-14


def test_static_limits_at_their_ends():
    assert theory.static_limit_transverse([0.0, 1e-20, 1.0, 4.0]) == pytest.approx([1, 1, 0, 0])
    assert theory.static_limit_bore([0.0, 1e-20, 1e5]) == pytest.approx([1, 1, 0], abs=1e-13)
    small = np.geomspace(1e-12, 1e-6, 7)
    # At small amplitudes tau is that of a bonded disc, (4 G phi/pi) r/sqrt(1 - r^2) with
    # phi = 1 - c (nu = 0). The loss is 4 Integral tau r dr = (3/2) (1 - c), and D = (pi/2) (1 - c).
    loss = 1.5 * 2 / np.pi * hertz.D_half() * small
    assert 1 - theory.static_limit_bore(small) == pytest.approx(loss, rel=1e-3, abs=1e-13)
    # Near full slip the inner contact is small, and the limit is (6 sqrt(2)/5) c^(5/2).
    c = 1e-4
    assert theory.static_limit_transverse(1 - c**2) == pytest.approx(
        6 * np.sqrt(2) / 5 * c**2.5, rel=1e-3
    )
    grid = np.linspace(0, 1, 400)
    assert np.all(np.diff(theory.static_limit_transverse(grid)) < 0)
    assert np.all(np.diff(theory.static_limit_bore(5 * grid)) < 0)
    assert theory.static_limit_bore(np.ones((2, 3))).shape == (2, 3)
    assert theory.static_limit_transverse(np.ones((2, 3))).shape == (2, 3)


# Bad input

ONE_ARGUMENT = {
    "amplitude": "static_slider stick_radius_transverse static_transverse bore_stick_radius "
    "static_bore static_bore_printed static_limit_transverse static_limit_longitudinal "
    "static_limit_bore",
    "velocity": "rotation_centre bore_forward bore_torque large_amplitude_bore",
    "stick_radius": "static_stick_zone bore_amplitude_at",
    "ratio": "forward_kernel torque_kernel",
}
CASES = [(name, function) for name, row in ONE_ARGUMENT.items() for function in row.split()]


@pytest.mark.parametrize("bad", [-0.5, np.nan, np.inf])
@pytest.mark.parametrize(("name", "function"), CASES)
def test_bad_input_is_named(name, function, bad):
    with pytest.raises(ValueError, match=rf"^{name} = {bad}: allowed is .*{name}"):
        getattr(theory, function)([0.5, bad])


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: theory.large_amplitude_transverse(-0.1, 1.0), "velocity = -0.1"),
        (lambda: theory.large_amplitude_transverse(0.1, np.nan), "amplitude = nan"),
        (lambda: theory.static_stick_zone(1.5), "stick_radius = 1.5"),
        (
            lambda: axisymmetric.static_stick_zone_of(lambda r: 0.0, 0.5),
            "pressure integrates to 0.0",
        ),
        (lambda: theory.steady_bore_traction(np.nan, 0.0, 1.0), "lateral = nan"),
        (lambda: theory.steady_bore_traction(0.0, np.inf, 1.0), "forward = inf"),
        (lambda: axisymmetric.bore_of(hertz_pressure, 0.0), "velocity = 0.0"),
        (lambda: theory.bore_amplitude_at(0.0), "stick_radius = 0.0"),
    ],
)
def test_bad_input_of_several_arguments_is_named(call, message):
    with pytest.raises(ValueError, match=rf"^{message}: allowed"):
        call()
