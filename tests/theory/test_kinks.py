"""Kinks of motions against closed forms and displacements."""

import numpy as np
import pytest

from microslip.scene.by_name import pressure_named
from microslip.scene.hertz import HERTZ
from microslip.theory import masing, oscillating_load
from microslip.theory.exact import kink_velocity, kinks_of

AMPLITUDES = (0.2, 0.6, 1.0, 1.7)
PULLED_BACK = 0.97
"""Velocity over that of a kink, at which friction is not full."""


def load_oscillates(velocity, amplitude):
    return oscillating_load.friction(velocity, amplitude, True, HERTZ)


def indentation_oscillates(velocity, amplitude):
    pressure = pressure_named("power:exponent=1")
    return oscillating_load.friction(velocity, amplitude, False, pressure)


def along(velocity, amplitude):
    curve = pressure_named("power:exponent=1").loading
    return float(masing.longitudinal(velocity, amplitude, curve))


@pytest.mark.parametrize(
    ("motion", "pressure", "friction"),
    [
        ("longitudinal", "power:exponent=1", along),
        ("normal:indentation=1", "power:exponent=1", indentation_oscillates),
    ],
)
def test_friction_is_full_from_the_velocity_of_the_kink_on(motion, pressure, friction):
    for amplitude in AMPLITUDES:
        at = float(kink_velocity(kinks_of(motion, pressure), np.array(amplitude)))
        assert at == pytest.approx(amplitude)
        assert friction(at, amplitude) == pytest.approx(1.0, abs=1e-9)
        assert friction(PULLED_BACK * at, amplitude) < 1.0 - 1e-5


def test_a_load_that_oscillates_takes_nothing_from_a_little_below_its_kink_on():
    """The border is at most 5 % above the kink."""
    for amplitude in (0.1, 0.3, 0.6, 0.9, 1.0):
        at = float(kink_velocity(kinks_of("normal"), np.array(amplitude)))
        assert load_oscillates(1.001 * at, amplitude) == pytest.approx(1.0, abs=1e-9)
        assert load_oscillates(0.95 * at, amplitude) < 1.0 - 1e-6
