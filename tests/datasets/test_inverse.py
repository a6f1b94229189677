"""Search of a map for a wanted friction: one place, several, none, and their intervals."""

import numpy as np
import pytest
import xarray as xr
from stubs.eq6_map import eq6_map, map_of

from microslip.datasets.query.inverse import OUTCOMES
from microslip.foundation.errors import InputError


def outcome(answer):
    return [OUTCOMES[k] for k in np.atleast_1d(answer.outcome)]


def peaked(error=0.0):
    """An invented friction with a peak, 1 - 4 (amplitude - 1)^2 / 9, at all velocities."""
    amplitude, velocity = np.linspace(0.0, 2.5, 26), np.array([0.1, 0.3, 1.0, 3.0])
    mu = np.repeat(1.0 - (2.0 * (amplitude[:, None] - 1.0) / 3.0) ** 2, 4, axis=1)
    return map_of(mu, velocity, amplitude, error, motion="longitudinal")


@pytest.mark.slow
@pytest.mark.parametrize("target", ["velocity", "amplitude"])
def test_the_answer_put_into_the_map_gives_what_was_wanted(target):
    dataset = eq6_map(1e-3)
    reference = {"amplitude": 1.2} if target == "velocity" else {"velocity": 0.5}
    wanted = np.array([0.5, 0.7, 0.9])
    answer = dataset.microslip.solve_for(wanted, **reference)
    assert answer[target].dims == ("wanted", "root") and outcome(answer) == ["found"] * 3
    at = answer[target].isel(root=0)
    back = dataset.microslip.at(**{target: at}, **reference)
    assert back.mu_macro.values == pytest.approx(wanted, abs=1e-9)
    # At the ends friction differs from the wanted value by its error.
    sign = 1.0 if target == "velocity" else -1.0
    for end, side in (("low", -sign), ("high", sign)):
        there = dataset.microslip.at(
            **{target: answer[f"{target}_{end}"].isel(root=0)}, **reference
        )
        off = there.mu_macro - wanted
        assert off.values == pytest.approx(side * there.mu_macro_error.values, rel=1e-6)
    assert answer.bounded.values.all()


def test_the_interval_is_that_of_a_closed_form():
    """1 - 4 (x - 1)^2 / 9 is w +- e at x = 1 +- 1.5 sqrt(1 - w -+ e)."""
    answer = peaked(error=0.01).microslip.solve_for(0.75, velocity=0.3)
    expected = [[1.0 - 1.5 * np.sqrt(0.25 + k) for k in (0.0, 0.01, -0.01)]]
    expected += [[1.0 + 1.5 * np.sqrt(0.25 + k) for k in (0.0, -0.01, 0.01)]]
    assert outcome(answer) == ["several"]
    names = ("amplitude", "amplitude_low", "amplitude_high")
    result = np.stack([answer[name].values for name in names], axis=1)
    assert result == pytest.approx(np.array(expected), abs=1e-8)


def test_two_places_that_the_error_does_not_tell_apart_are_one():
    answer = peaked(error=0.02).microslip.solve_for(0.99, velocity=0.3)
    assert answer.sizes["root"] == 1
    reach = 1.5 * np.sqrt(0.03)
    assert float(answer.amplitude_low[0]) == pytest.approx(1.0 - reach, abs=1e-8)
    assert float(answer.amplitude_high[0]) == pytest.approx(1.0 + reach, abs=1e-8)


def test_what_is_nowhere_and_what_may_be_somewhere():
    friction = peaked(error=0.02).friction
    answer = friction.solve_for([1.01, 1.03, 0.5], velocity=0.3, within=(0.5, 1.5))
    assert outcome(answer) == [OUTCOMES[2], OUTCOMES[4], OUTCOMES[3]]
    assert np.isnan(answer.amplitude.values).all()
    reach = 1.5 * np.sqrt(0.01)
    result = answer.isel(wanted=0, root=0)
    assert float(result.amplitude_low) == pytest.approx(1.0 - reach, abs=1e-8)
    assert float(result.amplitude_high) == pytest.approx(1.0 + reach, abs=1e-8)
    assert np.isnan(answer.amplitude_low.values[1:]).all()


def test_an_interval_that_the_range_cuts_off_says_so():
    answer = peaked(error=0.01).microslip.solve_for(0.75, velocity=0.3, within=(0.245, 1.0))
    assert not bool(answer.bounded[0])
    assert float(answer.amplitude_low[0]) == 0.245


@pytest.mark.slow
def test_questions_of_many_dimensions_are_each_their_own():
    dataset = eq6_map(1e-4)
    velocity = xr.DataArray([0.2, 0.5, 1.0], dims="case", coords={"case": list("abc")})
    answer = dataset.microslip.solve_for([0.6, 0.8], velocity=velocity)
    assert answer.amplitude.dims == ("wanted", "case", "root")
    for k, v in enumerate(velocity.values):
        alone = dataset.microslip.solve_for(0.8, velocity=float(v))
        assert float(answer.amplitude[1, k, 0]) == pytest.approx(
            float(alone.amplitude[0]), rel=1e-8
        )


def test_a_steady_motion_has_a_velocity_to_look_for():
    """Eq 21 is (3 pi / 8)(v - v^3 / 4) for velocities v up to 1; the wanted velocity is 0.5."""
    velocity = np.geomspace(0.05, 1.0, 41)
    mu = 3.0 * np.pi / 8.0 * (velocity - velocity**3 / 4.0)
    dataset = xr.Dataset(
        {
            "mu_macro": ("velocity", mu),
            "mu_macro_error": ("velocity", np.full(41, 1e-6)),
            "converged": ("velocity", np.ones(41, bool)),
        },
        {"velocity": velocity, "poisson": 0.0},
        {"motion": "continuous-bore"},
    )
    answer = dataset.microslip.solve_for(3.0 * np.pi / 8.0 * (0.5 - 0.125 / 4.0))
    assert outcome(answer) == ["found"]
    assert float(answer.velocity[0]) == pytest.approx(0.5, abs=1e-5)
    assert float(answer.velocity_low[0]) <= 0.5 <= float(answer.velocity_high[0])


@pytest.mark.parametrize(
    ("question", "message"),
    [
        ({}, "one of velocity and amplitude"),
        ({"velocity": 1.0, "amplitude": 1.0}, "one of velocity and amplitude"),
        ({"velocity": -1.0}, "velocity"),
        ({"velocity": 1.0, "within": (2.0, 1.0)}, "within"),
        ({"velocity": 1.0, "within": 3.0}, "within"),
        ({"velocity": 1.0, "poisson": 0.3}, "poisson"),
    ],
)
def test_bad_questions_are_refused(question, message):
    with pytest.raises(InputError, match=message):
        eq6_map(0.0).microslip.solve_for(0.5, **question)
