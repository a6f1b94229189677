"""The longitudinal motion: closed form, rings, springs and squares agree."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import microslip
from microslip.theory import paper
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


@pytest.mark.parametrize("model", ["mdr", "polar"])
def test_springs_and_modes_agree_too(model):
    """The row of springs is exact for motion along one line."""
    answer = microslip.solve("longitudinal", 0.1, 0.7, model=model)
    assert abs(answer.mu_macro - longitudinal(0.1, 0.7)) <= answer.mu_macro_error


@pytest.mark.long
def test_squares_come_close():
    answer = microslip.solve("longitudinal", 0.2, 0.8, model="cartesian", cells=32, steps=128)
    assert answer.mu_macro == pytest.approx(longitudinal(0.2, 0.8), abs=5e-3)


@pytest.mark.slow
def test_the_closed_form_is_taken_where_it_holds():
    assert microslip.solve("longitudinal", 0.1, 0.5).model == "closed-form"
    assert microslip.solve("longitudinal", 0.1, 0.5, poisson=0.3).model == "polar"


@pytest.mark.slow
def test_nu_changes_little_and_keeps_the_order():
    """For motion along one line, nu changes the shape of the stick zone only."""
    answer = microslip.solve("longitudinal", 0.1, 0.5, poisson=0.3)
    assert answer.converged
    assert answer.mu_macro == pytest.approx(longitudinal(0.1, 0.5), abs=0.02)


def test_limits():
    amplitude = np.array([0.0, 0.2, 0.5, 0.9, 1.0, 2.0])
    slow = longitudinal(1e-9, amplitude)
    assert slow == pytest.approx(paper.static_limit_longitudinal(amplitude), abs=1e-6)
    assert longitudinal(0.0, amplitude) == pytest.approx(slow, abs=1e-6)
    assert longitudinal([1.0, 3.0], [1.0, 0.5]).tolist() == [1.0, 1.0]
    # at large amplitudes the force of a rigid block is +1 or -1
    rigid = 2.0 / np.pi * np.arcsin(0.3)
    assert longitudinal(0.3 * 1e5, 1e5) == pytest.approx(rigid, abs=1e-4)


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


def test_the_static_limit_is_computed_too():
    answer = microslip.solve("longitudinal", 0.0, 0.5, model="radial", tolerance=1e-4)
    assert abs(answer.mu_macro - 0.5**1.5) <= answer.mu_macro_error


def test_friction_rises_with_velocity_and_falls_with_amplitude():
    velocity, amplitude = np.geomspace(1e-4, 1, 60), np.linspace(0.05, 4, 50)
    table = longitudinal(*np.meshgrid(velocity, amplitude))
    assert (np.diff(table, axis=1) >= -1e-9).all()
    assert (np.diff(table, axis=0) <= 1e-9).all()


@pytest.mark.parametrize("bad", [(-0.1, 1.0), (0.1, np.nan), (0.1, -1.0)])
def test_bad_numbers_are_refused(bad):
    with pytest.raises(ValueError, match="velocity|amplitude"):
        longitudinal(*bad)


def test_a_period_from_inside():
    result = microslip.period("longitudinal", 0.1, 0.7)
    assert result.phase[-1] - result.phase[0] == pytest.approx(2 * np.pi)
    mean = np.trapezoid(result.force_forward, result.phase) / (2 * np.pi)
    assert mean == pytest.approx(longitudinal(0.1, 0.7), abs=2e-3)
    assert np.abs(result.traction_lateral).max() < 1e-6
    assert result.slip_forward[1:].sum(axis=0) == pytest.approx(0.1 * 2 * np.pi, rel=1e-3)
