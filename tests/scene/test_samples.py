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


CASES = {
    "transverse": ("transverse", {"lateral": SINE}, 0.1, 1.0, {}),
    "long stroke": ("transverse", {"lateral": SINE}, 0.1, 30.0, {}),
    "slow": ("transverse", {"lateral": SINE}, 0.003, 0.6, {}),
    "static limit": ("transverse", {"lateral": SINE}, 0.0, 0.5, {}),
    "longitudinal": ("longitudinal", {"forward": SINE}, 0.2, 1.5, {}),
    "spring": ("longitudinal", {"forward": SINE}, 0.1, 1.0, {"stiffness": 1.0}),
    "nu": ("transverse", {"lateral": SINE}, 0.1, 1.0, {"poisson": 0.4}),
    "two tones": (
        "elliptic:forward=0.5,forward_cycles=2",
        {"forward": 0.5 * np.sin(2.0 * PHASE + np.pi / 2.0), "lateral": SINE},
        0.1,
        1.0,
        {},
    ),
    "load": ("normal", {"load": 1.0 + SINE}, 0.2, 0.7, {}),
    "indentation": ("normal:indentation=1", {"indentation": 1.0 + SINE}, 0.2, 0.7, {}),
    "lost contact": ("normal", {"load": 1.0 + SINE}, 0.2, 1.0, {}),
    "load and loop": (
        "normal:lateral=1,phase=90",
        {"load": 1.0 + SINE, "lateral": np.cos(PHASE)},
        0.2,
        0.7,
        {},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_a_sampled_sine_gets_the_answer_of_the_named_motion(case):
    name, columns, velocity, amplitude, settings = CASES[case]
    place = {"velocity": velocity, "amplitude": amplitude} | settings
    named = microslip.solve(name, **place)
    other = microslip.solve(sampled(**columns), **place)
    assert_agree(named, other)


@pytest.mark.parametrize("amplitude", [0.5, 2.0])
def test_a_sampled_rotation_gets_the_answer_of_the_bore(amplitude):
    # the velocity of a bore is over omega and the angle, that of a sampled motion over omega u_lim
    angle = float(hertz.bore_angle(amplitude))
    named = microslip.solve("bore", velocity=0.3, amplitude=amplitude)
    problem = microslip.Problem(microslip.Bore(), velocity=0.3, amplitude=amplitude)
    motion = sampled(angle=angle * SINE)
    other = microslip.solve(motion, velocity=problem.drift, amplitude=1.0)
    assert_agree(named, other)


def test_few_samples_of_a_sharp_motion_have_a_larger_error():
    """The interpolation between samples is a source of the error of its own."""
    zigzag = 2.0 / np.pi * np.arcsin(np.sin(PHASE))
    exact = microslip.solve("zigzag", velocity=0.1, amplitude=1.0)
    coarse = microslip.solve(
        sampled(lateral=zigzag[::8]), velocity=0.1, amplitude=1.0, tolerance=0.05
    )
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
        ({}, "forward"),
        ({"foo": SINE}, "columns"),
        ({"lateral": 0.0 * SINE}, "lateral"),
    ],
)
def test_bad_samples_are_refused_by_name(columns, argument):
    with pytest.raises(InputError) as error:
        sampled(**columns)
    assert error.value.argument == argument
