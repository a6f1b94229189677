"""Choice of the model and of closed forms in place of runs."""

import math

import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.answer.limits import choose_model
from microslip.contact.registry import MODELS
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.named import Bore, ContinuousBore, Transverse
from microslip.scene.problem import Problem
from microslip.theory import paper


def problem_of(motion, poisson):
    return Problem(motion, 1.0, 1.0 if motion.periodic else None, poisson)


# The model


@pytest.mark.parametrize(
    ("motion", "poisson", "expected"),
    [
        (Transverse(), 0.0, "radial"),
        (Transverse(), 1e-12, "polar"),
        (Transverse(), 0.5, "polar"),
        *((motion, nu, "polar") for motion in (Bore(), ContinuousBore()) for nu in (0.0, 0.3, 0.5)),
    ],
)
def test_cheapest_exact_model_is_chosen(motion, poisson, expected):
    chosen = choose_model(problem_of(motion, poisson))
    assert chosen == expected
    problem = problem_of(motion, poisson)
    assert MODELS[chosen].exact(problem) and not MODELS[chosen].refuses(problem)


# Closed forms


@pytest.mark.parametrize(
    ("motion", "amplitude", "poisson"),
    [("transverse", 0.3, 0.0), ("transverse", 0.8, 0.0), ("bore", 0.7, 0.0), ("bore", 2.0, 0.4)],
)
def test_vanishing_velocity_needs_no_run(motion, amplitude, poisson):
    result = microslip.solve(motion, 0.0, amplitude, poisson=poisson)
    assert result.model == "closed-form" and result.cells == 0
    model = "polar" if motion == "bore" else "radial"
    problem = Problem(motion_named(motion), 0.0, amplitude, poisson)
    coarse, fine = (
        simulate(problem, model, Resolution(cells, 24, 0), 1e-8).mu for cells in (24, 48)
    )
    expected = fine + (fine - coarse) / 3.0
    assert result.mu_macro == pytest.approx(expected, abs=max(1e-5, abs(fine - coarse)))


@pytest.mark.parametrize("velocity", [0.05, 0.5, 1.0, 3.0])
def test_the_steady_bore_is_eqs_21_and_22_which_the_resolved_contact_confirms(velocity):
    exact = microslip.solve("continuous-bore", velocity, poisson=0.3)
    assert exact.model == "closed-form" and exact.mu_macro_error < 1e-9
    assert exact.mu_macro == paper.bore_forward(velocity)
    resolved = microslip.solve("continuous-bore", velocity, poisson=0.3, model="polar")
    assert abs(exact.mu_macro - resolved.mu_macro) <= resolved.mu_macro_error
    assert abs(exact.mu_torque - resolved.mu_torque) <= resolved.torque.error
    imposed = microslip.solve("continuous-bore", velocity, cells=8)
    assert imposed.model == "polar" and imposed.cells == 8


def fast(motion, amplitude, tolerance):
    """Velocity at which half the width of the bracket of theory/exact.py is the tolerance."""
    if motion == Transverse():
        return amplitude * math.sqrt(0.5 / tolerance - 0.5)
    return 1.0 + math.sqrt(0.1 / tolerance)


@pytest.mark.parametrize(
    ("motion", "amplitude", "poisson"),
    [
        (Transverse(), 0.2, 0.0),
        (Transverse(), 4.0, 0.0),
        (Transverse(), 1.0, 0.3),
        (Bore(), 0.5, 0.3),
    ],
)
@pytest.mark.parametrize("tolerance", [5e-2, 2e-3])
def test_fast_sliding_is_covered(motion, amplitude, poisson, tolerance):
    velocity = fast(motion, amplitude, tolerance)
    for factor in (1.01, 4.0):
        arguments = (motion.name, factor * velocity, amplitude)
        result = microslip.solve(*arguments, poisson=poisson, tolerance=tolerance)
        assert result.model == "closed-form" and result.converged
        assert result.mu_macro_error <= tolerance
        model = choose_model(problem_of(motion, poisson))
        run = microslip.solve(*arguments, poisson=poisson, model=model, tolerance=1e-4)
        assert run.model == model and run.converged
        assert_agree(run, result)
    before = microslip.solve(
        motion.name, 0.99 * velocity, amplitude, poisson=poisson, tolerance=tolerance
    )
    assert before.model == choose_model(problem_of(motion, poisson))


# Resolutions
