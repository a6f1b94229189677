"""Points close to full sliding, where coarse levels can agree by chance."""

import pytest

import microslip

POINTS = [(0.1, 1.0), (0.11, 1.05), (0.11, 1.15), (0.12, 1.1), (0.12, 1.15), (0.13, 1.3)]


def covered(motion, velocity, amplitude, tolerance):
    """Whether the default estimate covers the answer at a tighter tolerance."""
    loose = microslip.solve(motion, velocity, amplitude)
    tight = microslip.solve(motion, velocity, amplitude, tolerance=tolerance)
    assert loose.converged and tight.converged
    apart = abs(loose.mu_macro - tight.mu_macro)
    return apart <= loose.mu_macro_error + tight.mu_macro_error


@pytest.mark.parametrize(("velocity", "amplitude"), POINTS)
def test_the_error_estimate_covers_a_twenty_times_tighter_one(velocity, amplitude):
    assert covered("transverse", velocity, amplitude, 5e-5)


@pytest.mark.slow
def test_the_error_estimate_covers_a_rotation_with_a_lateral_motion():
    assert covered("transverse-bore", 0.1, 1.0, 4e-4)
