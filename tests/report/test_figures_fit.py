"""The figure of a fit: measured rows, model, residuals and units."""

import numpy as np
import pytest
from stubs.figures_stub import artists
from stubs.fit_stub import fitted

from microslip.report.figures import drawing

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


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
        assert number in upper.get_title(loc="left")


def test_parameters_without_errors_are_not_in_the_title():
    dataset = fitted(errors=False).drop_vars(["u_lim_m"])
    upper, _ = drawing.draw("fit", {"fit": dataset}).axes
    assert "lim" not in upper.get_title(loc="left")


def test_rows_with_more_conditions_than_line_styles_are_one_series():
    dataset = fitted(20)
    dataset["amplitude_si"] = "row", np.repeat(np.arange(1.0, 11.0), 2)
    dataset["speed_m_s"] = "row", np.linspace(0.0, 1.0, 20)
    upper, lower = drawing.draw("fit", {"fit": dataset}).axes
    (dashes,) = artists(upper, "fitted")  # rows of different conditions are not connected
    assert dashes.get_linestyle() == "None" and dashes.get_marker() == "_"
    assert dashes.get_ydata() == pytest.approx(dataset.fitted.values)
    assert lower.get_xscale() == "linear"
