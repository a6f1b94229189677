"""Strokes far longer than u_lim: the contact slides, except over about u_lim after each turn."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem

PLACES = [(115.0, 50000.0), (23.0, 10000.0), (0.5, 1000.0), (300.0, 3000.0)]


@pytest.mark.parametrize("tolerance", [1e-3, 1e-4, pytest.param(1e-5, marks=pytest.mark.long)])
@pytest.mark.parametrize(("velocity", "amplitude"), PLACES)
def test_a_zigzag_is_that_of_a_rigid_contact(velocity, amplitude, tolerance):
    """The direction is constant between turns.  An elastic contact lags by u_lim at each turn,
    which raises the friction by at most u_lim over the stroke."""
    problem = Problem(motion_named("zigzag"), velocity, amplitude)
    rigid = 1.0 / np.hypot(1.0, 2.0 / np.pi * problem.stroke / problem.drift)
    result = microslip.solve("zigzag", velocity, amplitude, tolerance=tolerance)
    assert result.converged
    assert (
        -result.mu_macro_error <= result.mu_macro - rigid <= 1.0 / amplitude + result.mu_macro_error
    )


@pytest.mark.parametrize(("velocity", "amplitude"), PLACES)
def test_tolerances_agree(velocity, amplitude):
    rough, finer, finest = (
        microslip.solve("transverse", velocity, amplitude, tolerance=t) for t in (1e-3, 1e-4, 1e-5)
    )
    assert_agree(rough, finest)
    assert_agree(finer, finest)
