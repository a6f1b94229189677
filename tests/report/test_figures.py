"""Figures of the paper show the values of their datasets; messages for bad datasets and files."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from PIL import Image
from stubs import figures_stub as stub
from stubs.figures_stub import artists, words

from microslip.foundation.files import CacheError
from microslip.report.figures import drawing, runs

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    """Small datasets with every variable of the paper's figures."""
    maps = {"transverse": stub.fake_transverse(), "bore": stub.fake_bore()}
    return maps | {"continuous_bore": stub.fake_continuous_bore()}


@pytest.mark.parametrize(
    ("key", "overlays"),
    [
        ("transverse", ("slider", "stick_zone", "")),
        ("bore", ("stick_zone", "stick_zone_printed", "")),
    ],
)
def test_maps_show_the_points_and_limits_of_their_dataset(key, overlays, datasets):
    figure, dataset = drawing.draw("map", {key: datasets[key]}), datasets[key]
    for overlay in overlays:
        variable = f"mu_static_{overlay}".rstrip("_")
        (line,) = artists(figure, variable)
        np.testing.assert_array_equal(line.get_xdata(), dataset["amplitude"])
        np.testing.assert_array_equal(line.get_ydata(), dataset[variable])
    (line,) = artists(figure, "mu_large_amplitude")
    large = dataset["mu_large_amplitude"]
    large = large.isel(amplitude=-1) if "amplitude" in large.dims else large
    np.testing.assert_array_equal(line.get_ydata(), large)
    static, top = artists(figure, "computed")
    np.testing.assert_array_equal(static.get_ydata(), dataset["mu_macro"][:, 0])
    np.testing.assert_array_equal(top.get_ydata(), dataset["mu_macro"][-1])
    assert not artists(figure, "error")


def test_the_steady_bore_shows_its_curves_histories_and_field(datasets):
    dataset = datasets["continuous_bore"]
    figure = drawing.draw("curves", {"a": dataset})
    names = "mu_forward_theory", "mu_torque_theory", "mu_macro", "mu_torque"
    lines = [*artists(figure, "limit"), *artists(figure, "computed")]
    for line, variable in zip(lines, names, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), dataset[variable])
    figure = drawing.draw("transients", {"a": dataset})
    for variable in ("transient_force_forward", "transient_torque"):
        lines = artists(figure, variable)
        np.testing.assert_array_equal([line.get_ydata() for line in lines], dataset[variable])
    figure = drawing.draw("field", {"a": dataset})
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


def test_the_history_has_its_mean_and_its_phase_in_periods(datasets):
    dataset = datasets["transverse"].copy()
    (mean,) = artists(drawing.draw("history", {"transverse": dataset}), "mean")
    last = dataset["history_force_forward"].values[-101:]
    assert mean.get_ydata()[0] == pytest.approx((last[1:].mean() + last[:-1].mean()) / 2)
    (line,) = artists(drawing.draw("history", {"transverse": dataset}), "forward")
    assert line.get_xdata()[-1] == pytest.approx(4.0)


def test_points_that_are_not_converged_are_hatched_and_hollow(datasets):
    bad = datasets["bore"].copy(deep=True)
    bad["converged"][2:4, 0:2] = 0
    bad["mu_macro_error"][2, 0], bad["mu_macro_error"][3, 0] = 0.1, np.inf
    bad["mu_macro"][2, 1] = np.nan
    figure = drawing.draw("map", {"bore": bad})
    cells = [one for one in artists(figure, "unconverged") if isinstance(one, Rectangle)]
    (points,) = [one for one in artists(figure, "unconverged") if isinstance(one, Line2D)]
    assert len(cells) == 4 and all(cell.get_hatch() for cell in cells)
    np.testing.assert_array_equal(points.get_xdata(), bad["amplitude"][2:4])
    assert points.get_markerfacecolor() == "white" and artists(figure, "error")
    assert "4 of 81" in words(figure)
    bad["converged"][:], bad["mu_macro"][:], bad["mu_macro_error"][:] = 0, np.nan, np.inf
    assert "81 of 81" in words(drawing.draw("map", {"bore": bad}))


@pytest.mark.parametrize(("poisson", "label"), [(0.0, "exact limit"), (0.3, r"limit at $\nu = 0$")])
def test_the_transverse_limit_is_called_exact_only_where_it_is(datasets, poisson, label):
    data = {"transverse": datasets["transverse"].assign_coords(poisson=poisson)}
    (line,) = artists(drawing.draw("map", data), "mu_static")
    assert line.get_label() == label


# Files


def test_a_file_contains_its_provenance(datasets, tmp_path):
    attributes = {"title": "friction", "source_digest": "f00d", "author": "nobody"}
    made = datasets["continuous_bore"].assign_attrs(attributes)
    figure = drawing.draw("curves", {"continuous_bore": made})
    with Image.open(drawing.save(figure, tmp_path / "figure.png")) as image:
        (provenance,) = json.loads(image.info["Description"])
        assert image.size[0] == pytest.approx(300 * figure.get_size_inches()[0], abs=1)
    assert provenance["source_digest"] == "f00d" and "author" not in provenance
    assert b"f00d" in drawing.save(figure, tmp_path / "figure.pdf").read_bytes()


def test_a_failed_save_leaves_the_old_file(datasets, tmp_path, monkeypatch):
    figure, path = drawing.draw("history", {"a": datasets["transverse"]}), tmp_path / "figure.png"
    path.write_text("old")

    def fail(target, **_):
        Path(target).write_text("half")
        raise OSError("disk full")

    monkeypatch.setattr(figure, "savefig", fail)
    with pytest.raises(CacheError, match="disk full"):
        drawing.save(figure, path)
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


def test_the_users_matplotlib_settings_are_ignored_and_restored(datasets, tmp_path):
    shown = "transients", {"a": datasets["continuous_bore"]}
    expected = drawing.save(drawing.draw(*shown), tmp_path / "a.png").read_bytes()
    with matplotlib.rc_context({"font.size": 20, "savefig.dpi": 50, "lines.linewidth": 9}):
        result = drawing.save(drawing.draw(*shown), tmp_path / "b.png").read_bytes()
        assert matplotlib.rcParams["font.size"] == 20
    assert result == expected
