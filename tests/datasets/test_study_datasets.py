"""Datasets of the studies of accuracy and stability."""

import netCDF4
import numpy as np
import pytest
from stubs import studies_stub
from stubs.studies_stub import GOOD, accuracy_result, configured, mu_of, stability_result

from microslip.datasets import netcdf
from microslip.studies import registry
from microslip.studies.accuracy import map_requests
from microslip.studies.stability import OUTCOMES, outcome
from microslip.theory import paper


def written(folder, configuration, study, results):
    """The dataset of a study from invented results, read from a file."""
    path = folder / f"{study}.nc"
    netcdf.write(path, *studies_stub.built(configuration, study, results))
    return netcdf.whole(path)


@pytest.fixture
def accuracy(tmp_path):
    return written(tmp_path, configured(), "accuracy", accuracy_result)


def rows_of(data, *names, **where):
    """Lists of the values of some variables in the trials with the values `where`."""
    chosen = np.all([data[f"trial_{key}"] == value for key, value in where.items()], axis=0)
    return [data[name].values[chosen].tolist() for name in names]


TRIAL = ("trial_level", "trial_cells", "trial_steps", "converged", "effort")
UNKNOWN = pytest.approx([np.nan] * 3, nan_ok=True)


def test_trials_are_rows_with_their_errors(accuracy):
    assert accuracy.point.values.tolist() == ["mid", "steady"]
    assert accuracy.point_title.values.tolist() == ["half way", "steady"]
    assert accuracy.point_amplitude.values == pytest.approx([0.5, np.nan], nan_ok=True)
    radial = {"point": "mid", "model": "radial", "method": "shipped"}
    expected = [[0, 1, 2], [4, 8, 16], [16, 32, 64], [True] * 3, [16, 64, 256]]
    assert rows_of(accuracy, *TRIAL, **radial) == expected
    error = pytest.approx(0.1 / np.array([4, 8, 16]) ** 2)
    assert rows_of(accuracy, "error", "claimed_error", **radial) == [error, UNKNOWN]
    auto = {"point": "mid", "model": "auto"}
    names = ("trial_method", "trial_steps", "effort")
    assert rows_of(accuracy, *names, **auto) == [["shipped"] * 3, [64] * 3, [900] * 3]
    tolerance = np.array([1e-2, 1e-3, 1e-4])
    values = [pytest.approx(factor * tolerance) for factor in (1.0, 0.6, 0.3)]
    assert rows_of(accuracy, "trial_tolerance", "claimed_error", "error", **auto) == values
    assert set(*rows_of(accuracy, "trial_model", method="paper", point="mid")) == {"cartesian"}
    assert not any(*rows_of(accuracy, "trial_steps", point="steady"))


def test_a_method_that_does_not_apply_has_no_row_and_one_that_fails_has_no_number(accuracy):
    assert rows_of(accuracy, "reason", method="full-newton") == [[]]
    failed = rows_of(accuracy, "mu_macro", "converged", "reason", method="euler", point="mid")
    assert failed == [UNKNOWN, [False] * 3, ["gave up"] * 3]
    (reasons,) = rows_of(accuracy, "reason", point="mid")
    line = f"mid: {len(reasons)} trials, 3 not converged, reference within 2.0e-04"
    assert list(registry.report(accuracy, "accuracy"))[0] == line


@pytest.mark.parametrize("cost", ["seconds", "effort"])
def test_a_front_has_converged_trials_and_errors_below_that_of_the_reference_are_equal(cost):
    def results(request):
        exact = {"mu_macro": mu_of(request) + 1e-9 / (request.get("cells") or 1), "effort": 1}
        return accuracy_result(request) | (exact if request["kind"] == "trial" else {})

    data = studies_stub.dataset(configured(), "accuracy", results)
    mid = data.isel(trial=data.trial_point == "mid")
    cheapest = mid[cost] == mid[cost].where(mid.converged).min()
    assert mid[f"front_{cost}"].values.tolist() == (cheapest & mid.converged).values.tolist()


def test_methods_that_never_apply_leave_a_study_without_trials(tmp_path):
    none = configured({"methods": ["full-newton"]})
    data = written(tmp_path, none, "accuracy", accuracy_result)
    assert data.sizes["trial"] == 0 and data.reference.size == 2
    assert list(registry.report(data, "accuracy"))[0].startswith(
        "mid: 0 trials, none not converged"
    )
    with netCDF4.Dataset(tmp_path / "accuracy.nc") as raw:
        assert raw["front_seconds"].flag_meanings == "no yes"


@pytest.mark.parametrize("more", [{}, {"converged": False, "reason": "stalled"}], ids=str)
def test_references_say_where_they_come_from(more):
    """That of `mid` is a point of the solver, that of `steady` a formula."""

    def result(request):
        return accuracy_result(request) | (more if request["kind"] == "point" else {})

    data = studies_stub.dataset(configured(), "accuracy", result)
    assert data.reference.values == pytest.approx([0.1 / 1.6, paper.bore_forward(0.8)])
    assert data.reference_error.values.tolist() == [2e-4, 0.0]
    point, formula = data.reference_source.values
    note = ", not met: stalled" if more else ""
    assert point == "model radial, tolerance 1e-6" + note and "Eq 21" in formula


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
    assert accuracy.bore_cheapest.sizes["bore_amplitude"] == 2
    study = configured().accuracy
    every = [run for *_, runs in map_requests(study, "bore") for run in runs]
    assert {run["cells"] for run in every if run["model"] == "cartesian"} == {8, 16}


def test_a_model_that_did_not_converge_is_not_the_cheapest():
    def results(request):
        bad = {"converged": False} if request.get("model") == "slider" else {}
        return accuracy_result(request) | bad

    data = studies_stub.dataset(configured(), "accuracy", results)
    loose = data.sel(map_tolerance=0.01)
    assert (loose.transverse_cheapest == "rigid").all() and (loose.bore_cheapest_cells == 4).all()


# Outcomes of probes

FAILS = GOOD | {"converged": False, "mu_macro": None}
COARSE = GOOD | {"converged": False, "mu_macro_error": 0.03, "mu_macro": 0.52}
IMPOSED = COARSE | {"cells": 4}


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
        (COARSE, "slow"),
        (GOOD | {"converged": False, "reason": "diverged: tractions of 1e9"}, "diverged"),
        (FAILS, "diverged"),
        (FAILS | {"reason": "a step was left unsolved after 2000 iterations"}, "slow"),
        ({"applies": True, "converged": False, "reason": "LinAlgError: singular"}, "diverged"),
        (FAILS | {"exhausted": "work"}, "slow"),
        # With few cells that were imposed, the error exceeds the tolerance for all methods.
        (IMPOSED, "converged"),
        (IMPOSED | {"mu_macro": 0.6}, "wrong"),
        (IMPOSED | {"periodic": False}, "slow"),
    ],
)
def test_outcomes(result, expected):
    imposed = result is not None and "cells" in result
    assert OUTCOMES[outcome(result, 0.5, 1e-3, imposed=imposed)] == expected


def test_the_atlas_holds_the_outcome_of_every_method(tmp_path):
    atlas = written(tmp_path, configured(), "stability", stability_result)
    assert list(atlas.method.values) == ["shipped", "projected-gradient", "euler"]
    names = ["poisson"] * 3 + ["step-length"] * 4 + ["steps"] * 2
    assert list(atlas.axis.values) == list(dict.fromkeys(names))
    assert atlas.case_axis.values.tolist() == names
    length = atlas.case_axis.values == "step-length"
    assert atlas.case_value.values.tolist() == [0, 0.2, 0.4, 0.25, 0.5, 1, 2, 8, 64]
    assert atlas.case_label.values[length].tolist() == ["0.25", "0.5", "1", "2"]
    euler = np.where(length, 0, 2)  # it has no step length
    assert atlas.outcome.values.tolist() == [[1] * 9, [1] * 9, euler.tolist()]
    assert atlas.error.values[0] == pytest.approx(5e-4)
    assert np.isnan(atlas.mu_macro.values[2][length]).all()
    assert atlas.reason.values[2].tolist() == np.where(length, "", "gave up").tolist()
    assert (atlas.reference == 0.5).all() and all(atlas.method_summary.values)
    assert list(registry.report(atlas, "stability"))[::2] == [
        "shipped: 9 converged, 0 slow, 0 wrong, 0 diverged",
        "euler: 0 converged, 5 slow, 0 wrong, 0 diverged",
    ]
    with netCDF4.Dataset(tmp_path / "stability.nc") as raw:
        assert raw["outcome"].dtype == np.int8
        assert list(raw["outcome"].flag_values) == [0, 1, 2, 3, 4]
        assert raw["outcome"].flag_meanings == "not_applicable converged slow wrong diverged"
