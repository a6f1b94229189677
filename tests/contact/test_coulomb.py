"""Coulomb's law at points: the projection and the residual."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from microslip.contact.contact import coulomb_residual, project

POINTS = 4
NUMBER = st.floats(-3.0, 3.0, allow_subnormal=False)
VECTORS = arrays(float, (2, 1, POINTS), elements=NUMBER)
BOUNDS = arrays(float, POINTS, elements=st.floats(1e-3, 2.0))


def size(q):
    return np.hypot(q[0], q[1])


@pytest.mark.slow
@settings(deadline=None)
@given(VECTORS, BOUNDS)
def test_projection_is_the_nearest_point_of_the_disc(q, bound):
    nearest = project(q, bound)
    assert np.all(size(nearest) <= bound * (1 + 1e-15))
    inside = size(q) <= bound
    assert np.array_equal(nearest[:, inside], q[:, inside])
    # the disc is on one side of the tangent plane at the nearest point
    for angle in np.linspace(0, 2 * np.pi, 12, endpoint=False):
        other = bound * np.array([np.cos(angle), np.sin(angle)])[:, None, None]
        assert np.all(((q - nearest) * (other - nearest)).sum(axis=0) <= 1e-13)


@pytest.mark.parametrize(
    ("q", "slip", "expected"),
    [
        ((0.5, 0.0), (0.0, 0.0), 0.0),  # sticks
        ((1.0, 0.0), (3.0, 0.0), 0.0),  # slips along the traction on the bound
        ((0.5, 0.0), (0.2, 0.0), 0.2),  # slips below the bound
        ((0.5, 0.0), (4.0, 0.0), 0.5),  # slips far enough to reach the bound
        ((1.0, 0.0), (-0.3, 0.0), 0.3),  # slips backwards
        ((1.0, 0.0), (0.0, 1.0), np.hypot(1 - 0.5**0.5, 0.5**0.5)),  # slips across
        ((2.0, 0.0), (0.0, 0.0), 1.0),  # beyond the bound
    ],
)
def test_residual_counts_every_breach(q, slip, expected):
    """One point, unit bound and scale, area 7."""
    q, slip = np.reshape(q, (2, 1, 1)), np.reshape(slip, (2, 1, 1))
    one = np.ones(1)
    assert coulomb_residual(q, slip, one, 7 * one, one) == pytest.approx(7 * expected, rel=1e-12)
