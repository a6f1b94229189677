"""Motions from samples of a period: those that have a name get the answers of the named ones."""

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.foundation.errors import InputError
from microslip.theory import hertz

PHASE = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
SINE = np.sin(PHASE)


def sampled(**columns):
    return microslip.Sampled.of_columns(columns)


WAVE = {"lateral": SINE}
PRESSED = {"load": 1.0 + SINE}
TONES = {"forward": 0.5 * np.sin(2.0 * PHASE + np.pi / 2.0), "lateral": SINE}
CASES = [
    ("transverse", WAVE, 0.1, 30.0, {}),
    ("transverse", WAVE, 0.003, 0.6, {}),
    ("transverse", WAVE, 0.0, 0.5, {}),
    ("transverse", WAVE, 0.1, 1.0, {"poisson": 0.4}),
    ("longitudinal", {"forward": SINE}, 0.2, 1.5, {}),
    ("longitudinal", {"forward": SINE}, 0.1, 1.0, {"stiffness": 1.0}),
    ("elliptic:forward=0.5,forward_cycles=2", TONES, 0.1, 1.0, {}),
    ("normal", PRESSED, 0.2, 0.7, {}),
    ("normal:indentation=1", {"indentation": 1.0 + SINE}, 0.2, 0.7, {}),
    ("normal:lateral=1,phase=90", PRESSED | {"lateral": np.cos(PHASE)}, 0.2, 0.7, {}),
]


@pytest.mark.parametrize(("name", "columns", "velocity", "amplitude", "settings"), CASES)
def test_a_sampled_sine_gets_the_answer_of_the_named_motion(
    name, columns, velocity, amplitude, settings
):
    place = {"velocity": velocity, "amplitude": amplitude} | settings
    named = microslip.solve(name, **place)
    assert_agree(named, microslip.solve(sampled(**columns), **place))


def test_a_sampled_rotation_gets_the_answer_of_the_bore():
    # the velocity of a bore is over omega and the angle, that of a sampled motion over omega u_lim
    problem = microslip.Problem(microslip.Bore(), velocity=0.3, amplitude=2.0)
    motion = sampled(angle=float(hertz.bore_angle(2.0)) * SINE)
    other = microslip.solve(motion, velocity=problem.drift, amplitude=1.0)
    assert_agree(microslip.solve(problem), other)


def test_few_samples_of_a_sharp_motion_have_a_larger_error():
    """The interpolation between samples is a source of the error of its own."""
    zigzag = 2.0 / np.pi * np.arcsin(np.sin(PHASE))
    exact = microslip.solve("zigzag", velocity=0.1, amplitude=1.0)
    motion = sampled(lateral=zigzag[::8])
    coarse = microslip.solve(motion, velocity=0.1, amplitude=1.0, tolerance=0.05)
    assert coarse.answer.by_source["model"] > 0.0
    assert_agree(coarse, exact)


def test_symmetries_of_samples():
    assert sampled(lateral=SINE).half_period_mirror
    assert not sampled(lateral=SINE + 0.2 * np.sin(2 * PHASE)).half_period_mirror
    assert not sampled(forward=SINE).propels
    assert sampled(forward=SINE + 0.3 * np.sin(2 * PHASE + 0.5)).propels
    assert sampled(lateral=SINE, angle=SINE).half_disc is False


def test_equal_samples_are_one_motion():
    assert sampled(lateral=SINE) == sampled(lateral=SINE.copy())
    assert sampled(lateral=SINE) != sampled(forward=SINE)
    assert sampled(load=1.0 + SINE) != sampled(indentation=1.0 + SINE)


@pytest.mark.parametrize(
    ("columns", "argument"),
    [
        ({"lateral": [0.0, 1.0, 0.0]}, "lateral"),
        ({"lateral": SINE, "forward": SINE[1:]}, "forward"),
        ({"lateral": SINE, "load": SINE}, "load"),
        ({"load": 1.0 + SINE, "indentation": 1.0 + SINE}, "indentation"),
        ({}, "forward"),
        ({"foo": SINE}, "columns"),
        ({"lateral": 0.0 * SINE}, "lateral"),
    ],
)
def test_bad_samples_are_refused_by_name(columns, argument):
    with pytest.raises(InputError, match=f"^{argument} = "):
        sampled(**columns)
