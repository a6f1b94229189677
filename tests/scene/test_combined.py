"""The transverse-bore motion: special cases, symmetry and static limit."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem


def test_without_a_rotation_it_is_the_transverse_motion():
    one = microslip.solve("transverse", 0.1, 0.6)
    other = microslip.solve("transverse-bore:angle=0", 0.1, 0.6)
    assert other.model == "radial"
    assert_agree(one, other)


def test_the_motion_is_its_own_mirror_image_half_a_period_later():
    motion = Problem(motion_named("transverse-bore:phase=40"), 0.3, 0.7, 0.2)
    phase = np.linspace(-3.0, 3.0, 41)
    now, later = motion.displacement(phase), motion.displacement(phase + np.pi)
    for one, other, sign, way in zip(now, later, (1, -1, -1), (0.3 * np.pi, 0, 0), strict=True):
        assert other == pytest.approx(sign * one + way, abs=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "velocity", "amplitude", "settings"),
    [
        ("transverse-bore", 0.1, 0.8, {}),
        pytest.param(
            *("transverse-bore:phase=90", 0.03, 0.5, {"poisson": 0.3}), marks=pytest.mark.long
        ),
        ("transverse-bore:angle=0.4,phase=50", 0.3, 2.0, {"poisson": 0.5}),
        ("transverse-bore:phase=90", 0.2, 0.5, {"pressure": "power:exponent=1"}),
    ],
)
def test_angular_points_of_the_whole_disc_agree_with_squares(name, velocity, amplitude, settings):
    both = (
        microslip.solve(name, velocity, amplitude, model=model, tolerance=5e-3, **settings)
        for model in ("polar", "cartesian")
    )
    assert_agree(*both)


def test_a_rigid_contact_that_knows_half_of_itself_says_so():
    with pytest.raises(
        ValueError, match="it needs a symmetry between the two halves of the contact"
    ):
        microslip.solve("transverse-bore", 0.1, 0.5, model="rigid")
