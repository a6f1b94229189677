"""Displacement until rest, against closed forms, finer runs and other models."""

import math

import numpy as np
import pytest

import microslip
from microslip.foundation.errors import InputError
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.drive import Force
from microslip.scene.problem import Problem


def mindlin(force):
    """Displacement in u_lim under a force without vibration (Cattaneo 1938, Mindlin 1949)."""
    return 1.0 - (1.0 - force) ** (2.0 / 3.0)


@pytest.mark.parametrize("force", [0.0, 0.1, 0.5, 0.9])
@pytest.mark.parametrize("poisson", [0.0, 0.3])
def test_without_vibration_it_is_mindlins(force, poisson):
    result = microslip.shakedown("transverse", 0.0, force, poisson=poisson)
    assert result.converged and result.displacement_error <= 1e-2
    # the closed form neglects the small lateral slip at nu > 0
    assert abs(result.displacement - mindlin(force)) <= result.displacement_error
    assert result.pushed == pytest.approx(mindlin(force), abs=5e-3) and result.threshold == 1.0


@pytest.mark.parametrize(("force", "amplitude"), [(0.3, 0.2), (0.5, 0.4), (0.2, 0.7)])
def test_under_a_load_that_oscillates_it_is_mindlins_at_the_least_load(force, amplitude):
    """At the least load the displacement is that of a contact under this constant load.  Points
    that return into contact carry no traction, so that nothing slips any more."""
    result = microslip.shakedown("normal", amplitude, force)
    load = 1.0 - amplitude
    depth = load ** (2.0 / 3.0)
    assert abs(result.displacement - depth * mindlin(force / load)) <= result.displacement_error
    assert result.pushed == pytest.approx(mindlin(force), abs=5e-3)


def test_a_contact_that_nothing_resists_goes_along_with_its_own_oscillation():
    result = microslip.shakedown("longitudinal", 0.5, 0.4)
    assert abs(result.displacement - mindlin(0.4)) <= result.displacement_error


POINTS = [("transverse", 0.3, 0.5), ("transverse", 0.9, 0.5), ("bore", 3.0, 0.9)]
POINTS += [
    pytest.param(*p, marks=pytest.mark.long)
    for p in (("transverse", 0.5, 0.99), ("bore", 1.0, 0.6))
]


@pytest.mark.long
@pytest.mark.parametrize(("motion", "amplitude", "share"), POINTS)
def test_claims_hold_against_finer_runs(motion, amplitude, share):
    limit = microslip.solve(motion, 0.0, amplitude).mu_macro
    coarse = microslip.shakedown(motion, amplitude, share * limit, tolerance=2e-2)
    fine = microslip.shakedown(motion, amplitude, share * limit, tolerance=4e-3)
    assert coarse.converged and fine.converged
    assert abs(coarse.displacement - fine.displacement) <= coarse.displacement_error
    assert coarse.threshold == pytest.approx(limit, abs=1e-2)
    assert fine.displacement > fine.pushed > 0.0


def walked(model, **resolution):
    problem = Problem(motion_named("transverse"), 0.0, 0.4, 0.0, drive=Force(0.4))
    return simulate(problem, model, Resolution(**resolution), 1e-3)


@pytest.mark.long
def test_rings_angles_and_squares_go_equally_far():
    rings = walked("radial", cells=24, angles=1, steps=24)
    angles = walked("polar", cells=24, angles=4, steps=24)
    squares = walked("cartesian", cells=24, angles=1, steps=12)
    assert rings.converged and angles.converged and squares.converged
    rings, angles, squares = rings.values, angles.values, squares.values
    assert angles["displacement"] == pytest.approx(rings["displacement"], abs=2e-4)
    assert squares["displacement"] == pytest.approx(rings["displacement"], abs=1.5e-2)
    assert rings["most_after"] == angles["most_after"] > 1.0


def test_what_is_left_is_no_more_than_is_said():
    """A run with a smaller tolerance agrees within the bound of the remaining displacement."""
    resolution = Resolution(cells=16, angles=1, steps=16)
    for force in (0.3, 0.5, 0.56):
        problem = Problem(motion_named("transverse"), 0.0, 0.5, 0.0, drive=Force(force))
        early, late = (simulate(problem, "radial", resolution, left) for left in (1e-2, 1e-4))
        assert late.periods > early.periods
        apart = abs(late.values["displacement"] - early.values["displacement"])
        assert apart <= early.distance + late.distance
        assert early.values["most_after"] == pytest.approx(
            late.values["most_after"], rel=0.2, abs=1.0
        )


def test_above_the_threshold_there_is_no_end():
    result = microslip.shakedown("transverse", 0.5, 0.6)
    assert not result.converged and result.displacement == math.inf
    assert result.reason.startswith("drifts on for ever: the force is above the threshold, 0.5644")
    away = microslip.shakedown("transverse", 0.5, 1.2)
    assert not away.converged and away.reason.startswith("runs away")


def test_a_contact_that_would_march_for_ever_says_so():
    """The force is above the threshold, which the run does not check."""
    problem = Problem(motion_named("transverse"), 0.0, 0.5, 0.0, drive=Force(0.65))
    result = simulate(problem, "radial", Resolution(cells=8, angles=1, steps=8), 1e-2)
    assert not result.converged and "still moves after" in result.reason


def test_equal_questions_get_equal_bits():
    one, other = (microslip.shakedown("transverse", 0.5, 0.3) for _ in range(2))
    one, other = (each.changed(solve_time_s=0.0).to_dict() for each in (one, other))
    assert one == other


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"motion": "continuous-bore", "amplitude": None}, "motion = 'continuous-bore': "),
        (
            {"motion": "transverse-bore"},
            "motion = 'transverse-bore': allowed is a motion that exerts",
        ),
        ({"force": -0.1}, "force = -0.1: "),
        ({"force": math.nan}, "force = nan: "),
        ({"amplitude": -1.0}, "amplitude = -1.0: "),
        ({"tolerance": 0.5}, "tolerance = 0.5: "),
        ({"tolerance": None}, "tolerance = None: allowed is a number"),
        ({"model": "rigid"}, "model = 'rigid': "),
        ({"time_limit": 0.0}, "time_limit = 0.0: "),
    ],
)
def test_bad_input_gets_one_line(changed, message):
    settings = {"motion": "transverse", "amplitude": 0.5, "force": 0.3} | changed
    with pytest.raises(InputError) as refused:
        microslip.shakedown(**settings)
    assert str(refused.value).startswith(message) and "\n" not in str(refused.value)


def test_few_samples_of_a_sharp_motion_have_a_larger_error():
    """The interpolation between samples is a separate source of error."""
    zigzag = 2.0 / np.pi * np.arcsin(np.sin(np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)))
    exact = microslip.shakedown("zigzag", 0.7, 0.3)
    motion = microslip.Sampled.of_columns({"lateral": zigzag[::8]})
    coarse = microslip.shakedown(motion, 0.7, 0.3, tolerance=0.1)
    assert coarse.error_model > 0.0
    errors = coarse.displacement_error + exact.displacement_error
    assert abs(coarse.displacement - exact.displacement) <= errors
    whole = microslip.shakedown("transverse", 0.7, 0.3)
    assert whole.error_model == 0.0


@pytest.mark.long
def test_in_si_units_it_is_told_of_a_joint_that_stays():
    joint = {"material": "steel", "counterbody": "steel", "radius": "200 mm", "load": "1 kN"}
    joint |= {"mu": 0.15, "frequency": "50 Hz", "amplitude": "0.5 um"}
    result = microslip.predict("transverse", **joint, force="60 N")
    same = microslip.shakedown("transverse", result.amplitude, result.force, poisson=result.poisson)
    assert result.outcome == "stays"
    assert result.displacement_m == pytest.approx(same.displacement * result.u_lim_m)
    assert result.displacement_error_m <= 1e-2 * result.u_lim_m
    assert result.cycles_to_rest == same.most_after
    moving = microslip.predict("transverse", **joint, force="100 N")
    assert moving.displacement_m is None
    assert np.isfinite(result.displacement_m)


def test_a_force_beside_a_problem_that_has_one_is_refused_by_its_name():
    problem = Problem(motion_named("transverse"), 0.0, 0.5, drive=Force(0.2))
    with pytest.raises(InputError) as raised:
        microslip.shakedown(problem, force=0.1)
    assert raised.value.argument == "force"
