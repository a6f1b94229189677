"""Datasets of the studies of accuracy and stability."""

import netCDF4
import numpy as np
import pytest
from stubs.studies_stub import GOOD, accuracy_result, answered, configured, stability_result

from microslip.datasets import netcdf
from microslip.studies import registry
from microslip.studies.stability import OUTCOMES, outcome


@pytest.fixture
def accuracy(tmp_path):
    """The dataset of accuracy from invented results, read from a file."""
    answer, _ = answered(accuracy_result)
    data = registry.undivided(configured(), "accuracy", answer)
    netcdf.write(tmp_path / "accuracy.nc", *registry.divided(data, "accuracy"))
    return netcdf.whole(tmp_path / "accuracy.nc")


def rows_of(data, **where):
    """Trials with these values, as a dataset."""
    chosen = np.ones(data.sizes["trial"], bool)
    for name, value in where.items():
        chosen &= data[f"trial_{name}"].values == value
    return data.isel(trial=chosen)


def test_trials_are_rows_with_their_errors(accuracy):
    assert list(accuracy.point.values) == ["mid", "steady"]
    assert list(accuracy.point_title.values) == ["half way", "steady"]
    assert np.isnan(accuracy.point_amplitude.values[1])
    radial = rows_of(accuracy, point="mid", model="radial", method="shipped")
    assert list(radial.trial_cells.values) == [4, 8, 16]
    assert radial.error.values == pytest.approx(0.1 / np.array([4, 8, 16]) ** 2)
    assert radial.trial_steps.values.tolist() == [16, 32, 64]
    assert radial.converged.values.all()
    assert np.isnan(radial.claimed_error).all()
    (paper,) = rows_of(accuracy, method="paper", point="mid").trial_model.values
    assert paper == "cartesian"
    assert (rows_of(accuracy, point="steady").trial_steps.values == 0).all()


def test_the_choice_that_follows_a_tolerance_claims_an_error(accuracy):
    auto = rows_of(accuracy, point="mid", model="auto")
    assert set(auto.trial_method.values) == {"shipped"}
    assert auto.trial_tolerance.values == pytest.approx([1e-2, 1e-3, 1e-4])
    assert auto.claimed_error.values == pytest.approx([6e-3, 6e-4, 6e-5])
    assert auto.error.values == pytest.approx([3e-3, 3e-4, 3e-5])
    assert (auto.trial_steps.values == 64).all()
    assert (auto.effort.values == 900).all()


def test_what_does_not_apply_has_no_row_and_what_fails_has_no_number(accuracy):
    assert not rows_of(accuracy, method="full-newton").sizes["trial"]
    euler = rows_of(accuracy, method="euler", point="mid")
    assert euler.sizes["trial"] == 3
    assert np.isnan(euler.mu_macro).all()
    assert not euler.converged.any()
    assert set(euler.reason.values) == {"gave up"}
    assert not (euler.front_seconds | euler.front_effort).any()


@pytest.mark.slow
def test_references_say_where_they_come_from(accuracy):
    mid, steady = accuracy.isel(point=0), accuracy.isel(point=1)
    assert float(mid.reference) == pytest.approx(0.1 / 1.6)
    assert float(mid.reference_error) == 2e-4
    assert mid.reference_source.item() == "model radial, tolerance 1e-6"
    # Eq 21 by quadrature of the forward component of the slip direction.
    radius, angle = np.meshgrid(
        (np.arange(1000) + 0.5) / 1000, (np.arange(1000) + 0.5) * np.pi / 1000, indexing="ij"
    )
    forward, lateral = 0.8 + radius * np.cos(angle), radius * np.sin(angle)
    pressure = 1.5 / np.pi * np.sqrt(1 - radius**2) * radius
    share = forward / np.hypot(forward, lateral)
    mean = 2 * np.pi * np.mean(pressure * share)
    assert float(steady.reference) == pytest.approx(mean, abs=1e-4)
    assert float(steady.reference_error) == 0
    assert "Eq 21" in steady.reference_source.item()


def test_a_reference_that_did_not_converge_says_so():
    def result(request):
        answer = accuracy_result(request)
        if request["kind"] == "point":
            answer |= {"converged": False, "reason": "stalled"}
        return answer

    data = registry.undivided(configured(), "accuracy", answered(result)[0])
    assert data.reference_source.values[0] == "model radial, tolerance 1e-6, not met: stalled"
    assert data.reference.values[0] == pytest.approx(0.1 / 1.6)


def test_maps_hold_the_cheapest_model_that_is_good_enough(accuracy):
    assert list(accuracy.map_tolerance.values) == [0.01, 0.001]
    result = accuracy.transverse_cheapest
    assert result.dims == ("map_tolerance", "transverse_amplitude", "transverse_velocity")
    assert (result.sel(map_tolerance=0.01) == "slider").all()
    # The error of models with cells is 0.1/cells^2, which is below 1e-3 from 12 cells on.
    tight = accuracy.sel(map_tolerance=0.001)
    assert set(tight.transverse_cheapest.values.flat) <= {"mdr", "radial", "rigid", "cartesian"}
    assert (tight.transverse_cheapest_cells == 16).all()
    assert tight.transverse_cheapest_seconds.values == pytest.approx(16e-3)
    assert (tight.bore_cheapest_cells.values <= 16).all()
    assert accuracy.bore_cheapest.sizes["bore_amplitude"] == 2


# Outcomes of probes


STUCK = "a step was left unsolved after 2000 iterations: residual 4.5e-06"


@pytest.mark.parametrize(
    ("result", "expected"),
    [
        (None, "not_applicable"),
        ({"applies": False, "converged": False, "reason": "not here"}, "not_applicable"),
        (GOOD, "converged"),
        (GOOD | {"mu_macro": 0.5019}, "converged"),  # within the sum of both errors
        (GOOD | {"mu_macro": 0.5021}, "wrong"),
        (GOOD | {"mu_macro": 0.4979}, "wrong"),
        (GOOD | {"mu_macro_error": 0.0, "mu_macro": 0.5011}, "wrong"),
        (GOOD | {"mu_macro_error": None}, "wrong"),
        (GOOD | {"converged": False, "reason": "no periodic state"}, "slow"),
        (GOOD | {"converged": False, "mu_macro": 0.9, "reason": "no periodic state"}, "slow"),
        (GOOD | {"converged": False, "reason": "diverged: tractions of 1e9"}, "diverged"),
        (GOOD | {"converged": False, "mu_macro": None}, "diverged"),
        (GOOD | {"converged": False, "mu_macro": None, "reason": STUCK}, "slow"),
        ({"applies": True, "converged": False, "reason": "LinAlgError: singular"}, "diverged"),
        (GOOD | {"converged": False, "mu_macro": None, "exhausted": "work"}, "slow"),
    ],
)
def test_outcomes(result, expected):
    assert OUTCOMES[outcome(result, 0.5, 1e-3)] == expected


def test_a_method_is_not_to_blame_for_a_resolution_that_was_imposed():
    """With few cells the error exceeds the tolerance for all methods."""
    coarse = GOOD | {"converged": False, "mu_macro_error": 0.03, "mu_macro": 0.52}
    assert OUTCOMES[outcome(coarse, 0.5, 1e-3, imposed=True)] == "converged"
    assert OUTCOMES[outcome(coarse | {"mu_macro": 0.6}, 0.5, 1e-3, imposed=True)] == "wrong"
    assert OUTCOMES[outcome(coarse | {"periodic": False}, 0.5, 1e-3, imposed=True)] == "slow"
    assert OUTCOMES[outcome(coarse, 0.5, 1e-3)] == "slow"


@pytest.fixture
def atlas(tmp_path):
    """The dataset of stability from invented results, read from a file."""
    data = registry.undivided(configured(), "stability", answered(stability_result)[0])
    netcdf.write(tmp_path / "stability.nc", *registry.divided(data, "stability"))
    return netcdf.whole(tmp_path / "stability.nc")


def test_the_atlas_holds_what_became_of_every_method(atlas, tmp_path):
    assert list(atlas.method.values) == ["shipped", "projected-gradient", "euler"]
    assert list(atlas.axis.values) == ["poisson", "step-length", "steps"]
    assert list(dict.fromkeys(atlas.case_axis.values)) == ["poisson", "step-length", "steps"]
    step_length = atlas.case_axis.values == "step-length"
    values = [0.25, 0.5, 1.0, 2.0]
    assert atlas.case_value.values[step_length].tolist() == values
    assert atlas.case_label.values[step_length].tolist() == [f"{v:g}" for v in values]
    shipped, gradient, euler = atlas.outcome.values
    assert (shipped == 1).all()
    assert (gradient == 1).all()
    assert (euler == np.where(step_length, 0, 2)).all()
    assert atlas.error.values[0] == pytest.approx(5e-4)
    assert np.isnan(atlas.mu_macro.values[2][step_length]).all()
    assert set(atlas.reason.values[2][~step_length]) == {"gave up"}
    assert set(atlas.reason.values[2][step_length]) == {""}
    assert (atlas.reference == 0.5).all()
    assert all(atlas.method_summary.values)
    with netCDF4.Dataset(tmp_path / "stability.nc") as raw:
        assert raw["outcome"].dtype == np.int8
        assert list(raw["outcome"].flag_values) == [0, 1, 2, 3, 4]
        assert raw["outcome"].flag_meanings == "not_applicable converged slow wrong diverged"


@pytest.mark.slow
def test_reports_count(accuracy, atlas):
    assert list(registry.report(accuracy, "accuracy"))[0] == (
        f"mid: {rows_of(accuracy, point='mid').sizes['trial']} trials, 3 not converged, "
        "reference within 2.0e-04"
    )
    assert list(registry.report(atlas, "stability")) == [
        "shipped: 9 converged, 0 slow, 0 wrong, 0 diverged",
        "projected-gradient: 9 converged, 0 slow, 0 wrong, 0 diverged",
        "euler: 0 converged, 5 slow, 0 wrong, 0 diverged",
    ]
