"""The static limit: closed forms, pointwise solutions with every model, and slow marches."""

import numpy as np
import pytest

from microslip.contact.registry import MODELS
from microslip.periodic.static_limit import lens_corner, limit_on_a_line
from microslip.scene.named import Bore, Transverse
from microslip.scene.problem import Problem
from microslip.theory import hertz, paper


def contact_for(motion, amplitude, model, cells, angles=1, poisson=0.0):
    problem = Problem(motion, 0.0, amplitude, poisson)
    return MODELS[model].build(problem, cells, angles, problem.focus)


def limit_of(contact, motion, amplitude, poisson=0.0, tolerance=1e-10):
    def oscillation(phase):
        return motion.displacement(phase, 0.0, amplitude, poisson)

    return limit_on_a_line(contact, oscillation, tolerance)


def numerical_limit(motion, amplitude, model, cells, angles=1, poisson=0.0):
    contact = contact_for(motion, amplitude, model, cells, angles, poisson)
    return limit_of(contact, motion, amplitude, poisson).force


def test_oscillating_tractions_are_those_of_mindlin_and_lubkin():
    radial = contact_for(Transverse(), 0.5, "radial", 64)
    result = limit_of(radial, Transverse(), 0.5, tolerance=1e-11).oscillating
    total = np.sum(radial.weight * result[1])
    assert result[0] == pytest.approx(0.0, abs=1e-14)
    assert total == pytest.approx(-hertz.mindlin_force(0.5), abs=3e-4)

    polar = contact_for(Bore(), 1.0, "polar", 32, 4)
    forward, lateral = limit_of(polar, Bore(), 1.0).oscillating
    torque = polar.lateral_position * forward - polar.forward_position * lateral
    assert np.sum(polar.weight * torque) == pytest.approx(-hertz.lubkin_torque(0.5), abs=3e-4)


@pytest.mark.slow
def test_residual_is_the_furthest_point_of_the_lens():
    # brute force over a fine grid of candidate tractions
    axis = np.linspace(-1.0, 1.0, 801)
    forward, lateral = np.meshgrid(axis, axis, indexing="ij")
    for place in np.random.default_rng(3).uniform(-0.75, 0.75, (12, 2)):
        residual = lens_corner(place[:, None], np.ones(1))[:, 0]
        allowed = np.ones(forward.shape, bool)
        for ahead, aside in (place, -place):
            allowed &= np.hypot(forward + ahead, lateral + aside) <= 1.0
        expected = forward[allowed].max(initial=0.0)
        if np.hypot(*place) < 1.0:
            assert residual[0] == pytest.approx(expected, abs=6e-3)
        most = max(np.hypot(*(residual + place)), np.hypot(*(residual - place)))
        assert most <= 1.0 + 1e-12 or not residual.any()


@pytest.mark.parametrize("amplitude", [0.1, 0.5, 0.9])
def test_pointwise_form_converges_to_the_closed_form_transverse(amplitude):
    exact = float(paper.static_limit_transverse(amplitude))
    errors = [abs(numerical_limit(Transverse(), amplitude, "radial", n) - exact) for n in (8, 32)]
    order = np.log(errors[0] / errors[1]) / np.log(4.0)
    assert errors[1] < 3e-4
    assert order > 1.3


@pytest.mark.parametrize("amplitude", [0.3, 1.0, 2.0])
@pytest.mark.parametrize("poisson", [0.0, 0.4])
def test_pointwise_form_agrees_with_the_closed_form_bore(amplitude, poisson):
    result = numerical_limit(Bore(), amplitude, "polar", 32, 16, poisson)
    assert result == pytest.approx(float(paper.static_limit_bore(amplitude)), abs=3e-4)
