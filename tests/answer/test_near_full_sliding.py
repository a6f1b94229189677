"""Points close to full sliding, where coarse levels can agree by chance."""

import pytest
from stubs.agreement import assert_agree

import microslip

POINTS = [(0.1, 1.0), (0.11, 1.05), (0.11, 1.15), (0.12, 1.1), (0.12, 1.15), (0.13, 1.3)]


@pytest.mark.parametrize(("velocity", "amplitude"), POINTS)
def test_the_error_estimate_covers_a_twenty_times_tighter_one(velocity, amplitude):
    place = "transverse", velocity, amplitude
    assert_agree(microslip.solve(*place), microslip.solve(*place, tolerance=5e-5))


@pytest.mark.slow
def test_the_error_estimate_covers_a_rotation_with_a_lateral_motion():
    place = "transverse-bore", 0.1, 1.0
    assert_agree(microslip.solve(*place), microslip.solve(*place, tolerance=4e-4))
