"""Velocities under a force against the balance of force and friction at every instant."""

import numpy as np
import pytest

from microslip.foundation.errors import InputError
from microslip.theory.paper import bore_drift, bore_forward, transverse_drift

PHASES = (np.arange(2000) + 0.5) * np.pi / 2000


@pytest.mark.parametrize("force", [0.01, 0.3, 0.6, 0.95])
def test_friction_of_a_rigid_contact_balances_the_force_under_transverse_oscillation(force):
    """The velocity is proportional to that of the vibration, with the mean of the closed form."""
    amplitude = 3.0
    vibration = amplitude * np.abs(np.cos(PHASES))
    velocity = transverse_drift(force, amplitude) * vibration / vibration.mean()
    assert velocity / np.hypot(velocity, vibration) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("force", [0.01, 0.3, 0.6, 0.95])
def test_friction_of_a_rigid_contact_balances_the_force_under_bore(force):
    rotation = np.abs(np.cos(PHASES))  # over its maximum
    velocity = bore_drift(force, 1.0) * rotation / rotation.mean()
    assert bore_forward(velocity / rotation) == pytest.approx(force, rel=1e-6)


@pytest.mark.parametrize("drift", [transverse_drift, bore_drift])
def test_ends(drift):
    assert drift(0.0, 1.0) == 0.0
    assert np.isinf(drift(1.0, 1.0)) and np.isinf(drift(1.5, 1.0))
    with pytest.raises(ValueError, match="force = -0.1"):
        drift(-0.1, 1.0)
    with pytest.raises(InputError, match="force = 0.99999999999999: allowed are forces up to"):
        bore_drift(1.0 - 1e-14, 1.0)  # rounding does not tell it from full friction
