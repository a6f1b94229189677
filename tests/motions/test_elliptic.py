"""The elliptic motion: special cases, other models and limits."""

import json

import numpy as np
import pytest
from stubs.agreement import assert_agree

import microslip
from microslip.app import cli
from microslip.motions.by_name import motion_named
from microslip.theory.masing import longitudinal

CIRCLE = "elliptic"


def mean_of_rigid(velocity, forward, lateral, lead):
    """Mean friction of a rigid block: the forward component of the unit velocity, averaged over a
    period."""
    t = np.linspace(0, 2 * np.pi, 20001)[:-1]
    ahead = velocity + forward * np.cos(t + lead)
    return np.mean(ahead / np.hypot(ahead, lateral * np.cos(t)))


def test_without_a_forward_part_it_is_the_transverse_motion():
    one = microslip.solve("elliptic:forward=0", 0.1, 0.7)
    other = microslip.solve("transverse", 0.1, 0.7)
    assert one.mu_macro == other.mu_macro
    assert microslip.solve("elliptic:forward=0", 0.0, 0.7, model="radial").converged


@pytest.mark.parametrize("phase", [0, 90])
def test_without_a_lateral_part_it_is_the_longitudinal_one(phase):
    answer = microslip.solve(f"elliptic:lateral=0,phase={phase}", 0.1, 0.7)
    assert answer.converged
    assert abs(answer.mu_macro - longitudinal(0.1, 0.7)) <= answer.mu_macro_error


@pytest.mark.slow
@pytest.mark.parametrize(
    "motion",
    [
        pytest.param(CIRCLE, marks=pytest.mark.long),
        pytest.param("elliptic:phase=0", marks=pytest.mark.long),
        pytest.param("elliptic:forward=0.5,phase=30", marks=pytest.mark.long),
        "elliptic:forward_cycles=2",
    ],
)
def test_rings_and_squares_agree(motion):
    rings = microslip.solve(motion, 0.1, 0.5)
    imposed = {"model": "cartesian", "cells": 24, "steps": 96, "tolerance": None}
    assert_agree(rings, microslip.solve(motion, 0.1, 0.5, **imposed))


@pytest.mark.parametrize(("forward", "phase"), [(1.0, 90), (0.5, 45), (1.0, 0)])
def test_a_large_ellipse_is_that_of_a_rigid_block(forward, phase):
    motion = f"elliptic:forward={forward},phase={phase}"
    exact = mean_of_rigid(0.3, forward, 1.0, np.deg2rad(phase))
    answer = microslip.solve(motion, 0.3 * 200, 200.0)
    assert answer.mu_macro == pytest.approx(exact, abs=0.01)
    rigid = microslip.solve(motion, 0.3 * 200, 200.0, model="rigid")
    assert rigid.mu_macro == pytest.approx(exact, abs=1e-3)


def test_a_path_and_its_mirror_image_have_the_same_friction():
    one, other = (
        microslip.solve(f"elliptic:phase={phase}", 0.1, 0.6, tolerance=3e-4) for phase in (60, 240)
    )
    assert_agree(one, other)


def test_names_are_canonical():
    assert motion_named("elliptic:phase=90,forward=1").name == "elliptic"
    assert motion_named("elliptic:phase=30.0,forward=0.50").name == "elliptic:forward=0.5,phase=30"
    assert microslip.solve("elliptic:phase=30.0", 0.5, 0.5).motion == "elliptic:phase=30"


@pytest.mark.parametrize(
    ("motion", "message"),
    [
        ("eliptic", "motion = 'eliptic': did you mean elliptic"),
        ("elliptic:width=2", "unknown number width; allowed: forward, lateral, phase"),
        ("elliptic:forward=2", "forward = 2: allowed is a share"),
        ("elliptic:forward=0,lateral=0", "allowed is forward or lateral above 0"),
        ("elliptic:forward_cycles=1.5", "forward_cycles = 1.5: allowed is a whole number"),
        ("elliptic:phase", "allowed are numbers as in elliptic:key=0.5"),
        ("transverse:phase=3", "unknown number phase; allowed: none"),
        (None, "motion = None"),
    ],
)
def test_what_names_no_motion_is_refused(motion, message):
    with pytest.raises(ValueError, match=message):
        microslip.solve(motion, 0.1, 1.0)


def test_the_command_line_takes_the_numbers_of_a_motion(capsys):
    place = ["--velocity", "0.5", "--amplitude", "0.5"]
    words = ["point", "elliptic:forward=0.5,phase=30", *place]
    assert cli.main([*words, "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["motion"] == "elliptic:forward=0.5,phase=30"
    words[1] = "elliptic:width=3"
    assert cli.main(words) == 2
    assert capsys.readouterr().err.startswith(
        "microslip point elliptic: MOTION = 'elliptic:width=3': "
    )


def test_every_point_of_a_circle_slips_as_far_as_the_sphere():
    result = microslip.period(CIRCLE, 0.1, 0.6)
    assert result.slip_forward[1:].sum(axis=0) == pytest.approx(0.2 * np.pi, rel=2e-3)
    assert result.slip_lateral[1:].sum(axis=0) == pytest.approx(0.0, abs=2e-3)


def test_a_figure_of_eight_may_drive_the_contact_forward():
    """The mean force can be negative, and agrees with a plain march."""
    motion, place = "elliptic:forward_cycles=2,phase=45", (0.02, 1.0)
    answer = microslip.solve(motion, *place)
    plain = microslip.history(motion, *place, cells=24, steps=256, periods=40)
    last = plain.phase >= plain.phase[-1] - 2 * np.pi - 1e-9
    mean = np.trapezoid(plain.force_forward[last], plain.phase[last]) / (2 * np.pi)
    assert answer.converged
    assert answer.mu_macro == pytest.approx(mean, abs=5e-3)
    opposite = microslip.solve("elliptic:forward_cycles=2,phase=225", *place)
    assert min(answer.mu_macro, opposite.mu_macro) < -0.02


@pytest.mark.parametrize("motion", ["elliptic", "elliptic:forward_cycles=2,phase=20"])
def test_friction_never_falls_with_velocity(motion):
    result = [microslip.solve(motion, v, 0.8) for v in (0.01, 0.05, 0.2, 0.5, 1.0, 3.0)]
    for slow, fast in zip(result, result[1:], strict=False):
        assert fast.mu_macro >= slow.mu_macro - slow.mu_macro_error - fast.mu_macro_error


@pytest.mark.slow
@pytest.mark.parametrize(
    ("velocity", "amplitude"),
    [(0.05, 0.4), (0.5, 2.0), pytest.param(0.01, 0.8, marks=pytest.mark.long)],
)
def test_errors_are_within_their_estimates_by_finer_runs(velocity, amplitude):
    answer = microslip.solve(CIRCLE, velocity, amplitude)
    finer = microslip.solve(CIRCLE, velocity, amplitude, tolerance=2e-4)
    assert_agree(answer, finer)


def test_an_ellipse_without_a_lateral_part_is_the_longitudinal_motion():
    """Its phase lead only shifts the time, so the same closed form applies."""
    line = microslip.solve("elliptic:forward=0.5,lateral=0,phase=40", 0.1, 1.0)
    exact = microslip.solve("longitudinal", 0.1, 0.5)
    assert line.model == exact.model
    assert line.mu_macro == pytest.approx(exact.mu_macro, abs=1e-9)


def test_an_ellipse_without_a_forward_part_has_the_symmetries_of_the_transverse_motion():
    """The number of cycles of a direction that does not oscillate has no effect."""
    line, sine = motion_named("elliptic:forward=0,forward_cycles=2"), motion_named("transverse")
    assert line.turns(0.1, 1.0) == sine.turns(0.1, 1.0)
    assert (line.half_period_mirror, line.straight, line.cycles) == (True, True, 1)
