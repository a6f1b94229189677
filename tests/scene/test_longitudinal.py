"""The longitudinal motion: closed form, rings, springs and squares agree."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.theory.masing import longitudinal

POINTS = [(0.1, 0.5), (0.01, 0.5), (0.5, 2.0), (0.1, 1.0), (0.05, 3.0), (0.3, 0.31), (0.001, 0.2)]


def slowly(velocity, amplitude):
    """Mean friction by adaptive quadrature over the branches of the force."""

    def way(t):
        return velocity * t + amplitude * np.sin(t)

    def curve(d):
        return 1.0 - max(0.0, 1.0 - d) ** 1.5

    back = np.arccos(-velocity / amplitude)
    forth, end = 2 * np.pi - back, back + 2 * np.pi
    lowest = 1.0 - 2.0 * curve(0.5 * (way(back) - way(forth)))
    closed = brentq(lambda t: way(t) - way(back), forth, end)
    settings = {"epsabs": 1e-11, "limit": 400}
    area = quad(lambda t: 1 - 2 * curve((way(back) - way(t)) / 2), back, forth, **settings)[0]
    area += quad(
        lambda t: lowest + 2 * curve((way(t) - way(forth)) / 2), forth, closed, **settings
    )[0]
    return (area + end - closed) / (2 * np.pi)


@pytest.mark.parametrize(("velocity", "amplitude"), POINTS)
def test_the_quadrature_is_exact(velocity, amplitude):
    assert longitudinal(velocity, amplitude) == pytest.approx(slowly(velocity, amplitude), abs=1e-9)


@pytest.mark.parametrize(("velocity", "amplitude"), POINTS)
def test_rings_agree_within_their_certificate(velocity, amplitude):
    answer = microslip.solve("longitudinal", velocity, amplitude, model="radial", tolerance=3e-4)
    assert answer.converged
    assert abs(answer.mu_macro - longitudinal(velocity, amplitude)) <= answer.mu_macro_error


@pytest.mark.slow
def test_the_closed_form_is_taken_where_it_holds():
    assert microslip.solve("longitudinal", 0.1, 0.5).model == "closed-form"
    assert microslip.solve("longitudinal", 0.1, 0.5, poisson=0.3).model == "polar"


@pytest.mark.parametrize(
    ("velocity", "amplitude"), [(0.1, 0.5), (0.3, 2.0), (0.02, 0.9), (0.5, 9.0)]
)
def test_the_rigid_contact_and_the_elastic_slider_have_closed_forms_of_their_own(
    velocity, amplitude
):
    """The rigid contact slips forward for a known share of the time; the slider is a linear spring
    up to u_lim with Masing's rule."""
    rigid = microslip.solve("longitudinal", velocity, amplitude, model="rigid", tolerance=1e-4)
    exact = 2.0 / np.pi * np.arcsin(min(velocity / amplitude, 1.0))
    assert abs(rigid.mu_macro - exact) <= rigid.mu_macro_error + 1e-9
    slider = microslip.solve("longitudinal", velocity, amplitude, model="slider", tolerance=1e-4)
    exact = longitudinal(velocity, amplitude, lambda way: np.minimum(way, 1.0))
    # the kink of its loading curve is inside a panel of the quadrature
    assert abs(slider.mu_macro - exact) <= slider.mu_macro_error + 1e-4
    assert longitudinal(1e-9, 0.3, lambda way: np.minimum(way, 1.0)) == pytest.approx(0.7, abs=1e-3)
