"""Iwan models against closed forms, Masing's rule and the response of the full contact."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import microslip
from microslip.foundation.errors import InputError
from microslip.scene.by_name import pressure_named

PRESSURES = ("hertz", "power:exponent=1", "power:exponent=4", "punch:flat=0.8")


def test_stiffnesses_follow_the_density_of_a_sphere():
    # -d2/dphi2 of 1 - (1 - phi)^(3/2) is 3/4 (1 - phi)^(-1/2), with the integral 3/2 (1 - (1 -
    # phi)^(1/2)).  The density has no jump, so that the sums differ by one element at most.
    model = microslip.iwan(elements=400)
    slip = model.limit_force / model.stiffness
    below = np.cumsum(model.stiffness)
    closed = 1.5 * (1.0 - np.sqrt(1.0 - slip))
    assert np.all(np.abs(below - closed) <= model.stiffness)
    assert below[-1] == pytest.approx(1.5, rel=1e-12)


def test_the_end_of_a_punch_slips_at_once():
    # the stiffness 2 G* b of its flat end remains until u = 1
    stiffness = 2.0 * microslip.Punch(0.8).G_star
    model = microslip.iwan("punch:flat=0.8", elements=200)
    assert model.stiffness.sum() == pytest.approx(stiffness)
    last = model.limit_force[-1] / model.stiffness[-1]
    assert last == pytest.approx(1.0, abs=1e-9)
    assert model.stiffness[-1] == pytest.approx(0.8 * stiffness, rel=1e-3)
    assert model.stiffness[:-1].max() < 0.1 * stiffness


@pytest.mark.parametrize("pressure", PRESSURES)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_force_errors_are_within_the_tolerance_and_sharp(pressure, tolerance):
    model = microslip.iwan(pressure, tolerance=tolerance)
    curve = pressure_named(pressure).loading
    slips = model.limit_force / model.stiffness  # the errors are largest there
    path = np.sort(np.concatenate([slips, np.linspace(0.0, 1.1, 5001)]))
    difference = model.force(path) - curve(path)
    assert difference.min() > -1e-12 and model.error <= tolerance
    assert 3.0 * difference.max() <= model.error + 1e-12
    assert difference.max() == pytest.approx(model.force_error.max(), rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(st.sampled_from(PRESSURES), st.integers(1, 30), st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
def test_loops_are_those_of_masing_within_the_error(pressure, elements, first, second):
    model, fine = (microslip.iwan(pressure, elements=n) for n in (elements, 1000))
    ends = [0.0, first, second, first, second]
    path = np.concatenate([np.linspace(a, b, 40) for a, b in zip(ends, ends[1:], strict=False)])
    difference = np.abs(model.force(path) - fine.force(path)).max()
    assert difference <= model.error + fine.error


@pytest.mark.parametrize("pressure", [*PRESSURES, "ellipse:ratio=0.5"])
def test_a_response_of_the_full_contact_agrees(pressure):
    round_ = not pressure.startswith("ellipse")
    path = np.array([0.0, 0.6, 1.2, 0.3, -0.7, -0.2, -0.5, 0.4, 0.1, 0.9])
    path = path if round_ else path[:4]
    model = microslip.iwan(pressure, elements=12)
    full = microslip.response(path, pressure=pressure, tolerance=1e-3 if round_ else 2e-2)
    difference = np.abs(model.force(path) - full.force_forward)
    assert np.all(difference <= model.error_on_any_path + full.force_error[:, 0])
    assert np.all(difference[:3] <= model.error + full.force_error[:3, 0])


@pytest.mark.parametrize(
    "factors", [(-1.0, 2.0), (1.0, 0.0), (np.nan, 1.0), (1.0, 1e200), ("1", 1)]
)
def test_units_are_positive_numbers(factors):
    with pytest.raises(InputError, match="^(force|displacement) = "):
        microslip.iwan(elements=2).scaled(*factors)


def test_the_error_contains_the_effect_of_poissons_ratio():
    model = microslip.iwan(poisson=0.4, elements=100)
    amplitude = 0.7
    path = amplitude * np.array([0, 0.5, 1, 0.5, 0, -0.5, -1, -0.5, 0, 0.5, 1])
    full = microslip.response(path, poisson=0.4, tolerance=2e-3)
    difference = np.abs(model.force(path) - full.force_forward)
    assert np.all(difference <= model.error + full.force_error[:, 0])
    assert difference.max() > 3.0 * model.force_error.max()  # so that the discretisation is smaller
