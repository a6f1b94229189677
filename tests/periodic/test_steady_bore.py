"""Steady sliding with steady rotation: Eqs 15, 21 and 22 from every initial state (claims 3, 4)."""

import numpy as np
import pytest

import microslip
from microslip.answer.along import STARTS
from microslip.theory import hertz, paper

VELOCITIES = np.geomspace(0.1, 10.0, 7)


@pytest.mark.parametrize("nu", [0.0, 0.3])
@pytest.mark.parametrize("velocity", VELOCITIES)
def test_every_initial_state_ends_in_eqs_21_and_22(velocity, nu):
    ends = []
    for start in STARTS:
        history = microslip.history(
            "continuous-bore",
            velocity,
            start=start,
            poisson=nu,
            cells=16,
            steps=160,
            travel=max(10.0, 4 * velocity),
        )
        forward, torque = history.force_forward, history.torque
        begin = {"stress-free": (0, 0), "full-slip": (1, 0), "full-rotation": (0, 1)}[start]
        assert (forward[0], torque[0]) == pytest.approx(begin, abs=1e-12)
        assert history.displacement_forward[-1] == pytest.approx(max(10.0, 4 * velocity))
        assert forward[-1] == pytest.approx(paper.bore_forward(velocity), abs=2e-3)
        assert torque[-1] == pytest.approx(paper.bore_torque(velocity), abs=2e-3)
        ends.append((forward[-1], torque[-1]))
    assert np.ptp(ends, axis=0) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("model", ["rigid", "cartesian"])
@pytest.mark.parametrize("velocity", [0.2, 0.8, 3.0])
def test_other_models_agree_with_eqs_21_and_22(velocity, model):
    result = microslip.solve("continuous-bore", velocity, model=model, tolerance=2e-3)
    assert result.converged and result.model == model
    assert result.mu_macro == pytest.approx(paper.bore_forward(velocity), abs=2e-3)
    assert result.mu_torque == pytest.approx(paper.bore_torque(velocity), abs=4e-3)


@pytest.mark.parametrize("velocity", [0.2, 0.5, 0.8, 1.5])
def test_steady_field_is_eq_15_and_nothing_sticks(velocity):
    """Up to v = 1 the instantaneous centre, where the slip vanishes, is inside the contact."""
    field = microslip.traction_field("continuous-bore", velocity, cells=16)
    assert field["centre_lateral"] == paper.rotation_centre(velocity)[0]
    lateral, forward = field["lateral_position"], field["forward_position"]
    result = np.stack([field["traction_lateral"], field["traction_forward"]])
    assert np.hypot(*result) == pytest.approx(field["bound"], rel=1e-12)
    expected = paper.steady_bore_traction(lateral, forward, velocity)
    direction = expected / hertz.friction_bound(np.hypot(lateral, forward))
    # close to the centre of rotation the directions converge last
    away = np.hypot(lateral + velocity, forward) > 0.1
    assert away.sum() > 0.9 * away.size
    assert (result / field["bound"])[:, away] == pytest.approx(direction[:, away], abs=2e-3)
