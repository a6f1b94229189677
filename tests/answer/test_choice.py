"""Choice of the model and of closed forms in place of runs."""

import math

import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.answer.limits import choose_model
from microslip.contact.registry import MODELS
from microslip.scene.named import Bore, ContinuousBore, Transverse
from microslip.scene.problem import Problem


def problem_of(motion, poisson):
    return Problem(motion, 1.0, 1.0 if motion.periodic else None, poisson)


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
    problem = problem_of(motion, poisson)
    assert choose_model(problem) == expected
    assert MODELS[expected].exact(problem) and not MODELS[expected].refuses(problem)


def test_what_is_imposed_is_no_closed_form():
    imposed = microslip.solve("continuous-bore", 0.5, cells=8)
    assert imposed.model == "polar" and imposed.cells == 8


def fast(motion, amplitude, tolerance):
    """Velocity at which half the width of the bracket of theory/exact.py is the tolerance."""
    if motion == Transverse():
        return amplitude * math.sqrt(0.5 / tolerance - 0.5)
    return 1.0 + math.sqrt(0.1 / tolerance)


@pytest.mark.parametrize(
    ("motion", "amplitude", "poisson"),
    [(Transverse(), 4.0, 0.0), (Transverse(), 1.0, 0.3), (Bore(), 0.5, 0.3)],
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
    place = (motion.name, 0.99 * velocity, amplitude)
    before = microslip.solve(*place, poisson=poisson, tolerance=tolerance)
    assert before.model == choose_model(problem_of(motion, poisson))
