"""The paper's figures: every one draws what its dataset holds."""

from __future__ import annotations

import json
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import PolyCollection
from matplotlib.legend import Legend
from matplotlib.text import Text
from PIL import Image

from microslip.foundation.files import CacheError
from microslip.report.figures import drawing, poisson
from microslip.theory import paper

pytestmark = pytest.mark.slow  # for drawing takes a second or two

#: The paper's figures; those of the studies have tests of their own.
PAPERS = [name for name in drawing.FIGURES if name.startswith("fig")]


def fake_transverse(n: int = 9) -> xr.Dataset:
    """A transverse sweep: between the exact static limit and Eq 6, with a slider's history."""
    amplitude, velocity = np.linspace(0, 3, n), np.geomspace(1e-3, 10, n)
    large = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    exact = paper.static_limit_transverse(amplitude)
    phase = np.linspace(0, 8 * np.pi, 401)
    path, force = 0.2 * phase + 1j * np.sin(phase), np.ones(phase.size, complex)
    for i in range(1, phase.size):  # a single elastic slider
        force[i] = force[i - 1] + path[i] - path[i - 1]
        force[i] /= max(1.0, abs(force[i]))
    both, one = ("amplitude", "velocity"), ("amplitude",)
    return xr.Dataset(
        {
            **fake_map(exact[:, None] + (1 - exact[:, None]) * large),
            "mu_large_amplitude": (both, large),
            "mu_static_slider": (one, paper.static_slider(amplitude)),
            "mu_static_stick_zone": (one, paper.static_transverse(amplitude)),
            "mu_static": (one, exact),
            "history_phase": ("history_step", phase, {"units": "rad"}),
            "history_force_forward": ("history_step", force.real),
            "history_force_lateral": ("history_step", force.imag),
            "history_velocity": 0.2,
            "history_amplitude": 1.0,
        },
        coords={"amplitude": amplitude, "velocity": velocity},
        attrs={"tolerance": 1e-3},
    )


def fake_bore(n: int = 9) -> xr.Dataset:
    """A bore sweep that runs between the exact static limit and Eq 29."""
    amplitude, velocity = np.linspace(0, 5, n), np.geomspace(1e-3, 10, n)
    large, exact = paper.large_amplitude_bore(velocity), paper.static_limit_bore(amplitude)
    return xr.Dataset(
        {
            **fake_map(exact[:, None] + (1 - exact[:, None]) * large),
            "mu_large_amplitude": (("velocity",), large),
            "mu_static_stick_zone": (("amplitude",), paper.static_bore(amplitude)),
            "mu_static_stick_zone_printed": (("amplitude",), paper.static_bore_printed(amplitude)),
            "mu_static": (("amplitude",), exact),
        },
        coords={"amplitude": amplitude, "velocity": velocity},
    )


def fake_map(mu: np.ndarray) -> dict:
    """mu_macro with its certificates, every point converged."""
    both = ("amplitude", "velocity")
    return {
        "mu_macro": (both, mu),
        "mu_macro_error": (both, np.full_like(mu, 8e-4)),
        "converged": (both, np.ones(mu.shape, np.int8)),
    }


def fake_continuous_bore(n: int = 9, rings: int = 8) -> xr.Dataset:
    """A steady bore: Eqs 15, 21 and 22, and starts that decay to them."""
    velocity = np.geomspace(0.1, 10, n)
    force, torque = paper.bore_forward(velocity), paper.bore_torque(velocity)
    end = paper.bore_forward(0.8), paper.bore_torque(0.8)
    r = np.sin((np.arange(rings) + 0.5) / rings * np.pi / 2)
    turn = (np.arange(3 * rings) + 0.5) * 2 * np.pi / (3 * rings)
    x, y = (np.outer(r, f(turn)).ravel() for f in (np.cos, np.sin))
    bound = 1.5 / np.pi * np.sqrt(1 - x**2 - y**2)
    away = np.hypot(y, x + 0.8)
    travel = np.linspace(0, 3, 61)
    first = np.array([[0, 0], [0, 1], [1, 0]])
    gone = [f + (first[:, [i]] - f) * np.exp(-3 * travel) for i, f in enumerate(end)]
    step = ("start", "transient_step")
    return xr.Dataset(
        {
            "mu_macro": ("velocity", force + 1e-3 * (-1.0) ** np.arange(n)),
            "mu_torque": ("velocity", torque),
            "mu_macro_error": ("velocity", np.full(n, 1e-3)),
            "mu_torque_error": ("velocity", np.full(n, 1e-3)),
            "converged": ("velocity", np.ones(n, np.int8)),
            "mu_forward_theory": ("velocity", force),
            "mu_torque_theory": ("velocity", torque),
            "field_lateral_position": ("cell", x),
            "field_forward_position": ("cell", y),
            "field_traction_lateral": ("cell", bound * y / away),
            "field_traction_forward": ("cell", -bound * (x + 0.8) / away),
            "field_bound": ("cell", bound),
            "field_velocity": 0.8,
            "field_centre_lateral": -0.8,
            "transient_displacement": (step, np.tile(travel, (3, 1))),
            "transient_force_forward": (step, gone[0]),
            "transient_torque": (step, gone[1]),
            "transient_velocity": 0.8,
            "transient_force_theory": end[0],
            "transient_torque_theory": end[1],
        },
        coords={"velocity": velocity, "start": ["stress-free", "full-rotation", "full-slip"]},
    )


@pytest.fixture(scope="module")
def datasets() -> dict[str, xr.Dataset]:
    """Small datasets with every variable the figures need."""
    return {
        "transverse": fake_transverse(),
        "bore": fake_bore(),
        "continuous_bore": fake_continuous_bore(),
    }


@pytest.fixture(scope="module")
def figures(datasets):
    """All six figures, drawn once."""
    return {name: drawing.draw(name, datasets) for name in PAPERS}


def artists(figure, gid: str) -> list:
    """The artists of a figure with that id."""
    return figure.findobj(lambda artist: artist.get_gid() == gid)


def check_nothing_cut_off(figure) -> None:
    """Everything drawn is inside the figure, and no panel is squeezed to make room."""
    size, edges = figure.get_size_inches(), figure.get_tightbbox().extents
    assert np.all(edges[:2] > -0.02)
    assert np.all(edges[2:] < size + 0.02)
    for axes in figure.findobj(Axes):
        if axes.get_label() != "<colorbar>":
            assert axes.get_position().width * axes.figure.bbox.width > 0.26 * figure.bbox.width


@pytest.mark.long
def test_a_figure_says_what_made_it(datasets, tmp_path):
    made = datasets["bore"].assign_attrs(title="friction", source_digest="f00d", author="nobody")
    figure = drawing.draw("fig6_bore_map", {"bore": made})
    with Image.open(drawing.save(figure, tmp_path / "map.png")) as image:
        (said,) = json.loads(image.info["Description"])
    assert said["source_digest"] == "f00d"
    assert "author" not in said
    assert b"f00d" in drawing.save(figure, tmp_path / "map.pdf").read_bytes()


@pytest.mark.parametrize("name", PAPERS)
def test_labels_exist_and_nothing_is_cut_off_or_hidden(name, figures):
    figure = figures[name]
    check_nothing_cut_off(figure)
    panels = [axes for axes in figure.findobj(Axes) if axes.get_label() != "<colorbar>"]
    assert panels[-1].get_xlabel() or any(axes.get_xlabel() for axes in panels)
    for axes in panels:
        alone = not (axes.get_shared_x_axes().get_siblings(axes)[1:])
        assert not alone or (axes.get_xlabel() and axes.get_ylabel())
    inside = [axes.get_window_extent().padded(-2) for axes in panels]
    for legend in figure.findobj(Legend):
        assert not any(legend.get_window_extent().overlaps(box) for box in inside)


@pytest.mark.parametrize(
    ("name", "key", "overlays", "at"),
    [
        ("fig2_transverse_map", "transverse", ["slider", "stick_zone", ""], -1),
        ("fig6_bore_map", "bore", ["stick_zone_printed", "stick_zone", ""], None),
    ],
)
def test_cuts_show_the_dataset(name, key, overlays, at, datasets, figures):
    dataset = datasets[key]
    for overlay in overlays:
        variable = f"mu_static_{overlay}".rstrip("_")
        (line,) = artists(figures[name], variable)
        np.testing.assert_array_equal(line.get_xdata(), dataset["amplitude"])
        np.testing.assert_array_equal(line.get_ydata(), dataset[variable])
    (line,) = artists(figures[name], "mu_large_amplitude")
    large = dataset["mu_large_amplitude"].values
    np.testing.assert_array_equal(line.get_ydata(), large if at is None else large[at])
    static, top = artists(figures[name], "computed")
    np.testing.assert_array_equal(static.get_ydata(), dataset["mu_macro"][:, 0])
    np.testing.assert_array_equal(top.get_ydata(), dataset["mu_macro"][-1])
    assert not artists(figures[name], "unconverged")
    assert not artists(figures[name], "error-band")


def test_steady_curves_and_transients_show_the_dataset(datasets, figures):
    dataset = datasets["continuous_bore"]
    for variable in ("mu_forward_theory", "mu_torque_theory"):
        (line,) = artists(figures["fig4_continuous_bore"], variable)
        np.testing.assert_array_equal(line.get_ydata(), dataset[variable])
    for variable in ("transient_force_forward", "transient_torque"):
        lines = artists(figures["fig5_transients"], variable)
        np.testing.assert_array_equal([line.get_ydata() for line in lines], dataset[variable])
    (centre,) = artists(figures["fig3_traction_field"], "centre")
    assert centre.get_xdata()[0] == -0.8


def test_arrows_follow_the_traction_of_the_cells(figures):
    (arrows,) = artists(figures["fig3_traction_field"], "traction")
    x, y = arrows.XY.T
    away = np.hypot(y, x + 0.8)
    far = away > 0.3
    bound = 1.5 / np.pi * np.sqrt(1 - x**2 - y**2)
    assert far.sum() > 80
    np.testing.assert_allclose(arrows.U[far], (bound * y / away)[far], atol=0.03)
    np.testing.assert_allclose(arrows.V[far], (-bound * (x + 0.8) / away)[far], atol=0.03)


def test_points_that_are_not_converged_are_hatched_and_hollow(datasets):
    bad = datasets["bore"].copy(deep=True)
    bad["converged"][2:4, 0:2] = 0
    bad["mu_macro_error"][2, 0], bad["mu_macro_error"][3, 0] = 0.1, np.inf
    bad["mu_macro"][2, 1] = np.nan
    figure = drawing.draw("fig6_bore_map", {"bore": bad})
    check_nothing_cut_off(figure)
    (cells,) = [a for a in artists(figure, "unconverged") if isinstance(a, PolyCollection)]
    assert cells.get_hatch()
    assert len(cells.get_paths()) == 4
    (points,) = [a for a in artists(figure, "unconverged") if not isinstance(a, PolyCollection)]
    np.testing.assert_array_equal(points.get_xdata(), bad["amplitude"][2:4])
    assert artists(figure, "error-band")
    assert any("4 of 81" in text.get_text() for text in figure.findobj(Text))


@pytest.mark.usefixtures("unplaced")
def test_history_mean_and_phase(datasets):
    dataset = datasets["transverse"].copy()
    (mean,) = artists(drawing.draw("fig1_force_history", {"transverse": dataset}), "mean")
    last = dataset["history_force_forward"].values[-101:]
    assert mean.get_ydata()[0] == pytest.approx((last[1:].mean() + last[:-1].mean()) / 2)
    turns = (dataset["history_phase"] / (2 * np.pi)).assign_attrs(units="periods")
    figure = drawing.draw("fig1_force_history", {"transverse": dataset.assign(history_phase=turns)})
    assert artists(figure, "forward")[0].get_xdata()[-1] == pytest.approx(4.0)


@pytest.mark.long
@pytest.mark.usefixtures("unplaced")
@pytest.mark.parametrize(
    ("motion", "name", "label"),
    [
        ("transverse", "fig2_transverse_map", r"limit at $\nu = 0$"),
        ("bore", "fig6_bore_map", "exact limit"),
    ],
)
def test_the_static_limit_is_called_exact_only_where_it_is(datasets, motion, name, label):
    for ratio, expected in ((0.0, "exact limit"), (0.3, label)):
        given = {motion: datasets[motion].assign_coords(poisson=ratio)}
        (line,) = artists(drawing.draw(name, given), "mu_static")
        assert line.get_label() == expected


@pytest.mark.parametrize(
    ("key", "name"),
    [
        pytest.param("transverse", "fig2_transverse_map", marks=pytest.mark.long),
        ("bore", "fig6_bore_map"),
    ],
)
def test_all_of_poissons_ratios_in_a_sweep_are_drawn(datasets, key, name):
    given = at_ratios(datasets[key], 0.0, 0.5).isel(poisson=[1, 0])
    figure = drawing.draw(name, {key: given})
    check_nothing_cut_off(figure)
    assert len(artists(figure, "contours")) == 2
    headed = [axes.get_title(loc="left") for axes in figure.findobj(Axes)]
    assert [any(rf"$\nu = {nu}$" in head for head in headed) for nu in ("0", "0.5")] == [True] * 2
    points = artists(figure, "computed")
    assert len(points) == 4
    ways = ({"velocity": 0}, {"amplitude": -1})
    expected = [given.mu_macro.sel(poisson=nu).isel(at) for at in ways for nu in (0, 0.5)]
    for line, values in zip(points, expected, strict=True):
        np.testing.assert_array_equal(line.get_ydata(), values)
    assert len({line.get_marker() for line in points}) == 2
    said = [text.get_text() for legend in figure.findobj(Legend) for text in legend.get_texts()]
    assert said.count(r"computed, $\nu = 0.5$") == 2


@pytest.mark.long
@pytest.mark.usefixtures("unplaced")
def test_of_many_of_poissons_ratios_it_is_said_how_many_are_drawn(datasets):
    given = at_ratios(datasets["bore"], *np.linspace(0, 0.5, 11))
    figure = drawing.draw("fig6_bore_map", {"bore": given})
    assert len(artists(figure, "contours")) == 6
    said = " ".join(text.get_text() for text in figure.findobj(Text))
    assert "6 of the 11 of Poisson's ratios" in said
    assert r"$\nu = 0$" in said and r"$\nu = 0.5$" in said


def at_ratios(dataset, *ratios):
    """A dataset with a dimension poisson; each ratio adds a tenth of itself to mu_macro."""
    parts = [dataset.assign(mu_macro=dataset.mu_macro + 0.1 * nu) for nu in ratios]
    both = xr.concat(parts, xr.Variable("poisson", list(ratios)), data_vars=["mu_macro"])
    both["mu_macro_change"] = both.mu_macro - both.mu_macro.isel(poisson=0)
    return both.assign_attrs(tolerance=1e-3)


@pytest.mark.long
def test_what_poissons_ratio_changes(datasets):
    assert len(poisson.LOOKS) == drawing.MOST_POISSONS
    given = {name: at_ratios(datasets[name], 0.0, 0.5) for name in ("transverse", "bore")}
    figure = drawing.draw("poisson", given)
    check_nothing_cut_off(figure)
    words = [text.get_text() for text in figure.findobj(Text)]
    assert r"$\nu = 0.5$" in words
    bars = [axes.get_yticks() for axes in figure.axes if "less that" in axes.get_ylabel()]
    assert len(bars) == 2
    for ticks in bars:  # twice the tolerance is pale, and the change of 0.05 is on the scale
        assert sorted(ticks)[1:3] == pytest.approx([-2e-3, 2e-3])
        assert 0.05 - 1e-9 <= max(ticks) <= 0.054
    many = {name: at_ratios(datasets[name], *np.linspace(0, 0.5, 5)) for name in given}
    for bad in (datasets, many):
        with pytest.raises(ValueError, match="poisson"):
            drawing.draw("poisson", bad)


@pytest.mark.usefixtures("unplaced")
def test_a_theory_curve_may_have_a_finer_axis_of_its_own(datasets):
    fine = np.linspace(0, 1, 50)
    line = xr.DataArray(1 - fine**1.5, {"amplitude_fine": fine}, "amplitude_fine")
    dataset = datasets["transverse"].assign(mu_static_stick_zone=line)
    figure = drawing.draw("fig2_transverse_map", {"transverse": dataset})
    np.testing.assert_array_equal(artists(figure, "mu_static_stick_zone")[0].get_xdata(), fine)


def test_what_is_missing_is_named(datasets, figures, tmp_path):
    with pytest.raises(ValueError, match=r"unknown figure 'fig7'.*fig6_bore_map"):
        drawing.draw("fig7", datasets)
    with pytest.raises(ValueError, match="fig6_bore_map needs the dataset 'bore'"):
        drawing.draw("fig6_bore_map", {"transverse": datasets["transverse"]})
    lacking = datasets["transverse"].drop_vars("mu_static_slider")
    with pytest.raises(ValueError, match="'transverse' has no variable 'mu_static_slider'"):
        drawing.draw("fig2_transverse_map", {"transverse": lacking})
    with pytest.raises(ValueError, match="two amplitudes"):
        drawing.draw("fig6_bore_map", {"bore": datasets["bore"].isel(amplitude=[0])})
    with pytest.raises(ValueError, match=r"\.png or \.pdf"):
        drawing.save(figures["fig5_transients"], tmp_path / "figure.svg")


def test_a_failed_save_leaves_the_old_file(figures, tmp_path, monkeypatch):
    figure, path = figures["fig4_continuous_bore"], tmp_path / "figure.png"
    path.write_text("old")

    def fail(canvas, target, **_):
        Path(target).write_text("half")
        raise OSError("disk full")

    monkeypatch.setattr(FigureCanvasAgg, "print_png", fail)
    with pytest.raises(CacheError, match="disk full"):
        drawing.save(figure, path)
    assert [file.read_text() for file in tmp_path.iterdir()] == ["old"]


@pytest.mark.long
def test_the_users_settings_play_no_part_and_stay(datasets, figures, tmp_path):
    name = "fig5_transients"
    expected = drawing.save(figures[name], tmp_path / "expected.png").read_bytes()
    with matplotlib.rc_context({"font.size": 20, "savefig.dpi": 50, "lines.linewidth": 9}):
        found = drawing.save(drawing.draw(name, datasets), tmp_path / "found.png").read_bytes()
        assert matplotlib.rcParams["font.size"] == 20
    assert found == expected
