"""Bounds of the reduction of friction: their work balance, and frictions within them."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.theory import hertz, paper
from microslip.theory.bounds import largest_drop_bore, largest_drop_transverse

ratios = st.floats(-6.0, 6.0).map(lambda x: 10**x)
amplitudes = st.floats(-6.0, 3.0).map(lambda x: 10**x)


def largest_root(surplus, high):
    """Largest d in 0..high at which ``surplus`` turns from positive to negative."""
    return brentq(surplus, 1e-14, high, xtol=1e-15, rtol=1e-13)


# Bounds from the work balance of a period


@pytest.mark.parametrize("ratio", [0.8, 1.0, 2.0, 30.0])
def test_transverse_drop_is_what_the_work_balance_allows(ratio):
    """The missing forward work v (1 - mu) is at most the lateral work y sqrt((1 - mu^2) / 2)."""

    def surplus(drop):
        mu = 1.0 - drop
        return math.sqrt((1.0 - mu * mu) / 2.0) - ratio * drop

    expected = largest_root(surplus, 2.0)
    assert largest_drop_transverse(3.0 * ratio, 3.0) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("velocity", [1.5, 2.0, 5.0, 50.0])
def test_bore_drop_is_what_the_work_balance_allows(velocity):
    second_moment = quad(lambda r: r**3 * math.pi * hertz.friction_bound(r), 0.0, 1.0)[0]

    def surplus(drop):
        return drop + math.sqrt(second_moment * drop) - velocity * drop

    expected = largest_root(surplus, 2.0)
    assert largest_drop_bore(velocity, 0.7) == pytest.approx(expected, rel=1e-9)


# Limits


def test_nothing_is_claimed_at_rest():
    """At vanishing velocity any friction is possible, so the bound is at least 1."""
    for amplitude in (1e-300, 1e-3, 1.0, 1e300):
        assert largest_drop_transverse(0.0, amplitude) >= 1.0
        assert largest_drop_bore(0.0, amplitude) >= 1.0


def test_no_vibration_lowers_nothing():
    for velocity in (0.0, 1e-300, 1.0, 1e300):
        assert largest_drop_transverse(velocity, 0.0) == 0.0
        assert largest_drop_bore(velocity, 0.0) == 0.0


@pytest.mark.parametrize(
    ("velocity", "amplitude"), [(1e300, 1e-300), (1e300, 1.0), (1.0, 5e-324), (1e155, 1e-5)]
)
def test_huge_ratios_do_not_overflow(velocity, amplitude):
    assert 0.0 <= largest_drop_transverse(velocity, amplitude) < 1e-200


@pytest.mark.parametrize("velocity", [1e149, 1e151, 1e300])
def test_huge_velocities_close_the_bracket_of_the_bore(velocity):
    assert 0.0 <= largest_drop_bore(velocity, 1.0) < 1e-200


def test_bore_bracket_opens_towards_velocity_one():
    """At velocities up to 1 the centre of rotation can rest within the contact."""
    velocities = [0.5, 1.0, np.nextafter(1.0, 2.0), 1.0 + 1e-160, 1.01, 1.0 + 0.999 * 0.2**0.5]
    assert all(largest_drop_bore(v, 2.0) >= 1.0 for v in velocities)
    assert largest_drop_bore(1.0 + 1.001 * 0.2**0.5, 2.0) < 1.0


@settings(max_examples=200, deadline=None, derandomize=True)
@given(ratios, amplitudes, st.floats(1.001, 10.0))
def test_brackets_close_as_the_velocity_grows(velocity, amplitude, factor):
    for drop in (largest_drop_transverse, largest_drop_bore):
        assert drop(factor * velocity, amplitude) <= drop(velocity, amplitude)
    # the bound of translations depends on the ratio only
    scaled = largest_drop_transverse(factor * velocity, factor * amplitude)
    assert scaled == pytest.approx(largest_drop_transverse(velocity, amplitude), rel=1e-12)


# Frictions within the bounds


@pytest.mark.slow
@settings(max_examples=300, deadline=None, derandomize=True)
@given(ratios, amplitudes)
def test_rigid_contacts_lie_within(ratio, amplitude):
    rigid = float(paper.large_amplitude_transverse(ratio * amplitude, amplitude))
    assert 1.0 - largest_drop_transverse(ratio * amplitude, amplitude) <= rigid + 1e-14
    rigid = float(paper.large_amplitude_bore(ratio))
    assert 1.0 - largest_drop_bore(ratio, amplitude) <= rigid + 1e-14


NUMERICAL = [
    *(("transverse", "radial", 0.0, r * a, a) for r in (0.75, 1.0, 3.0) for a in (0.3, 3.0, 40.0)),
    *(("transverse", "slider", 0.0, r * a, a) for r in (0.75, 1.0, 3.0) for a in (0.3, 3.0, 40.0)),
    *(("transverse", "polar", nu, 1.2 * a, a) for nu in (0.2, 0.5) for a in (0.5, 5.0)),
    *(("bore", "polar", nu, v, 2.0) for nu in (0.0, 0.3, 0.5) for v in (1.5, 3.0)),
    *(("bore", "polar", 0.3, 1.6, a) for a in (0.3, 20.0)),
]


@pytest.mark.parametrize(("motion", "model", "nu", "velocity", "amplitude"), NUMERICAL)
def test_elastic_contacts_lie_within(motion, model, nu, velocity, amplitude):
    drop = {"transverse": largest_drop_transverse, "bore": largest_drop_bore}[motion]
    result = microslip.solve(motion, velocity, amplitude, poisson=nu, model=model, tolerance=2e-3)
    assert result.model == model and result.converged
    lowest = 1.0 - drop(velocity, amplitude)
    assert 0.0 < lowest <= result.mu_macro + result.mu_macro_error
    assert result.mu_macro - result.mu_macro_error <= 1.0


# Width of the bounds


@pytest.mark.parametrize("ratio", [30.0, 300.0, 3e3])
def test_brackets_are_four_times_the_drop_of_the_rigid_contact(ratio):
    """At large velocity the rigid drop is (y/v)^2 / 4, a quarter of the bound."""
    phase = np.linspace(0.0, 2.0 * np.pi, 4096, endpoint=False)
    aside = np.cos(phase) / ratio
    rigid_drop = np.mean(aside**2 / (np.hypot(1.0, aside) * (1.0 + np.hypot(1.0, aside))))
    assert rigid_drop == pytest.approx(0.25 / ratio**2, rel=2e-3)
    assert largest_drop_transverse(ratio, 1.0) == pytest.approx(4.0 * rigid_drop, rel=2e-3)
    turning = 1.0 - float(paper.large_amplitude_bore(ratio))
    away = (1.0 - 1.0 / ratio) ** 2
    assert largest_drop_bore(ratio, 1.0) * away == pytest.approx(4.0 * turning, rel=2e-3)
