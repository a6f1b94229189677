"""The figure of predictions over ranges: values, bands, units and lines."""

import numpy as np
import pytest
import xarray as xr

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
    assert titles == ["load 5 N", "load 10 N"]
    for axes, name in ((upper, "mu_apparent"), (lower, "friction_force_N")):
        first, second = axes.get_lines()
        assert second.get_xdata() == pytest.approx([1.0, 10.0, 100.0])
        assert second.get_ydata() == pytest.approx(dataset[name].values[1])
        assert np.isnan(first.get_ydata()).tolist() == [False, True, False]
        bands = [one for one in axes.collections if one.get_gid() == "error"]
        ends = np.concatenate([path.vertices[:, 1] for path in bands[1].get_paths()])
        assert ends.max() == pytest.approx(1.01 * dataset[name].values[1].max())


def test_under_a_force_the_speed_is_drawn():
    force = "force_N", [1.0, 2.0, 3.0], {"units": "N", "long_name": "force"}
    variables = {"speed_m_s": [0.0, 1e-6, 5e-6], "speed_error_m_s": [0.0, 1e-8, 5e-8]}
    variables["converged"] = [True] * 3
    columns = {name: ("force_N", values) for name, values in variables.items()}
    dataset = xr.Dataset(columns, {"force_N": force})
    (panel,) = drawing.draw("curve", {"curve": dataset}).axes
    (line,) = panel.get_lines()
    assert line.get_ydata() == pytest.approx([0.0, 1.0, 5.0])
    assert "speed" in panel.get_ylabel() and panel.get_xlabel() == "force (N)"


def test_one_range_needs_no_legend():
    upper, lower = drawing.draw("curve", {"curve": curves().isel(load_N=1)}).axes
    assert upper.get_legend() is None and len(lower.get_lines()) == 1
