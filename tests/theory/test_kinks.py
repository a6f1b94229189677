"""Kinks of motions against closed forms and displacements."""

import numpy as np
import pytest

from microslip.scene.by_name import pressure_named
from microslip.scene.hertz import HERTZ
from microslip.theory import masing, oscillating_load
from microslip.theory.exact import kink_velocity, kinks_of

POWER = pressure_named("power:exponent=1")


def along(velocity, amplitude):
    return float(masing.longitudinal(velocity, amplitude, POWER.loading))


def pressed(velocity, amplitude):
    return oscillating_load.friction(velocity, amplitude, False, POWER)


@pytest.mark.parametrize(
    ("motion", "friction"), [("longitudinal", along), ("normal:indentation=1", pressed)]
)
def test_friction_is_full_from_the_velocity_of_the_kink_on(motion, friction):
    for amplitude in (0.2, 0.6, 1.0, 1.7):
        at = float(kink_velocity(kinks_of(motion, POWER.name), np.array(amplitude)))
        assert at == pytest.approx(amplitude)
        assert friction(at, amplitude) == pytest.approx(1.0, abs=1e-9)
        assert friction(0.97 * at, amplitude) < 1.0 - 1e-5


def test_a_load_that_oscillates_takes_nothing_from_a_little_below_its_kink_on():
    """The border is at most 5 % above the kink."""
    for amplitude in (0.1, 0.3, 0.6, 0.9, 1.0):
        at = float(kink_velocity(kinks_of("normal"), np.array(amplitude)))
        full, less = (
            oscillating_load.friction(share * at, amplitude, True, HERTZ) for share in (1.001, 0.95)
        )
        assert full == pytest.approx(1.0, abs=1e-9) and less < 1.0 - 1e-6
