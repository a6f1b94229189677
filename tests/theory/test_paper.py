"""Closed forms of the paper against their integrals, limits and brute force."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from theory.test_hertz import integral

from microslip.theory import hertz, indenters
from microslip.theory import paper as theory

AMPLITUDE = st.floats(0.0, 5.0)


def hertz_pressure(r):
    return np.sqrt(1 - r * r)


# Transverse oscillation


@pytest.mark.parametrize("ratio", [1e-8, 0.1, 1.0, 10.0, 1e3, 1e6])
def test_large_amplitude_transverse_is_eq_6(ratio):
    ends = [0.0, *(x / ratio for x in (1, 10, 100) if x < ratio), np.pi / 2]
    mean = 2 / np.pi * integral(lambda t: 1 / np.hypot(1, ratio * np.sin(t)), *ends)
    assert theory.large_amplitude_transverse(0.3, 0.3 * ratio) == pytest.approx(mean, rel=1e-11)


@given(AMPLITUDE)
def test_eq_11_is_eq_10_at_the_radius_of_eq_8(amplitude):
    zone = theory.static_stick_zone(theory.stick_radius_transverse(amplitude))
    assert theory.static_transverse(amplitude) == pytest.approx(zone, abs=1e-14)


def test_stick_zone_of_any_pressure():
    c = np.array([[0.0, 1e-3], [0.5, 1.0]])
    general = indenters.static_stick_zone_of(hertz_pressure, c)
    assert general == pytest.approx(theory.static_stick_zone(c), rel=1e-9)
    # Flat-ended punch: the load inside c is 1 - sqrt(1 - c^2); uniform pressure: c^2.
    punch = indenters.static_stick_zone_of(lambda r: 1 / np.sqrt(1 - r * r), c)
    assert punch == pytest.approx(1 - np.sqrt(1 - c**2), abs=1e-8)
    assert indenters.static_stick_zone_of(lambda r: 7.0, c) == pytest.approx(c**2, rel=1e-10)


# Continuous bore


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


@pytest.mark.parametrize("velocity", [0.0, 1e-6, 0.1, 0.8, 0.999, 1.0, 1.001, 1.5, 30.0, 1e6])
def test_closed_bore_forms_are_the_integrals_of_the_kernels(velocity):
    forward, torque = indenters.bore_of(hertz_pressure, velocity)
    assert theory.bore_forward(velocity) == pytest.approx(forward, rel=1e-10)
    assert theory.bore_torque(velocity) == pytest.approx(torque, rel=1e-10)


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


BAD = {
    "amplitude": "static_slider stick_radius_transverse static_transverse bore_stick_radius "
    "static_bore static_bore_printed static_limit_transverse static_limit_longitudinal "
    "static_limit_bore",
    "velocity": "rotation_centre bore_forward bore_torque large_amplitude_bore",
    "stick_radius": "static_stick_zone bore_amplitude_at",
    "ratio": "forward_kernel torque_kernel",
}
"""Name of the argument -> functions of this argument alone."""


@pytest.mark.parametrize(("name", "functions"), BAD.items())
def test_bad_input_is_named(name, functions):
    for function in functions.split():
        for bad in (-0.5, np.nan):
            with pytest.raises(ValueError, match=rf"^{name} = {bad}: allowed is .*{name}"):
                getattr(theory, function)([0.5, bad])
