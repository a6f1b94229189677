"""`solve`: limits, equal results, progress, tolerances and effort."""

import pickle

import pytest

import microslip
from microslip.periodic.discretise import Resolution
from microslip.periodic.simulate import simulate
from microslip.scene.by_name import motion_named
from microslip.scene.problem import Problem


@pytest.mark.parametrize("velocity", [0.0, 1e-3, 1.0])
@pytest.mark.parametrize(
    ("motion", "model", "nu"),
    [
        ("transverse", "auto", 0.0),
        ("transverse", "auto", 0.3),
        ("bore", "auto", 0.5),
        ("transverse", "slider", 0.0),
        ("bore", "cartesian", 0.2),
    ],
)
def test_without_vibration_friction_is_exactly_one(motion, model, nu, velocity):
    result = microslip.solve(motion, velocity, 0.0, poisson=nu, model=model)
    assert result.mu_macro == 1.0 and result.converged
    assert result.mu_macro_error <= 1e-9


def without_time(fields):
    return {name: value for name, value in fields.items() if name != "solve_time_s"}


@pytest.mark.parametrize(
    ("motion", "arguments"),
    [
        ("transverse", {"velocity": 0.2, "amplitude": 0.6}),
        ("transverse", {"velocity": 0.2, "amplitude": 0.6, "poisson": 0.3}),
        ("transverse", {"force": 0.3, "amplitude": 1.5, "mass": 0.2}),
        ("bore", {"velocity": 0.2, "amplitude": 0.6, "poisson": 0.3}),
        ("continuous-bore", {"velocity": 0.2}),
    ],
)
def test_equal_inputs_give_equal_bits(motion, arguments):
    def answer():
        result = microslip.solve(motion, **arguments, tolerance=5e-3).to_dict()
        assert result.items() >= arguments.items()
        return without_time(result)

    first = answer()
    microslip.solve("bore", 0.05, 2.0, tolerance=1e-2)  # another point in between
    assert answer() == first


def test_progress_sees_every_run():
    calls = []
    result = microslip.solve("transverse", 0.3, 1.2, progress=calls.append)
    assert len(calls) == len(set(calls)) >= 3
    assert max(r.cells for r in calls) == result.cells
    assert 2 * max(r.steps for r in calls) == result.steps_per_period


def test_warm_up_leaves_a_working_solver():
    microslip.warm_up()


@pytest.mark.parametrize(
    ("motion", "given"), [("transverse", {"cells": 16, "steps": 8}), ("bore", {"cells": 4})]
)
def test_converged_means_within_the_tolerance_at_an_imposed_resolution_too(motion, given):
    result, loose = (
        microslip.solve(motion, 0.1, 1.0, tolerance=tolerance, **given) for tolerance in (1e-3, 0.1)
    )
    error = result.mu_macro_error
    assert result.periodic and not result.converged and error > 1e-3
    assert result.reason == (
        f"at the imposed resolution the error is {error:.1e}, above the tolerance of 0.001"
    )
    assert loose.converged == (loose.mu_macro_error <= 0.1)
    if "steps" in given:  # without a tolerance, any error is accepted
        free = microslip.solve(motion, 0.1, 1.0, tolerance=None, **given)
        assert free.converged and free.reason == "" and free.to_dict()["tolerance"] is None
        assert (free.mu_macro, free.mu_macro_error) == (result.mu_macro, error)


def test_periods_are_full_ones_whatever_a_lap_is():
    """A march is half a period if the second half mirrors the first, else a whole one."""
    for motion, steps, lap in (("transverse", 16, 0.5), ("elliptic:forward=0.5,phase=30", 32, 1.0)):
        problem = Problem(motion_named(motion), 0.3, 1.0, 0.0)
        run = simulate(problem, "radial", Resolution(8, 1, 16), 1e-5)
        assert run.periods == run.effort.solves / (2 * steps) * lap  # two stages a step
    half = microslip.solve("transverse", 0.3, 1.0)
    assert isinstance(half.periods, float) and (2 * half.periods).is_integer()


def test_a_result_survives_pickling():
    for place in (("bore", 0.5, 1.0), ("normal:lateral=1,phase=90", 0.5, 0.5)):
        result = microslip.solve(*place, tolerance=3e-2)
        same = pickle.loads(pickle.dumps(result))
        assert (same.problem, same.to_dict()) == (result.problem, result.to_dict())
