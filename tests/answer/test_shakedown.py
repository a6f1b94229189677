"""Displacement until rest, against closed forms, finer runs and other models."""

import math

import pytest

import microslip
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Force, Problem


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


def test_what_is_left_is_no_more_than_is_said():
    """A run with a smaller tolerance agrees within the bound of the remaining displacement."""
    resolution = Resolution(cells=16, angles=1, steps=16)
    for force in (0.3, 0.5, 0.56):
        problem = Problem(motion_named("transverse"), 0.0, 0.5, 0.0, drive=Force(force))
        early, late = (simulate(problem, "radial", resolution, left) for left in (1e-2, 1e-4))
        assert late.periods > early.periods
        apart = abs(late.values["displacement"] - early.values["displacement"])
        assert apart <= early.distance + late.distance
        most = late.values["most_after"]
        assert early.values["most_after"] == pytest.approx(most, rel=0.2, abs=1.0)


def test_above_the_threshold_there_is_no_end():
    result = microslip.shakedown("transverse", 0.5, 0.6)
    assert not result.converged and result.displacement == math.inf
    assert result.reason.startswith("drifts on for ever: the force is above the threshold, 0.5644")
    away = microslip.shakedown("transverse", 0.5, 1.2)
    assert not away.converged and away.reason.startswith("runs away")
