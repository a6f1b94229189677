"""Extrapolation of manufactured sequences with known limits."""

import math

import pytest

from microslip.estimate.richardson import SAFETY, extrapolate

EXACT = 0.4


def sequence(power, coefficient=0.3, first=4):
    return [EXACT + coefficient * n**-power for n in (first, 2 * first, 4 * first)]


@pytest.mark.parametrize("coefficient", [-3.0, 0.1, 5.0])
def test_an_error_of_second_order_is_removed(coefficient):
    limit = extrapolate(sequence(2.0, coefficient))
    assert limit.value == pytest.approx(EXACT, abs=1e-14)
    assert limit.order == pytest.approx(2.0)
    assert limit.difference == pytest.approx(3.0 * abs(coefficient) / 16**2)
    assert limit.error == pytest.approx(SAFETY * abs(coefficient) / 16**2)


@pytest.mark.parametrize("power", [0.7, 0.8, 0.99, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 8.0])
def test_errors_of_other_orders_are_covered(power):
    limit = extrapolate(sequence(power))
    assert abs(limit.value - EXACT) <= limit.error
    assert limit.order == pytest.approx(power)


def test_first_order_is_underestimated_by_two_over_the_safety_factor():
    limit = extrapolate(sequence(1.0 + 1e-9))
    assert abs(limit.value - EXACT) / limit.error == pytest.approx(2.0 / SAFETY)


def test_levels_that_swing_are_not_divided_by_three():
    limit = extrapolate([EXACT + 0.01, EXACT - 0.04, EXACT])
    assert limit.order < 1.0 and limit.error == pytest.approx(SAFETY * 0.04)


def test_two_levels_that_agree_by_chance_are_judged_by_the_third():
    values = [EXACT + 0.16, EXACT + 0.03, EXACT + 0.03]
    limit = extrapolate(values)
    assert limit.order == math.inf and limit.value == values[-1]
    # at second order the last difference is a quarter of the one before
    assert limit.error == pytest.approx(SAFETY * 0.13 / 4.0 / 3.0)
    assert abs(limit.value - EXACT) <= 2.0 * limit.error


def test_nothing_is_left_where_all_levels_agree():
    limit = extrapolate([EXACT] * 3)
    assert limit.value == EXACT and limit.error == 0.0 and math.isnan(limit.order)
