"""Extrapolation of manufactured sequences with known limits."""

import math

import numpy as np
import pytest

from microslip.answer.refine import SAFETY, extrapolate

EXACT = 0.4


def sequence(power, coefficient=0.3, first=4):
    return [EXACT + coefficient * n**-power for n in (first, 2 * first, 4 * first)]


@pytest.mark.parametrize("coefficient", [-3.0, 0.1, 5.0])
def test_an_error_of_second_order_is_removed(coefficient):
    limit = extrapolate(sequence(2.0, coefficient))
    assert limit.value == pytest.approx(EXACT, abs=1e-14)
    assert limit.order == pytest.approx(2.0)
    assert limit.error == pytest.approx(SAFETY * abs(coefficient) / 16**2)


@pytest.mark.parametrize("power", [0.7, 0.8, 0.99, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 8.0])
def test_errors_of_other_orders_are_covered(power):
    limit = extrapolate(sequence(power))
    assert abs(limit.value - EXACT) <= limit.error
    assert limit.order == pytest.approx(power)


@pytest.mark.parametrize("power", [0.9, 1.0, 1.06, 1.2])
def test_slow_convergence_is_covered_with_the_safety_factor(power):
    limit = extrapolate(sequence(power))
    assert SAFETY * abs(limit.value - EXACT) == pytest.approx(limit.error)


def test_levels_that_swing_are_no_better_than_the_level_before():
    """Second order would leave a third of the first difference."""
    limit = extrapolate([EXACT - 0.3, EXACT, EXACT - 0.01])
    assert limit.error == pytest.approx(SAFETY * 0.3 / 3.0)


@pytest.mark.parametrize("last", [0.0, 1e-9, -1e-9])
def test_two_levels_that_agree_by_chance_are_no_better_than_the_level_before(last):
    limit = extrapolate([EXACT + 0.16, EXACT + 0.03, EXACT + 0.03 - last])
    assert limit.error == pytest.approx(SAFETY * 0.13 / 3.0)
    assert abs(limit.value - EXACT) <= limit.error


def test_the_error_does_not_jump_where_the_observed_order_grows():
    """Halves of a difference from order 1 to order 20, in small steps."""
    differences = 2.0 ** -np.linspace(1.0, 20.0, 2000)
    values = np.array([np.full(2000, EXACT + 1.0), np.full(2000, EXACT), EXACT - differences])
    error = extrapolate(values).error
    assert np.abs(np.diff(error)).max() < 0.05 * error.max()


def test_nothing_is_left_where_all_levels_agree():
    limit = extrapolate([EXACT] * 3)
    assert limit.value == EXACT and limit.error == 0.0 and math.isnan(limit.order)
