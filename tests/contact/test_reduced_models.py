"""The reduced models against the results that they reproduce exactly or approximately."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

import microslip
from microslip.scene.hertz import HERTZ
from microslip.theory import paper


@pytest.mark.parametrize("amplitude", [0.25, 0.5, 0.75])
def test_static_limit_of_springs_in_a_row(amplitude):
    """The forward force of each spring is sqrt(bound^2 - (G* y)^2)."""
    result = microslip.solve("transverse", 0.0, amplitude, model="mdr")
    stick = np.sqrt(1.0 - amplitude)
    expected = quad(lambda x: 1.5 * np.sqrt((1 - x * x) ** 2 - amplitude**2), 0.0, stick)[0]
    assert result.converged
    assert abs(result.mu_macro - expected) <= result.mu_macro_error + 1e-9
    assert abs(expected - paper.static_limit_transverse(amplitude)) > 5e-3  # another limit


@pytest.mark.slow
@pytest.mark.parametrize(("velocity", "amplitude"), [(0.05, 0.5), (0.5, 2.0), (2.0, 1.0)])
def test_a_bristle_solves_its_differential_equation(velocity, amplitude):
    result = microslip.solve("transverse", velocity, amplitude, model="dahl", tolerance=1e-4)

    def rate(phase, force):
        motion = np.array([velocity, amplitude * np.cos(phase)])
        return HERTZ.stiffness * (motion - np.hypot(*motion) * force)

    periods = 4 + int(2.0 / min(velocity, 1.0))
    times = np.linspace(0.0, 2 * np.pi, 4001) + 2 * np.pi * periods
    solved = solve_ivp(rate, (0.0, times[-1]), [1.0, 0.0], t_eval=times, rtol=1e-9, atol=1e-11)
    expected = np.trapezoid(solved.y[0], times) / (2 * np.pi)
    assert result.converged and abs(result.mu_macro - expected) <= result.mu_macro_error
