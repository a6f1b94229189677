"""Maps and groups of sweeps: colours, interpolated surface, contours, ticks, lines, titles."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.legend import Legend
from matplotlib.text import Text
from stubs import figures_stub as stub
from stubs.figures_stub import artists, words

from microslip.report.figures import drawing, maps
from microslip.report.figures import style as look
from microslip.report.figures.style import mathtext
from microslip.scene.by_name import MOTIONS, motion_named
from microslip.theory import paper

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("without_layout")]


def maps_in(figure) -> list:
    return [axes for axes in figure.axes if axes.get_label() != "<colorbar>"]


def shown(values, lowest=-1.0):
    """Colours of friction values in a figure whose smallest value is `lowest`."""
    scale = maps.friction([xr.Dataset({"mu_macro": ("n", [lowest, 1.0])})])
    return scale.colours(scale.norm(np.asarray(values, float)))[:, :3]


# The interpolated surface


def mapped(velocities=9, amplitudes=7):
    """A smooth map between 0 and 1."""
    velocity, amplitude = np.geomspace(1e-2, 10, velocities), np.linspace(0.2, 3, amplitudes)
    mu = paper.large_amplitude_transverse(velocity, amplitude[:, None])
    return xr.Dataset(
        stub.fake_map(mu),
        coords={"amplitude": amplitude, "velocity": velocity, "poisson": 0.0},
        attrs={"motion": "longitudinal", "title": "m", "group": "motions"},
    )


def contours_of(dataset, count=1):
    """The panel of a map, and its contours. count: number of panels of the figure."""
    figure = drawing.draw("map", dict.fromkeys(range(count), dataset))
    axes = artists(figure, "map")[0]
    (lines,) = artists(axes, "contours")
    return axes, lines


def test_a_coarse_map_shows_its_points_and_no_contours_that_they_cannot_support():
    axes, lines = contours_of(mapped(5, 5))
    (points,) = artists(axes, "points")
    assert len(points.get_xdata()) == 25
    for level, path in zip(lines.levels, lines.get_paths(), strict=True):
        for velocity, amplitude in path.vertices:
            true = float(paper.large_amplitude_transverse(velocity, amplitude))
            assert abs(true - level) < 0.1  # half the difference of two levels
    steep = mapped(5, 5)
    steep["mu_macro"][:] = np.where(np.add.outer(np.arange(5), np.arange(5)) > 4, 1.0, 0.0)
    assert not any(len(path.vertices) for path in contours_of(steep)[1].get_paths())


def test_a_number_is_on_its_contour_apart_from_the_others_inside_the_frame():
    axes, lines = contours_of(mapped(25, 25))
    assert not artists(axes, "points")
    assert all(len(path.vertices) for path in lines.get_paths())
    axes.get_figure(root=True).draw_without_rendering()
    numbers = [text for text in axes.texts if re.fullmatch(r"-?\d\.\d", text.get_text())]
    assert len(numbers) >= 3
    frame = axes.get_window_extent()
    for text in numbers:
        velocity, amplitude = text.get_position()
        there = float(paper.large_amplitude_transverse(velocity, amplitude))
        assert there == pytest.approx(float(text.get_text()), abs=0.01)
        box = text.get_window_extent()
        assert frame.x0 <= box.x0 and box.x1 <= frame.x1
        assert frame.y0 <= box.y0 and box.y1 <= frame.y1
        height = text.get_fontsize() * axes.get_figure(root=True).dpi / 72
        at = axes.transData.transform((velocity, amplitude))
        for level, path in zip(lines.levels, lines.get_paths(), strict=True):
            if abs(level - float(text.get_text())) > 0.05:
                away = np.hypot(*(axes.transData.transform(path.vertices) - at).T)
                assert away.min() > 0.7 * height


def pixels(figure):
    """The drawn figure, shape (height, width, 3)."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    return np.asarray(canvas.buffer_rgba())[..., :3].astype(int)


# Groups of maps


def test_a_group_is_drawn_with_one_scale_and_shared_labels():
    data = {"b": stub.spanning("second"), "a": stub.spanning("first")}
    figure = drawing.draw("map", data)
    titles = [axes.get_title(loc="left") for axes in maps_in(figure)]
    assert [title.split()[-1] for title in titles] == ["second", "first"]
    (bar,) = [axes for axes in figure.axes if axes.get_label() == "<colorbar>"]
    assert bar.get_ylim() == (0, 1)
    assert words(figure).count(r"$x_{0}/u_{\mathrm{lim}}$") == 1
    data["c"] = stub.spanning("c", amplitude_label="phi0 / phi_lk(a/2)")
    labels = [axes.get_ylabel() for axes in maps_in(drawing.draw("map", data))]
    formulas = r"$x_{0}/u_{\mathrm{lim}}$", r"$\varphi_{0}/\varphi_{\mathrm{lk}}(a/2)$"
    assert all(one in label for one, label in zip(formulas, labels[::2], strict=True))


def test_friction_below_zero_widens_the_scale_of_all():
    negative = stub.spanning("a", shift=-0.234)
    scale = maps.friction([stub.spanning(), negative])
    assert scale.fills[[0, -1]] == pytest.approx((-0.3, 1.0)) and 0 in scale.lines
    scale = maps.friction([stub.spanning(shift=-0.004)])  # within the error of the points
    assert tuple(scale.fills[[0, -1]]) == (0.0, 1.0)
    figure = drawing.draw("map", {"a": negative, "b": stub.spanning("b")})
    (bands,) = [c for c in figure.axes[0].collections if len(getattr(c, "levels", ())) > 20]
    middles = (bands.levels[1:] + bands.levels[:-1]) / 2
    np.testing.assert_allclose(bands.get_facecolor()[:, :3], shown(middles), atol=0.03)
    (lines,) = artists(figure.axes[0], "contours")
    dashes = [style[1] is not None for style in lines.get_linestyle()]
    assert dashes == [level < 0 for level in lines.levels]


def test_all_of_poissons_ratios_are_drawn():
    two = stub.at_ratios(stub.spanning("a"), 0.0, 0.3)
    figure = drawing.draw("map", {"a": two, "b": stub.spanning("b")})
    heads = [axes.get_title(loc="left") for axes in maps_in(figure)]
    assert [r"$\nu = 0.3$ less $0$" in head for head in heads] == [False, True, False]
    static = stub.at_ratios(stub.static("a"), 0.0, 0.3).drop_vars("mu_macro_change")
    (legend,) = drawing.draw("curves", {"a": static, "b": stub.static("b")}).findobj(Legend)
    labels = [text.get_text() for text in legend.get_texts()]
    assert labels == [r"a, $\nu = 0$", r"a, $\nu = 0.3$", "b"]
    many = stub.at_ratios(stub.fake_bore(), *np.linspace(0, 0.5, 11))
    figure = drawing.draw("map", {"bore": many})
    assert len(artists(figure, "map")) == 11
    assert len(artists(figure, "computed")) == 22


def test_a_change_within_twice_the_tolerance_has_the_palest_colour():
    two = stub.at_ratios(stub.fake_bore(), 0.0, 0.5).assign_attrs(tolerance=0.01)
    scale = maps.change([two.isel(poisson=1)])
    levels = np.sort(np.abs(scale.fills))
    assert levels[:2] == pytest.approx([0.02, 0.02]) and levels[-1] >= 0.05
    assert scale.colours(scale.norm(0.0))[:3] == pytest.approx((0.97, 0.97, 0.97), abs=0.01)


def blank(figure, axes, dataset):
    """Points of a dataset at which the drawn figure is white."""
    image = pixels(figure)
    points = dataset.mu_macro.to_series().dropna().reset_index()
    at = axes.transData.transform(points[["velocity", "amplitude"]].values)
    column, row = at.round().astype(int).T
    row = image.shape[0] - row
    near = [image[r - 3 : r + 4, c - 3 : c + 4].min() for r, c in zip(row, column, strict=True)]
    return points[np.array(near) > 240]


@pytest.mark.parametrize("size", [(7, 5), (15, 13)])
@pytest.mark.parametrize("ratios", [(0.0,), (0.0, 0.3)])
def test_every_value_of_a_map_is_visible_as_colour_or_marker(size, ratios):
    """Half of the points have no value, so that no cell of the map has a colour."""
    dataset = stub.holed(*size)
    shown = stub.at_ratios(dataset, *ratios) if len(ratios) > 1 else dataset
    figure = drawing.draw("map", {"m": shown})
    assert blank(figure, figure.axes[0], dataset).empty
    assert "computed points" in words(figure)


def test_a_coarse_map_at_several_ratios_has_colour_and_says_that_contours_end():
    dataset = mapped(7, 5)
    figure = drawing.draw("map", {"m": stub.at_ratios(dataset, 0.0, 0.3)})
    axes = figure.axes[0]
    finer = dataset.interp(
        velocity=np.geomspace(0.011, 9, 20), amplitude=np.linspace(0.25, 2.9, 20)
    )
    assert blank(figure, axes, finer).empty
    assert "contours only where certain" in words(figure)
    assert len(artists(axes, "points")[0].get_xdata()) == 35


@pytest.mark.parametrize("velocity", [0.1, 1e-3])
def test_figure_2_names_the_velocities_of_the_markers_and_of_the_limits(velocity):
    dataset = stub.fake_transverse(5).assign_coords(velocity=velocity * np.geomspace(1, 100, 5))
    text = words(drawing.draw("map", {"transverse": dataset}))
    assert f"markers: $\\tilde v_0 = {look.number(velocity)}$" in text.replace("{v}", " v")
    assert "\\to 0$" in text


def test_all_computed_values_of_a_cut_are_inside_its_panel():
    """Values can exceed 1, and static friction can vanish well before the largest amplitude."""
    dataset = stub.at_ratios(stub.fake_transverse(9), 0.0, 0.2, 0.4)
    figure = drawing.draw("map", {"transverse": dataset})
    markers = artists(figure, "computed")
    assert len(markers) == 6
    for line in markers:
        box = line.axes.get_window_extent().padded(1)
        assert box.count_contains(line.axes.transData.transform(line.get_xydata())) == 9
    assert len({line.get_markersize() for line in markers}) == 3  # all at one place can be seen


# Lines


def test_lines_show_the_limit_and_markers_the_smallest_velocity():
    slow = stub.static("line", velocity=(0.0, 1e-3))
    loop = stub.static("loop", velocity=(1e-3,))
    loop["converged"][3, 0] = 0
    figure = drawing.draw("curves", {"a": slow, "b": loop})
    (line,) = artists(figure, "limit")  # the second dataset has no limit
    np.testing.assert_array_equal(line.get_ydata(), slow["mu_macro"].sel(velocity=0))
    first, solved = artists(figure, "computed")
    np.testing.assert_array_equal(first.get_ydata(), slow["mu_macro"].sel(velocity=1e-3))
    (failed,) = artists(figure, "unconverged")
    assert len(solved.get_ydata()) == 6 and failed.get_markerfacecolor() == "white"
    assert "markers: velocity $0.001$" in words(figure)


def test_a_limit_from_theory_is_drawn_on_its_finer_axis_where_it_holds():
    fine = np.linspace(0, 1.2, 50)
    curve = ("amplitude_curve", np.maximum(1 - fine, 0))
    data = stub.static("a", mu_static=("amplitude", np.zeros(7)), mu_static_curve=curve)
    data = data.assign_coords(amplitude_curve=fine)
    for poisson, points in ((0.0, 50), (0.3, 7)):
        figure = drawing.draw("curves", {"a": data.assign_coords(poisson=poisson)})
        (line,) = artists(figure, "limit")
        assert len(line.get_xdata()) == points


def test_a_steady_motion_is_drawn_over_its_velocity():
    velocity = np.geomspace(0.01, 100, 9)
    force = paper.bore_forward(velocity)
    steady = {name: ("velocity", part[1][0]) for name, part in stub.fake_map(force[None]).items()}
    steady["mu_forward_theory"] = "velocity", force
    coords = {"velocity": velocity, "poisson": 0.0}
    data = stub.labelled(xr.Dataset(steady, coords, {"title": "spin", "group": "steady"}), "")
    figure = drawing.draw("curves", {"spin": data})
    (line,) = artists(figure, "limit")
    np.testing.assert_array_equal(line.get_ydata(), force)
    assert figure.axes[0].get_xscale() == "log"


# Titles from the configuration

TITLES = ["costs $5", r"$\frac{", r"\frac{1}{2} $x$", "a_b^c {} % # & ~", "_first", "$$"]
TITLES += ["it ends in \\", r"\$ and $"]


def drawn_words(figure):
    """All texts of a figure without escapes, formulas and line breaks."""
    texts = [text.get_text() for text in figure.findobj(Text)]
    plain = [re.sub(r"(?<!\\)\$(?:\\\$|[^$])*(?<!\\)\$", "", text) for text in texts]
    return [" ".join(text.replace(r"\$", "$").split()) for text in plain]


def test_titles_are_drawn_verbatim():
    maps = {f"m{k}": stub.spanning(title) for k, title in enumerate(TITLES)}
    figure = drawing.draw("map", maps)
    assert set(TITLES) <= set(drawn_words(figure))
    figure.draw_without_rendering()  # parses them
    lines = {f"s{k}": stub.static(title) for k, title in enumerate(TITLES)}
    assert set(TITLES) <= set(drawn_words(drawing.draw("curves", lines)))


@pytest.mark.parametrize("name", [*MOTIONS])
def test_labels_of_every_motion_can_be_set(name):
    from matplotlib.mathtext import MathTextParser

    motion = motion_named(name)
    for label in (motion.velocity_label, motion.amplitude_label):
        MathTextParser("path").parse(mathtext(label))
