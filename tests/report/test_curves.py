"""Figures of predictions, of fits, and of drives: values, errors, units and lines."""

import numpy as np
import pytest
import xarray as xr
from stubs.drives_stub import drift, pulled
from stubs.figures_stub import artists, words
from stubs.fit_stub import fitted

from microslip.report.figures import drawing

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


def curves(speeds=(0.001, 0.01, 0.1), loads=(5.0, 10.0)):
    """Invented predictions, one of them not converged."""
    speed = {"units": "m/s", "long_name": "speed"}
    load = {"units": "N", "long_name": "load"}
    dims = ("load_N", "speed_m_s")
    mu = np.add.outer(0.01 * np.arange(len(loads)), 0.1 * np.arange(1, len(speeds) + 1))
    converged = np.ones(mu.shape, bool)
    converged[0, 1] = False
    force = mu * np.array(loads)[:, None]
    variables = {"mu_apparent": mu, "mu_apparent_error": 0.01 * mu, "converged": converged}
    variables["force_N"] = np.full(mu.shape, np.nan)
    variables |= {"friction_force_N": force, "friction_force_error_N": 0.01 * force}
    coordinates = {
        "speed_m_s": ("speed_m_s", list(speeds), speed),
        "load_N": ("load_N", list(loads), load),
    }
    return xr.Dataset({name: (dims, one) for name, one in variables.items()}, coordinates)


def test_lines_and_bands_have_the_values_of_the_dataset():
    dataset = curves()
    upper, lower = drawing.draw("curve", {"curve": dataset}).axes
    assert lower.get_xlabel() == "speed (mm/s)" and lower.get_xscale() == "log"
    assert "friction force (N)" in lower.get_ylabel() and "dimensionless" in upper.get_ylabel()
    titles = [text.get_text() for text in upper.get_legend().get_texts()]
    assert titles == ["load 5 N", "not converged", "load 10 N"]
    for axes, name in ((upper, "mu_apparent"), (lower, "friction_force_N")):
        first, second = artists(axes, "computed")
        assert second.get_xdata() == pytest.approx([1.0, 10.0, 100.0])
        assert second.get_ydata() == pytest.approx(dataset[name].values[1])
        (hollow,) = artists(axes, "unconverged")
        assert hollow.get_ydata() == pytest.approx(dataset[name].values[0, 1:2])
        bars = artists(axes, "error")[1].get_segments()
        assert np.max(bars) == pytest.approx(max(100.0, 1.01 * dataset[name].values[1].max()))


def test_under_a_force_the_speed_is_drawn():
    force = "force_N", [1.0, 2.0, 3.0], {"units": "N", "long_name": "force"}
    variables = {"speed_m_s": [0.0, 1e-6, 5e-6], "speed_error_m_s": [0.0, 1e-8, 5e-8]}
    variables["converged"] = [True] * 3
    columns = {name: ("force_N", values) for name, values in variables.items()}
    dataset = xr.Dataset(columns, {"force_N": force})
    (panel,) = drawing.draw("curve", {"curve": dataset}).axes
    (line,) = artists(panel, "computed")
    assert line.get_ydata() == pytest.approx([0.0, 1.0, 5.0])
    assert "speed" in panel.get_ylabel() and panel.get_xlabel() == "force (N)"


def test_rows_model_and_residuals_have_the_values_of_the_dataset():
    dataset = fitted()
    upper, lower = drawing.draw("fit", {"fit": dataset}).axes
    assert len(artists(upper, "fitted")) == 2 and lower.get_xscale() == "log"
    drawn = np.concatenate([line.get_xydata() for line in artists(upper, "fitted")])
    # in mm/s and N; the model curve has more points than there are rows
    expected = np.stack([1e3 * dataset.curve_speed_m_s, dataset.curve_fitted], axis=1)
    assert drawn == pytest.approx(expected)
    assert lower.get_xlabel() == "speed (mm/s)" and upper.get_ylabel() == "friction force (N)"
    left = np.concatenate([line.get_ydata() for line in artists(lower, "residual")])
    assert left == pytest.approx(dataset.residual.values)
    titles = [text.get_text() for text in upper.get_legend().get_texts()]
    assert titles == ["amplitude 300 nm", "amplitude 600 nm", "lines: model"]
    assert [len(axes.patches) for axes in (upper, lower)] == [0, 1]  # the band
    for number in (r"0.3 \pm 0.01$", r"300 \pm 30$ nm"):
        assert number in upper.get_legend().get_title().get_text()


def test_maps_of_drift_show_threshold_rest_and_the_rigid_contact():
    datasets = {"drift_transverse": drift("transverse"), "drift_bore": drift("bore")}
    datasets["drift_bore"]["converged"][2, 3] = 0
    figure = drawing.draw("map", datasets)
    for axes, dataset in zip(artists(figure, "map"), datasets.values(), strict=True):
        (line,) = artists(axes, "mu_static")
        force, across = line.get_data()
        assert np.array_equal(force, dataset["mu_static_curve"])
        assert np.array_equal(across, dataset["amplitude_curve"])
        assert artists(axes, "rest") and artists(axes, "rigid")
        assert len(artists(axes, "unconverged")) == (dataset is datasets["drift_bore"])
    assert "not converged (1 of 108)" in words(figure)


def test_the_points_of_all_drives_are_drawn_over_velocity_and_over_mass():
    datasets = pulled()
    datasets["drive_body"].attrs["drive"] = "mass, stiffness"
    left, right = drawing.draw("curves", datasets).axes
    velocity, force, soft, stiff = artists(left, "computed")
    assert np.array_equal(velocity.get_ydata(), datasets["transverse"]["mu_macro"][0])
    assert soft.get_ydata() == pytest.approx(stiff.get_ydata() - 0.1)
    # the abscissa of a force is its mean velocity; here it lies on the curve
    assert force.get_ydata() == pytest.approx(force.get_xdata() / (1 + force.get_xdata()))
    (level,) = artists(right, "reference")
    assert level.get_ydata()[0] == pytest.approx(0.1 / 1.1)
    assert len(artists(right, "computed")) == 2 and right.get_xscale() == "log"
