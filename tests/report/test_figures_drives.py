"""Figures of drives and drift, from datasets with known values."""

import numpy as np
import pytest
from stubs.drives_stub import FORCES, drift, pulled
from stubs.figures_stub import artists, draw

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


def test_maps_of_drift_show_threshold_rest_and_the_rigid_contact():
    datasets = {"drift_transverse": drift("transverse"), "drift_bore": drift("bore")}
    figure = draw("drift_maps", datasets)
    for axes, dataset in zip(figure.axes, datasets.values(), strict=False):
        (line,) = artists(axes, "mu_static")
        force, across = line.get_data()
        assert np.array_equal(force, dataset["mu_static_curve"])
        assert np.array_equal(across, dataset["amplitude_curve"])
        assert artists(axes, "stays")
        computed, rigid = artists(axes, "contours")[0], artists(axes, "velocity_large_amplitude")[0]
        # the two fields, and so the lines, are equal away from the threshold
        lines = (levels.get_paths()[1].vertices for levels in (computed, rigid))
        tops = [line[line[:, 1].argmax()] for line in lines]
        assert tops[0] == pytest.approx(tops[1], abs=1e-9)


@pytest.mark.parametrize("panel", [0, 1])
def test_points_of_a_map_that_did_not_converge_are_marked(panel):
    datasets = {"drift_transverse": drift("transverse"), "drift_bore": drift("bore")}
    broken = list(datasets.values())[panel]
    broken["converged"][2, 3] = 0
    figure = draw("drift_maps", datasets)
    marks = [artists(axes, "unconverged")[0].get_xydata() for axes in figure.axes[:2]]
    plain, marked = marks[1 - panel], marks[panel]
    assert len(plain) == 0
    (legend,) = figure.legends
    assert "not converged" in [text.get_text() for text in legend.get_texts()]
    assert marked.tolist() == [[FORCES[3], float(broken["amplitude"][2])]]


def test_the_points_of_all_drives_are_drawn():
    datasets = pulled()
    figure = draw("drives", datasets)
    left, right = figure.axes
    (line,) = artists(left, "velocity")
    assert np.array_equal(line.get_ydata(), datasets["transverse"]["mu_macro"][0])
    soft, stiff, force = artists(left, "computed")
    assert soft.get_ydata() == pytest.approx(stiff.get_ydata() - 0.1)
    # the abscissa of a force is its mean velocity; here it lies on the curve
    assert force.get_ydata() == pytest.approx(force.get_xdata() / (1 + force.get_xdata()))
    (level,) = artists(right, "velocity")
    assert level.get_ydata()[0] == pytest.approx(0.1 / 1.1)
