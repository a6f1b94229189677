"""Figures of the paper, of drives and of commands show the values of their datasets."""

from __future__ import annotations

import re
from itertools import product

import numpy as np
import pytest
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from stubs import figures_stub as stub
from stubs.figures_stub import artists, draw, words

from microslip.config.load import ConfigError, from_mapping
from microslip.report.explorer import page
from microslip.report.figures import runs

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


def ordinates(figure, *gids):
    """Ordinates of all lines with one of the ids, in this order."""
    return [line.get_ydata() for gid in gids for line in artists(figure, gid)]


@pytest.mark.parametrize(
    ("dataset", "overlays"),
    [
        (stub.fake_transverse(), ("mu_static_slider", "mu_static_stick_zone", "mu_static")),
        (stub.fake_bore(), ("mu_static_stick_zone", "mu_static_stick_zone_printed", "mu_static")),
    ],
)
def test_a_map_shows_its_points_and_limits_along_two_edges(dataset, overlays):
    figure = draw("map", dataset)
    large = dataset["mu_large_amplitude"]
    large = large.isel(amplitude=-1) if "amplitude" in large.dims else large
    expected = [*(dataset[one] for one in overlays), large]
    expected += [dataset["mu_macro"][:, 0], dataset["mu_macro"][-1]]
    drawn = ordinates(figure, *overlays, "mu_large_amplitude", "computed")
    for values, truth in zip(drawn, expected, strict=True):
        np.testing.assert_array_equal(values, truth)
    np.testing.assert_array_equal(artists(figure, overlays[0])[0].get_xdata(), dataset["amplitude"])
    assert not artists(figure, "error")


def test_the_steady_bore_shows_its_curves_transients_and_field():
    dataset = stub.fake_continuous_bore()
    figure = draw("curves", dataset)
    names = "mu_forward_theory", "mu_torque_theory", "mu_macro", "mu_torque"
    for values, variable in zip(ordinates(figure, "limit", "computed"), names, strict=True):
        np.testing.assert_array_equal(values, dataset[variable])
    assert figure.axes[0].get_xscale() == "log"
    figure = draw("transients", dataset)
    for variable in ("transient_force_forward", "transient_torque"):
        np.testing.assert_array_equal(ordinates(figure, variable), dataset[variable])
    figure = draw("field", dataset)
    (arrows,), (centre,) = artists(figure, "traction"), artists(figure, "centre")
    assert centre.get_xdata()[0] == -0.8
    x, y = arrows.XY.T
    away = np.hypot(y, x + 0.8)
    far = away > 0.3
    bound = 1.5 / np.pi * np.sqrt(1 - x**2 - y**2)
    assert far.sum() > 80
    lengths = np.hypot(arrows.U, arrows.V) / arrows.scale
    assert lengths.max() < 0.9 * runs.SPACING  # arrows do not touch
    np.testing.assert_allclose(arrows.U[far], (bound * y / away)[far], atol=0.03)
    np.testing.assert_allclose(arrows.V[far], (-bound * (x + 0.8) / away)[far], atol=0.03)


def test_the_history_has_its_mean_and_its_phase_in_periods():
    dataset = stub.fake_transverse()
    figure = draw("history", dataset)
    last = dataset["history_force_forward"].values[-101:]
    mean = ordinates(figure, "mean")[0][0]
    assert mean == pytest.approx((last[1:].mean() + last[:-1].mean()) / 2)
    assert artists(figure, "forward")[0].get_xdata()[-1] == pytest.approx(4.0)


def test_points_that_are_not_converged_are_hatched_and_hollow():
    bad = stub.fake_bore()
    bad["converged"][2:4, 0:2] = 0
    bad["mu_macro_error"][2, 0], bad["mu_macro_error"][3, 0] = 0.1, np.inf
    bad["mu_macro"][2, 1] = np.nan
    figure = draw("map", bad)
    cells = [one for one in artists(figure, "unconverged") if isinstance(one, Rectangle)]
    (points,) = [one for one in artists(figure, "unconverged") if isinstance(one, Line2D)]
    assert len(cells) == 4 and all(cell.get_hatch() for cell in cells)
    for cell in cells:  # around a point of the map
        (low, left), (high, right) = ((cell.get_y(), cell.get_x()), cell.get_corners()[2][::-1])
        inside = (bad.velocity > left) & (bad.velocity < right)
        inside = inside & (bad.amplitude > low) & (bad.amplitude < high)
        assert inside.sum() == 1 and not bad["converged"].where(inside, 0).any()
    np.testing.assert_array_equal(points.get_xdata(), bad["amplitude"][2:4])
    assert points.get_markerfacecolor() == "white" and artists(figure, "error")
    assert "4 of 81" in words(figure)
    bad["converged"][:], bad["mu_macro"][:], bad["mu_macro_error"][:] = 0, np.nan, np.inf
    assert "81 of 81" in words(draw("map", bad))


@pytest.mark.parametrize(
    ("poisson", "label"), [(0.0, "exact limit"), (0.3, "exact limit for ν = 0")]
)
def test_the_transverse_limit_is_called_exact_only_where_it_is(poisson, label):
    (line,) = artists(
        draw("map", stub.fake_transverse().assign_coords(poisson=poisson)), "mu_static"
    )
    assert line.get_label() == label


# Curves over an axis


def test_lines_show_the_limit_and_markers_the_smallest_velocity():
    slow = stub.static("line", velocity=(0.0, 1e-3))
    loop = stub.static("loop", velocity=(1e-3,))
    loop["converged"][3, 0] = 0
    figure = draw("curves", slow, loop)
    (line,) = ordinates(figure, "limit")  # the second dataset has no limit
    np.testing.assert_array_equal(line, slow["mu_macro"].sel(velocity=0))
    first, solved = ordinates(figure, "computed")
    np.testing.assert_array_equal(first, slow["mu_macro"].sel(velocity=1e-3))
    (failed,) = artists(figure, "unconverged")
    assert len(solved) == 6 and failed.get_markerfacecolor() == "white"
    assert "markers: velocity $0.001$" in words(figure)


@pytest.mark.parametrize(("poisson", "points"), [(0.0, 50), (0.3, 7)])
def test_a_limit_from_theory_is_drawn_on_its_finer_axis_where_it_holds(poisson, points):
    fine = np.linspace(0, 1.2, 50)
    data = stub.static("a").assign_coords(amplitude_curve=fine, poisson=poisson)
    data["mu_static"] = "amplitude", np.zeros(7)
    data["mu_static_curve"] = "amplitude_curve", np.maximum(1 - fine, 0)
    (line,) = ordinates(draw("curves", data), "limit")
    assert len(line) == points


def test_the_points_of_all_drives_are_drawn_over_velocity_and_over_mass():
    datasets = stub.pulled()
    datasets["drive_body"].attrs["drive"] = "mass, stiffness"
    left, right = draw("curves", *datasets.values()).axes
    velocity, force, soft, stiff = artists(left, "computed")
    assert np.array_equal(velocity.get_ydata(), datasets["transverse"]["mu_macro"][0])
    assert soft.get_ydata() == pytest.approx(stiff.get_ydata() - 0.1)
    # the abscissa of a force is its mean velocity; here it lies on the curve
    assert force.get_ydata() == pytest.approx(force.get_xdata() / (1 + force.get_xdata()))
    (level,) = ordinates(right, "reference")
    assert level[0] == pytest.approx(0.1 / 1.1)
    assert len(artists(right, "computed")) == 2 and right.get_xscale() == "log"


def test_each_of_many_lines_has_its_own_colour_and_marker():
    (axes,) = draw("curves", stub.many_lines()).axes
    marks = [(one.get_color(), one.get_marker()) for one in artists(axes, "computed")]
    assert len(set(marks)) == len(marks) == 12


SPEEDS = [{"velocity": speed} for speed in (0, 1, [0, 1], [0.1, 1], [0, 0.1, 1])]
FORCES = [{"force": force} for force in (0.6, [0.1, 0.9])]
RATIOS, MAP = {"poisson": [0, 0.3]}, {"error": 0.05}
SHAPES = [
    *product(SPEEDS + FORCES, (1, [0.5, 1]), ({}, RATIOS, MAP, RATIOS | MAP, {"mass": [1, 2]}))
]


@pytest.mark.parametrize("kind", ["map", "curves", "explorer"])
def test_a_figure_of_any_sweep_is_drawn_or_refused_when_the_configuration_is_read(kind):
    full = {"motion": "bore", "velocity": [0.1, 1], "amplitude": [0.5, 1]}
    figures, drawn = {"figure": {"kind": kind, "sweep": ["map", "full"]}}, 0
    for speed, amplitude, other in SHAPES:
        one = {"motion": "elliptic", "amplitude": amplitude} | speed | other
        try:
            read = from_mapping({"sweeps": {"map": one, "full": full}, "figures": figures})
        except ConfigError as error:
            assert re.search(r"sweeps\.map|figures\.figure\.sweep: map .*required", str(error))
            continue
        dataset, drawn = stub.built(read), drawn + 1
        if kind != "explorer":
            figure = draw(kind, dataset)
            gids = [gid for gid in ("certified", "error", "rest") if artists(figure, gid)]
            line = ["certified"] * ("error" in other) + ["error"] * ("force" in speed)
            assert gids == (line if kind == "curves" else ["rest"] * ("force" in speed))
        elif "cell" not in dataset.dims:
            page.build({"map": dataset}, {})
    assert drawn >= 10


def test_a_contact_at_rest_under_every_force_is_counted():
    dataset = stub.pulled()["drive_force"]
    figure = draw("curves", dataset.assign(velocity=0.0 * dataset["velocity"]))
    assert "(9 at rest: not drawn)" in " ".join(words(figure).split())


def test_maps_of_drift_show_threshold_rest_and_the_rigid_contact():
    datasets = [stub.drift("transverse"), stub.drift("bore")]
    datasets[1]["converged"][2, 3] = 0
    figure = draw("map", *datasets)
    for axes, dataset in zip(artists(figure, "map"), datasets, strict=True):
        (line,) = artists(axes, "mu_static")
        np.testing.assert_array_equal(
            line.get_data(), (dataset["mu_static_curve"], dataset["amplitude_curve"])
        )
        assert artists(axes, "rest") and artists(axes, "rigid")
        (bands,) = [one for one in axes.collections if len(getattr(one, "levels", ())) > 10]
        point = dataset.isel(amplitude=4, force=6)
        inside = [path.contains_point((point.force, point.amplitude)) for path in bands.get_paths()]
        speed = np.log10(float(point["velocity"]))
        assert inside == [low <= speed < low + 0.25 for low in bands.levels[:-1]]
        assert len(artists(axes, "unconverged")) == (dataset is datasets[1])
    assert "not converged (1 of 108)" in words(figure)


# Figures of commands


def test_predictions_have_the_values_of_the_dataset():
    dataset = stub.predictions()
    upper, lower = draw("curve", dataset).axes
    assert lower.get_xlabel() == "speed (mm/s)" and lower.get_xscale() == "log"
    assert "friction force (mN)" in lower.get_ylabel() and "dimensionless" in upper.get_ylabel()
    titles = [text.get_text() for text in upper.get_legend().get_texts()]
    assert titles == ["load 50 mN", "not converged", "95 % interval", "load 100 mN"]
    for axes, name, factor in ((upper, "mu_apparent", 1.0), (lower, "friction_force_N", 1e3)):
        values = factor * dataset[name].values
        _, second = artists(axes, "computed")
        assert second.get_xdata() == pytest.approx([1.0, 10.0, 100.0])
        assert second.get_ydata() == pytest.approx(values[1])
        (hollow,) = ordinates(axes, "unconverged")
        assert hollow == pytest.approx(values[0, 1:2])
        bars = artists(axes, "error")[1].get_segments()
        _, band = artists(axes, "uncertainty")
        ends = band.get_datalim(axes.transData).intervaly
        assert ends == pytest.approx([values[1].min() * 0.9, values[1].max() * 1.2])
        error = 0.01 * values[1, :, None]
        assert [np.ptp(bar, axis=0) for bar in bars] == pytest.approx(error * [0.0, 2.0])


def test_under_a_force_the_speed_is_drawn():
    force = {"force_N": ("force_N", [1.0, 2.0, 3.0], {"units": "N", "long_name": "force"})}
    variables = {"speed_m_s": [0.0, 1e-6, 5e-6], "speed_error_m_s": [0.0, 1e-8, 5e-8]}
    variables["converged"] = [True] * 3
    columns = {name: ("force_N", values) for name, values in variables.items()}
    (panel,) = draw("curve", xr.Dataset(columns, force)).axes
    assert ordinates(panel, "computed")[0] == pytest.approx([0.0, 1.0, 5.0])
    assert "speed" in panel.get_ylabel() and panel.get_xlabel() == "force (N)"


def test_a_fit_shows_its_rows_its_model_and_residuals():
    dataset = stub.fitted()
    upper, lower = draw("fit", dataset).axes
    assert len(artists(upper, "fitted")) == 2 and lower.get_xscale() == "log"
    drawn = np.concatenate([line.get_xydata() for line in artists(upper, "fitted")])
    # in mm/s and N; the model curve has more points than there are rows
    expected = np.stack([1e3 * dataset.curve_speed_m_s, dataset.curve_fitted], axis=1)
    assert drawn == pytest.approx(expected)
    assert lower.get_xlabel() == "speed (mm/s)" and upper.get_ylabel() == "friction force (N)"
    for axes, gid, name in ((upper, "computed", "measured"), (lower, "residual", "residual")):
        assert np.concatenate(ordinates(axes, gid)) == pytest.approx(dataset[name].values)
    titles = [text.get_text() for text in upper.get_legend().get_texts()]
    assert titles == ["amplitude 300 nm", "amplitude 600 nm", "lines: model"]
    assert [len(axes.patches) for axes in (upper, lower)] == [0, 1]  # the band
    for number in (r"0.3 \pm 0.01$", r"300 \pm 30$ nm"):
        assert number in upper.get_legend().get_title().get_text()
