"""Motions: symmetry of the displacement, and refusals of numbers."""

import math
from dataclasses import fields

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError
from microslip.scene.by_name import MOTIONS
from microslip.scene.motion import Motion, Wave
from microslip.scene.named import Elliptic, Transverse
from microslip.scene.problem import Force, Problem, Spring

PERIODIC = [one() for one in MOTIONS.values() if one.periodic and not fields(one)]
MIRRORED = [motion for motion in PERIODIC if motion.half_period_mirror]
PHASE = np.linspace(-3.0, 3.0, 101)


@pytest.mark.parametrize("name", MIRRORED, ids=lambda name: name.name)
def test_half_a_period_later_a_motion_is_its_own_mirror_image(name):
    """The search for the periodic state relies on this symmetry, up to the drift."""
    motion = Problem(name, 0.3, 0.7, 0.2)
    now, later = motion.displacement(PHASE), motion.displacement(PHASE + np.pi)
    displacement = np.pi * motion.drift
    for one, other, sign, way in zip(
        now, later, (1, -1, -1), (displacement, 0.0, 0.0), strict=True
    ):
        assert other == pytest.approx(sign * one + way, abs=1e-12)


@pytest.mark.parametrize("motion", PERIODIC, ids=lambda motion: motion.name)
def test_a_drift_slower_than_the_rounding_of_the_oscillation_is_told_exactly(motion):
    drift = motion.drift(1.0, 0.7, 0.2)
    assert motion.drift(1e-99, 0.7, 0.2) == pytest.approx(1e-99 * drift, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("motion", PERIODIC, ids=lambda motion: motion.name)
def test_the_oscillation_turns_at_both_ends_of_half_a_period(motion):
    ends = np.array([-0.5, 0.5]) * np.pi
    both = (motion.displacement(at, 0.0, 0.7, 0.0) for at in (PHASE, ends))
    for part, end in zip(*both, strict=True):
        assert np.abs(part).max() <= abs(end[1]) + 1e-12


@pytest.mark.parametrize(
    ("drive", "numbers", "argument"),
    [
        (Force, {"force": math.nan}, "force"),
        (Force, {"force": 0.5, "mass": -1.0}, "mass"),
        (Spring, {"stiffness": -1.0}, "stiffness"),
    ],
)
def test_a_drive_refuses_impossible_numbers(drive, numbers, argument):
    with pytest.raises(microslip.InputError) as caught:
        drive(**numbers)
    assert caught.value.argument == argument


@pytest.mark.parametrize("value", [math.nan, math.inf, "1", None])
def test_numbers_of_a_motion_have_to_be_finite(value):
    with pytest.raises(InputError, match="phase"):
        Elliptic(phase=value)


def test_what_follows_a_prescribed_contact_refuses_a_drive():
    problem = Problem(Transverse(), 0.1, 1.0, drive=Spring(1.0))
    for question in (microslip.history, microslip.period):
        with pytest.raises(InputError) as raised:
            question(problem)
        assert raised.value.argument == "drive"


class OwnWave(Motion):
    waves = {"lateral": Wave(form=lambda phase: phase)}  # not periodic


class OwnDisplacement(Motion):
    def displacement(self, phase, velocity, amplitude, poisson):
        return velocity * phase, amplitude * phase, 0.0 * phase


@pytest.mark.parametrize("motion", [OwnWave, OwnDisplacement])
def test_an_own_motion_that_does_not_repeat_is_refused(motion):
    with pytest.raises(InputError) as caught:
        motion()
    assert caught.value.argument == "motion"
