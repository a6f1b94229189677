"""Bounds of the reduction of friction: their work balance, and frictions within them."""

import math

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.theory import exact, hertz
from microslip.theory.exact import largest_drop_bore, largest_drop_transverse


def largest_root(surplus, high):
    """Largest d in 0..high at which ``surplus`` turns from positive to negative."""
    return brentq(surplus, 1e-14, high, xtol=1e-15, rtol=1e-13)


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


NUMERICAL = [
    *(("transverse", "radial", 0.0, r * a, a) for r in (0.75, 3.0) for a in (0.3, 40.0)),
    ("transverse", "slider", 0.0, 3.0, 3.0),
    ("longitudinal", "radial", 0.0, 1.2, 1.0),
    ("transverse", "polar", 0.5, 6.0, 5.0),
    *(("bore", "polar", 0.5, 1.5, a) for a in (0.3, 2.0, 20.0)),
]


@pytest.mark.parametrize(("motion", "model", "nu", "velocity", "amplitude"), NUMERICAL)
def test_contacts_lie_within(motion, model, nu, velocity, amplitude):
    drop = getattr(exact, f"largest_drop_{motion}")
    result = microslip.solve(motion, velocity, amplitude, poisson=nu, model=model, tolerance=2e-3)
    assert result.model == model and result.converged
    lowest = 1.0 - drop(velocity, amplitude)
    assert 0.0 < lowest <= result.mu_macro + result.mu_macro_error
    assert result.mu_macro - result.mu_macro_error <= 1.0
