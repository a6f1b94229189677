"""Residual of Coulomb's law at a point."""

import numpy as np
import pytest

from microslip.contact.contact import coulomb_residual


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
