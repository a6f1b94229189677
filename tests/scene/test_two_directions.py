"""Motions along two directions: special cases, other models and limits."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip

COARSE = {"tolerance": 5e-3}


def mean_of_rigid(velocity, forward, lateral, lead):
    """Mean friction of a rigid block: the forward component of the unit velocity, averaged over a
    period."""
    t = np.linspace(0, 2 * np.pi, 20001)[:-1]
    ahead = velocity + forward * np.cos(t + lead)
    return np.mean(ahead / np.hypot(ahead, lateral * np.cos(t)))


@pytest.mark.parametrize("motion", ["elliptic:forward=0", "transverse-bore:angle=0"])
def test_what_oscillates_sideways_alone_is_the_transverse_motion(motion):
    one, other = (microslip.solve(name, 0.1, 0.7) for name in (motion, "transverse"))
    assert (one.mu_macro, one.model) == (other.mu_macro, "radial")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("motion", "velocity", "amplitude", "settings"),
    [
        ("elliptic:forward=0.5,phase=30", 0.1, 0.5, {}),
        ("elliptic:forward_cycles=2", 0.1, 0.5, {}),
        ("transverse-bore", 0.1, 0.8, COARSE),
        ("transverse-bore:angle=0.4,phase=50", 0.3, 2.0, COARSE | {"poisson": 0.5}),
        ("transverse-bore:phase=90", 0.2, 0.5, COARSE | {"pressure": "power:exponent=1"}),
        *(("transverse", 0.1, 0.6, {"pressure": name}) for name in ("punch", "ring")),
    ],
)
def test_rings_and_squares_agree(motion, velocity, amplitude, settings):
    """Rings alone, or with angular points of the whole disc."""
    place = motion, velocity, amplitude
    rings = microslip.solve(*place, **settings)
    assert rings.model in ("radial", "polar")
    assert_agree(rings, microslip.solve(*place, **settings | COARSE, model="cartesian"))


@pytest.mark.parametrize(("forward", "phase"), [(1.0, 90), (0.5, 45), (1.0, 0)])
def test_a_large_ellipse_is_that_of_a_rigid_block(forward, phase):
    motion = f"elliptic:forward={forward},phase={phase}"
    exact = mean_of_rigid(0.3, forward, 1.0, np.deg2rad(phase))
    answer = microslip.solve(motion, 0.3 * 200, 200.0)
    assert answer.mu_macro == pytest.approx(exact, abs=0.01)
    rigid = microslip.solve(motion, 0.3 * 200, 200.0, model="rigid")
    assert rigid.mu_macro == pytest.approx(exact, abs=1e-3)


def test_an_ellipse_without_a_lateral_part_is_the_longitudinal_motion():
    """Its phase lead only shifts the time, so the same closed form applies."""
    line = microslip.solve("elliptic:forward=0.5,lateral=0,phase=40", 0.1, 1.0)
    exact = microslip.solve("longitudinal", 0.1, 0.5)
    assert line.model == exact.model
    assert line.mu_macro == pytest.approx(exact.mu_macro, abs=1e-9)


def test_a_rigid_contact_that_knows_half_of_itself_says_so():
    with pytest.raises(ValueError, match="symmetry between the two halves of the contact"):
        microslip.solve("transverse-bore", 0.1, 0.5, model="rigid")
