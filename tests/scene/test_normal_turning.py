"""Oscillating normal load with a rotation or at nu > 0: modes against rings, and limits."""

import numpy as np
import pytest

import microslip
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.hertz import HERTZ
from microslip.scene.problem import Problem
from microslip.theory import hertz, paper

TURNING = "normal:angle=1"


def run(motion, velocity, amplitude, model="polar", poisson=0.0, resolution=(24, 8, 96)):
    problem = Problem(motion_named(motion), velocity, amplitude, poisson)
    return simulate(problem, model, Resolution(*resolution), 1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("motion", ["normal", "normal:lateral=1", "normal:forward=1,phase=60"])
def test_modes_find_what_rings_find(motion):
    """At nu = 0, both models are equal at the same resolution, up to the tolerance of the steps."""
    for amplitude in (0.6, 1.3):
        rings, modes = (run(motion, 0.1, amplitude, model) for model in ("radial", "polar"))
        assert rings.converged and modes.converged
        assert modes.mu == pytest.approx(rings.mu, abs=2e-6)


@pytest.mark.slow
@pytest.mark.parametrize("velocity", [0.5, 5.0, 40.0])
def test_where_all_slides_every_moment_is_a_steady_bore(velocity):
    """The mean is Eq 21 at the current contact radius and rotation rate, weighted with the load."""
    amplitude, share = 60.0, 0.5 / 60.0
    result = microslip.solve(
        f"normal:load={share!r},angle=1,phase=90", velocity, amplitude, tolerance=5e-3
    )
    phase = (np.arange(4000) + 0.5) * np.pi / 2000.0
    load = 1.0 + 0.5 * np.sin(phase)
    rate = np.abs(float(hertz.bore_angle(amplitude)) * np.sin(phase))
    radius = HERTZ.radius(HERTZ.of_load(load))
    steady = paper.bore_forward(velocity / (rate * radius))
    assert result.converged
    # the force follows with a delay of about u_lim, which is a small part of this path
    assert result.mu_macro == pytest.approx(np.mean(load * steady), abs=0.015)


@pytest.mark.long
def test_slow_marches_end_in_the_limit():
    """Limit and marches use the same contact and steps, so that a coarse resolution is
    sufficient."""
    still = Problem(motion_named(TURNING), 0.0, 0.5, 0.0)
    limit = simulate(still, "polar", Resolution(16, 4, 64), 1e-5)
    above = [run(TURNING, v, 0.5, resolution=(16, 4, 64)).mu - limit.mu for v in (2e-2, 2.5e-3)]
    assert limit.converged and 0.0 < above[1] < 0.36 * above[0]


def test_squares_do_not_know_such_a_load():
    with pytest.raises(ValueError, match="pressure = 'ellipse.*: only cartesian .* load"):
        microslip.solve("normal:angle=1,lateral=1", 0.1, 0.5, pressure="ellipse:ratio=0.5")
    with pytest.raises(ValueError, match="angle = 2: allowed is a share in 0..1"):
        microslip.solve("normal:angle=2", 0.1, 0.5)
